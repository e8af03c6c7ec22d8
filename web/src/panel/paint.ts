// Painting on the scalp: a brush changes the map that a setting names. What it does to the map, the server does.

import { MOUSE, Vector3 } from "three";
import { h } from "../dom";
import type { Model, Place } from "../model";
import { onSurface } from "../view/surface";
import { pixelsPerMetre } from "../view/pick";
import type { Viewer } from "../view/viewer";
import { bindKey, plainKey } from "./keys";
import { Slider } from "./slider";

const TOOLS = {
  add: "Goes to white: more of it",
  remove: "Goes to black: less of it (also Ctrl with a brush)",
  smooth: "Goes to the mean around (also Shift with a brush)",
} as const;
type Tool = keyof typeof TOOLS;
type Falloff = "smooth" | "sharp" | "flat";

const STEP = 1.15; // of the radius, by a key
const SMALLEST = 2; // radius [mm]
const LARGEST = 80;

export class PaintTool {
  readonly element = h("section", { class: "panel brush paint", hidden: true, "aria-label": "Paint on the scalp" });
  on = false;
  readonly changed: ((on: boolean) => void)[] = [];
  private place: Place = [];
  private tool: Tool = "add";
  private readonly title = h("h2", {});
  private readonly radius = new Slider({ id: "paint-radius" }, () => this.tell());
  private readonly strength = new Slider({ id: "paint-strength" }, () => this.tell());
  private readonly wide = h("output", { class: "unit", for: "paint-radius" });
  private readonly strong = h("output", { class: "unit", for: "paint-strength" });
  private readonly falloff = h("select", { id: "paint-falloff" }, ...["smooth", "sharp", "flat"].map((name) => h("option", { value: name }, name)));
  private readonly pen = h("input", { type: "checkbox", role: "switch", class: "switch", id: "paint-pen" });
  private readonly mirrored = h("input", { type: "checkbox", role: "switch", class: "switch", id: "paint-mirrored" });
  private readonly hair = h("input", { type: "checkbox", role: "switch", class: "switch", id: "paint-hair" });
  private gesture = 0;
  private held: Vector3 | null = null;
  private sent = new Vector3();
  private pressure = 0.5;
  private stroke: Tool = "add";
  private sending = 0;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly ring: HTMLElement,
  ) {
    const tools = Object.entries(TOOLS).map(([name, title]) => {
      const input = h("input", { type: "radio", name: "paint", value: name, checked: name === this.tool });
      input.addEventListener("change", () => {
        this.tool = name as Tool;
      });
      return h("label", { class: "choice", title }, input, h("span", {}, name));
    });
    const row = (label: string, input: HTMLElement, more?: HTMLElement) =>
      h("div", { class: "field-head" }, h("label", { for: input.id }, label), input, more);
    this.element.append(
      this.title,
      h("div", { class: "choices", role: "radiogroup", "aria-label": "Brush" }, ...tools),
      row("radius", this.radius.element, this.wide),
      row("strength", this.strength.element, this.strong),
      row("falloff", this.falloff),
      row("pressure of the pen", this.pen),
      row("both sides", this.mirrored),
      row("show the hair", this.hair),
      h("div", { class: "group" }, h("button", { type: "button", class: "quiet", onclick: () => this.show(false) }, "Done")),
      h("p", { class: "told" }, "The right button, Alt or the arrow keys orbit the camera."),
    );
    this.radius.set(15, { least: SMALLEST, most: LARGEST, step: 1 });
    this.strength.set(0.5, { least: 0.05, most: 1, step: 0.05 });
    this.tell();
    this.hair.checked = true;
    this.hair.addEventListener("change", () => this.viewer.showHair(this.hair.checked));
    this.mirrored.addEventListener("change", () => this.showPlane());
    const { element } = viewer;
    element.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
    element.addEventListener("pointermove", (event) => this.move(event), { capture: true });
    for (const end of ["pointerup", "pointercancel"] as const) element.addEventListener(end, () => this.lift(), { capture: true });
    const keyed = (...keys: string[]) => (event: KeyboardEvent) => this.on && plainKey(...keys)(event);
    bindKey({ keys: "[ and ]", does: "smaller brush, larger brush, while painting", on: keyed("[", "]"), run: (event) => this.resize(event.key === "[" ? 1 / STEP : STEP) });
    bindKey({ keys: "Escape", does: "end painting", on: keyed("Escape"), run: () => this.show(false) });
    model.on("painted", () => {
      if (model.painted) viewer.painted.set(model.painted);
      viewer.invalidate();
    });
    model.on("role", () => this.element.toggleAttribute("inert", !model.role.leads));
    model.on("document", () => this.on && this.ask());
  }

  /** Paints the map of a setting. */
  paint(place: Place, label: string): void {
    this.place = place;
    this.title.textContent = `Paint ${label}`;
    this.show(true);
  }

  show(on: boolean): void {
    if (on === this.on && !on) return;
    this.on = on;
    for (const listener of this.changed) listener(on); // other tools are laid down before this one sets the view
    this.element.toggleAttribute("hidden", !on);
    this.viewer.painted.shown = on;
    this.viewer.controls.mouseButtons.RIGHT = on ? MOUSE.ROTATE : MOUSE.PAN;
    this.viewer.showHair(!on || this.hair.checked);
    this.viewer.element.classList.toggle("sculpts", on);
    if (!on) this.ring.toggleAttribute("hidden", true);
    this.showPlane();
    if (on) this.ask();
    this.viewer.invalidate();
  }

  /** Asks for the map as it is, unless a stroke shows it anyway. */
  private ask(): void {
    if (!this.held) this.model.say({ kind: "show_map", place: this.place });
  }

  private showPlane(): void {
    this.viewer.guides.showPlane(this.on && this.mirrored.checked);
    this.viewer.invalidate();
  }

  private tell(): void {
    this.wide.textContent = `${Math.round(this.radius.value)} mm`;
    this.strong.textContent = `${Math.round(100 * this.strength.value)} %`;
  }

  private resize(factor: number): void {
    this.radius.set(Math.min(LARGEST, Math.max(SMALLEST, this.radius.value * factor)));
    this.tell();
  }

  private get metres(): number {
    return this.radius.value / 1000;
  }

  private under(event: MouseEvent): Vector3 | null {
    const { viewer } = this;
    return onSurface(viewer.surfaces, viewer.camera, viewer.size, viewer.at(event));
  }

  private press(event: PointerEvent): void {
    if (!this.on || event.button !== 0 || event.altKey || this.viewer.compared || !this.model.role.leads) return;
    event.stopPropagation();
    event.preventDefault();
    const at = this.under(event);
    if (!at) return;
    this.viewer.element.setPointerCapture(event.pointerId);
    this.gesture = this.model.newGesture();
    this.stroke = event.shiftKey ? "smooth" : event.ctrlKey ? "remove" : this.tool;
    this.pressure = event.pressure;
    this.held = at;
    this.sent.copy(at);
    this.send(false);
  }

  private move(event: PointerEvent): void {
    if (!this.on) return;
    const at = this.under(event);
    this.draw(event, at);
    if (!this.held) return;
    event.stopPropagation();
    this.pressure = event.pressure;
    if (at) this.held = at;
    if (!this.sending) this.sending = requestAnimationFrame(() => this.send(false));
  }

  private lift(): void {
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
    const pressed = this.pen.checked ? Math.max(0.02, this.pressure) : 1;
    this.model.say({
      kind: "paint",
      place: this.place,
      tool: this.stroke,
      at: [this.held.x, this.held.y, this.held.z],
      by: [by.x, by.y, by.z],
      radius: this.metres,
      mirrored: this.mirrored.checked,
      strength: Math.min(1, this.strength.value * pressed),
      falloff: this.falloff.value as Falloff,
      gesture: this.gesture,
      resting,
    });
  }

  /** Puts the ring where the brush is. */
  private draw(event: MouseEvent, place: Vector3 | null): void {
    const { x, y } = this.viewer.at(event);
    const pixels = this.metres * pixelsPerMetre(place ?? this.viewer.controls.target, this.viewer.camera, this.viewer.clear.height);
    this.ring.toggleAttribute("hidden", false);
    this.ring.classList.toggle("idle", !place);
    Object.assign(this.ring.style, { left: `${x - pixels}px`, top: `${y - pixels}px`, width: `${2 * pixels}px`, height: `${2 * pixels}px` });
  }
}
