// Painting on the scalp: a brush changes the map that a setting names. What it does to the map, the server does.

import { Vector3 } from "three";
import { h } from "../dom";
import type { Model, Place } from "../model";
import { onSurface } from "../view/surface";
import type { Viewer } from "../view/viewer";
import { BrushTip } from "./brush_tip";
import { choice, HandTool, row } from "./hand_tool";

const TOOLS = {
  add: "Paints towards white: more of it",
  remove: "Paints towards black: less of it (also Ctrl with a brush)",
  smooth: "Evens out to the mean around (also Shift with a brush)",
  comb: "Paints the direction in which the brush moves",
} as const;
type Tool = keyof typeof TOOLS;
const NUMBERS: Tool[] = ["add", "remove", "smooth"];
const DIRECTIONS: Tool[] = ["comb", "remove", "smooth"];

export class PaintTool extends HandTool {
  private place: Place = [];
  private tool: Tool = "add";
  private readonly tip: BrushTip;
  private gesture = 0;
  private held: Vector3 | null = null;
  private sent = new Vector3();
  private stroke: Tool = "add";
  private sending = 0;

  constructor(model: Model, viewer: Viewer, ring: HTMLElement) {
    super(model, viewer, "paint", "Paint on the scalp", "end painting");
    this.tip = new BrushTip("paint", viewer, ring, { radius: 15, strength: 0.5 }, () => this.on);
    this.element.append(
      choice("paint", TOOLS, this.tool, (tool) => (this.tool = tool)),
      ...this.tip.rows,
      row("show hair", this.hair),
      h("div", { class: "group" }, this.done),
      h("p", { class: "hint" }, "The right button, Alt or the arrow keys orbit the camera."),
    );
    this.hair.checked = true;
    this.tip.mirrored.addEventListener("change", () => this.showPlane());
    model.on("painted", () => {
      if (model.painted) viewer.painted.set(model.painted);
      viewer.invalidate();
    });
    model.on("document", () => this.on && this.ask());
  }

  /** Paints the map of a setting. */
  paint(place: Place, label: string): void {
    this.place = place;
    this.title.textContent = `Paint ${label}`;
    const tools = place.at(-1) === "direction" ? DIRECTIONS : NUMBERS;
    for (const choice of this.element.querySelectorAll<HTMLElement>("[data-tool]")) choice.hidden = !tools.includes(choice.dataset["tool"] as Tool);
    if (!tools.includes(this.tool)) this.element.querySelector<HTMLInputElement>(`input[value="${tools[0]}"]`)!.click();
    this.show(true);
  }

  protected turned(): void {
    this.viewer.painted.shown = this.on;
    if (!this.on) this.tip.hide();
    this.showPlane();
    if (this.on) this.ask();
  }

  /** Asks for the map as it is, unless a stroke shows it anyway. */
  private ask(): void {
    if (!this.held) this.model.say({ kind: "show_map", place: this.place });
  }

  private showPlane(): void {
    this.viewer.guides.showPlane(this.on && this.tip.mirrored.checked);
    this.viewer.invalidate();
  }

  private under(event: MouseEvent): Vector3 | null {
    const { viewer } = this;
    return onSurface(viewer.surfaces, viewer.camera, viewer.size, viewer.at(event));
  }

  protected press(event: PointerEvent): void {
    this.hold(event);
    const at = this.under(event);
    if (!at) return;
    this.gesture = this.model.newGesture();
    this.stroke = event.shiftKey ? "smooth" : event.ctrlKey ? "remove" : this.tool;
    this.tip.pressure = event.pressure;
    this.held = at;
    this.sent.copy(at);
    this.send(false);
  }

  protected move(event: PointerEvent): void {
    const at = this.under(event);
    this.tip.show(this.viewer.at(event), at);
    if (!this.held) return;
    event.stopPropagation();
    this.tip.pressure = event.pressure;
    if (at) this.held = at;
    if (!this.sending) this.sending = requestAnimationFrame(() => this.send(false));
  }

  protected lift(): void {
    if (!this.held) return;
    cancelAnimationFrame(this.sending);
    this.send(true);
    this.held = null;
  }

  private send(resting: boolean): void {
    this.sending = 0;
    if (!this.held) return;
    const by = this.held.clone().sub(this.sent);
    this.sent.copy(this.held);
    this.model.say({
      kind: "paint",
      place: this.place,
      tool: this.stroke,
      at: [this.held.x, this.held.y, this.held.z],
      by: [by.x, by.y, by.z],
      ...this.tip.stroke,
      gesture: this.gesture,
      resting,
    });
  }
}
