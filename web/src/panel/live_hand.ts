// A hand in live hair: it pulls a lock, combs, or pats. What it does to the hair, the server does.

import { Vector3 } from "three";
import { h } from "../dom";
import type { Model } from "../model";
import type { TouchHair } from "../protocol";
import type { Size } from "../view/box";
import { inPlane, pick } from "../view/pick";
import type { Viewer } from "../view/viewer";
import { BrushTip } from "./brush_tip";
import { choice, HandTool } from "./hand_tool";

const TOOLS = {
  pull: "Pulls the lock under the pointer; let go, it bounces",
  comb: "Takes hair along as a comb does",
  pat: "Presses a palm into the hair",
} as const;
type Tool = keyof typeof TOOLS;

const SEND_AFTER = 16; // time between two places that are sent [ms]
const PRESSED = 0.5; // how deep a palm is in the hair, by its radius

export class LiveHand extends HandTool {
  readonly button = h("button", { type: "button", class: "quiet", title: "Pull a lock, comb, or pat the hair", "aria-pressed": "false", onclick: () => this.show(!this.on) }, "Hand");
  protected override readonly amongLooks = true;
  private readonly tip: BrushTip;
  private tool: Tool = "pull";
  /** Whether the button of the pointer is down. */
  private down = false;
  /** The place on the hair that it touches. */
  private place: Vector3 | null = null;
  private sent: Vector3 | null = null;
  private timer = 0;

  constructor(model: Model, viewer: Viewer, ring: HTMLElement) {
    super(model, viewer, "live-hand", "Touch the hair", "take the hand away");
    this.tip = new BrushTip("live-hand", viewer, ring, { radius: 40, strength: 1 }, () => this.on);
    this.hair.checked = true;
    this.element.append(
      choice("live-hand", TOOLS, this.tool, (tool) => (this.tool = tool)),
      this.tip.rows[0],
      h("div", { class: "group" }, this.done),
      h("p", { class: "hint" }, "The right button, Alt or the arrow keys orbit the camera; so does a finger that starts off the hair."),
    );
    for (const gone of ["pointerleave", "lostpointercapture"] as const) viewer.element.addEventListener(gone, () => this.lift());
    addEventListener("blur", () => this.lift());
    for (const topic of ["live", "role"] as const)
      model.on(topic, () => {
        this.button.toggleAttribute("disabled", !model.role.leads);
        if (!model.live.on || !model.role.leads) this.show(false);
      });
  }

  override show(on: boolean): void {
    super.show(on && this.model.live.on);
  }

  protected turned(): void {
    this.button.setAttribute("aria-pressed", String(this.on));
    if (this.on) return;
    this.lift();
    this.tip.hide();
  }

  /** The place of hair under the pointer, as it is seen. */
  private under(at: { x: number; y: number }): Vector3 | null {
    return this.viewer.onOpenLook(at, (place, size) => this.nearest(place, size));
  }

  private nearest(at: { x: number; y: number }, size: Size): Vector3 | null {
    const { hair, camera, controls } = this.viewer;
    const points = hair.a.seen;
    if (!points || !hair.a.locks) return null;
    const reach = this.tool === "pull" ? 12 : Math.max(0.5 * this.tip.pixels(controls.target), 8);
    const { offsets } = hair.a.locks;
    const found = pick(points, offsets, camera, size, at, reach);
    return found && inPlane(at, new Vector3().fromArray(points, 3 * (offsets[found.lock] + found.point)), camera, size);
  }

  protected press(event: PointerEvent): void {
    const at = this.viewer.at(event);
    const near = this.under(at);
    if (!near && event.pointerType === "touch") return; // a finger has no other button to turn the head
    this.hold(event);
    this.down = true;
    this.place = near;
    this.send();
  }

  protected move(event: PointerEvent): void {
    const { viewer } = this;
    const { camera, size } = viewer;
    const at = this.viewer.at(event);
    if (this.down) {
      event.stopPropagation();
      if (at.x < 0 || at.y < 0 || at.x > size.width || at.y > size.height) {
        this.lift();
        return;
      }
      const { place } = this;
      const along = () => viewer.onOpenLook(at, (there, part) => inPlane(there, place!, camera, part), true);
      this.place = place ? along() : this.under(at); // a stroke may begin off the hair
      if (!this.timer) this.send();
    }
    if (this.tool === "pull") this.tip.hide();
    else this.tip.show(at, this.place);
  }

  protected lift(): void {
    if (!this.down) return;
    this.down = false;
    this.place = null;
    if (this.sent) this.say({ does: null });
    this.sent = null;
  }

  /** The newest place, at most one in some time. */
  private send(): void {
    const { place } = this;
    if (!place || place === this.sent) return;
    const at = place.clone();
    if (this.tool === "pat") at.addScaledVector(this.viewer.camera.position.clone().sub(place).normalize(), (1 - PRESSED) * this.tip.metres);
    this.say({ does: this.tool, at: at.toArray(), radius: this.tip.metres });
    this.sent = place;
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      this.send();
    }, SEND_AFTER);
  }

  private say(touch: Omit<TouchHair, "kind">): void {
    this.model.link?.whisper({ kind: "touch_hair", ...touch });
  }
}
