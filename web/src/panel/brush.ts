// The brush: a ball that is drawn through the guides. What it does to them, the server does.

import { Vector3 } from "three";
import { h } from "../dom";
import type { Model } from "../model";
import { inPlane, pick } from "../view/pick";
import type { Viewer } from "../view/viewer";
import { BrushTip } from "./brush_tip";
import { choice, HandTool, row } from "./hand_tool";
import { bindKey, plainKey } from "./keys";

const TOOLS = {
  grab: "Moves guides with the brush",
  comb: "Turns guides along the stroke and keeps their lengths",
  smooth: "Straightens bends (also Shift with any brush)",
  cut: "Cuts guides where they enter the ring",
  lengthen: "Lengthens guides",
  return: "Resets guides to those of the recipe",
  freeze: "Protects guides from all brushes",
  thaw: "Ends the protection by freeze",
} as const;
type Tool = keyof typeof TOOLS;

export class BrushTool extends HandTool {
  readonly ring = h("div", { class: "ring", hidden: true, "aria-hidden": "true" });
  private tool: Tool = "comb";
  private readonly tip: BrushTip;
  private readonly all = h("button", { type: "button", class: "quiet" }, "Reset all");
  private gesture = 0;
  private place: Vector3 | null = null;
  private way = new Vector3();
  private sending = 0;

  constructor(model: Model, viewer: Viewer) {
    super(model, viewer, "sculpt", "Sculpt guides", "put the brush away");
    this.tip = new BrushTip("sculpt", viewer, this.ring, { radius: 20, strength: 1 }, () => this.on);
    this.element.append(
      choice("sculpt", TOOLS, this.tool, (tool) => (this.tool = tool)),
      ...this.tip.rows,
      row("show hair", this.hair),
      h("div", { class: "group" }, this.all, this.done),
      h("p", { class: "hint" }, "The right button, Alt or the arrow keys orbit the camera; so does a finger that starts off the hair."),
    );
    this.hair.checked = true;
    this.tip.mirrored.addEventListener("change", () => this.update());
    this.all.addEventListener("click", () => model.say({ kind: "unsculpt" }));
    bindKey({ section: "Groom", keys: "B", does: "take the brush, or put it away", on: plainKey("b"), run: () => this.show(!this.on) });
    for (const topic of ["role", "guides"] as const) model.on(topic, () => this.update());
  }

  override show(on: boolean): void {
    super.show(on && this.model.guides !== null);
  }

  protected turned(): void {
    this.viewer.guides.shown = this.on;
    if (!this.on) this.tip.hide();
    this.update();
  }

  private update(): void {
    this.viewer.guides.showPlane(this.on && this.tip.mirrored.checked);
    this.viewer.invalidate();
    this.all.toggleAttribute("disabled", !this.model.guides?.changed.some((one) => one > 0));
  }

  /** The place on a guide that is nearest to the eye under the brush; guides behind the head do not count. */
  private under(at: { x: number; y: number }): Vector3 | null {
    const { guides } = this.viewer.guides;
    if (!guides) return null;
    const { camera, controls } = this.viewer;
    const middle = new Vector3(...guides.middle);
    const toEye = camera.position.clone().sub(middle).normalize();
    const counts = (x: number, y: number, z: number) =>
      (x - middle.x) * toEye.x + (y - middle.y) * toEye.y + (z - middle.z) * toEye.z > -0.02;
    const reach = Math.max(this.tip.pixels(controls.target), 8);
    const found = pick(guides.points, guides.offsets, camera, this.viewer.size, at, reach, counts);
    return found && new Vector3().fromArray(guides.points, 3 * (guides.offsets[found.lock] + found.point));
  }

  protected press(event: PointerEvent): void {
    const at = this.viewer.at(event);
    const near = this.under(at);
    if (!near && event.pointerType === "touch") return; // a finger has no other button to turn the head
    this.hold(event);
    if (!near) return;
    this.tip.pressure = event.pressure;
    this.gesture = this.model.newGesture();
    this.place = inPlane(at, near, this.viewer.camera, this.viewer.size);
    this.way.set(0, 0, 0);
    this.send(event.shiftKey, false);
  }

  protected move(event: PointerEvent): void {
    const at = this.viewer.at(event);
    if (!this.place) {
      this.tip.show(at, this.under(at));
      return;
    }
    event.stopPropagation();
    this.tip.pressure = event.pressure;
    const there = inPlane(at, this.place, this.viewer.camera, this.viewer.size);
    this.way.add(there.clone().sub(this.place));
    const near = this.tool === "grab" ? null : this.under(at);
    this.place = near ? inPlane(at, near, this.viewer.camera, this.viewer.size) : there;
    this.tip.show(at, this.place);
    const smooth = event.shiftKey;
    if (!this.sending) this.sending = requestAnimationFrame(() => this.send(smooth, false));
  }

  protected lift(): void {
    if (!this.place) return;
    cancelAnimationFrame(this.sending);
    this.send(false, true);
    this.place = null;
  }

  private send(smooth: boolean, resting: boolean): void {
    this.sending = 0;
    const { place, way } = this;
    if (!place) return;
    this.model.say({
      kind: "sculpt",
      tool: smooth ? "smooth" : this.tool,
      at: [place.x, place.y, place.z],
      by: [way.x, way.y, way.z],
      ...this.tip.stroke,
      gesture: this.gesture,
      resting,
    });
    way.set(0, 0, 0);
  }
}
