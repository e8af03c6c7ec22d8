// The brush: a ball that is drawn through the guides. What it does to them, the server does.

import { MOUSE, Vector3 } from "three";
import { h } from "../dom";
import type { Model } from "../model";
import { bindKey, plainKey } from "./keys";
import { inPlane, pick, pixelsPerMetre } from "../view/pick";
import type { Viewer } from "../view/viewer";
import { Slider } from "./slider";

const TOOLS = {
  grab: "Takes guides along",
  comb: "Draws guides along; they keep their lengths",
  smooth: "Takes bends out (Shift with any brush)",
  cut: "Cuts guides where they come into the ring",
  lengthen: "Lets guides grow",
  return: "Gives guides back to the recipe",
  freeze: "Protects guides from all brushes",
  thaw: "Ends the protection",
} as const;
type Tool = keyof typeof TOOLS;

const SMALLEST = 0.004;
const LARGEST = 0.08;
const STEP = 1.15;

export class BrushTool {
  readonly element = h("section", { class: "panel brush", hidden: true, "aria-label": "Sculpt guides" });
  readonly ring = h("div", { class: "ring", hidden: true, "aria-hidden": "true" });
  on = false;
  /** Whom to tell that the brush was taken up or laid down. */
  readonly changed: ((on: boolean) => void)[] = [];
  private tool: Tool = "comb";
  private readonly radius = h("input", {
    type: "range",
    id: "brush-radius",
    min: 1000 * SMALLEST,
    max: 1000 * LARGEST,
    step: 1,
    value: 20,
  });
  private readonly readout = h("output", { class: "unit", for: "brush-radius" });
  private readonly mirrored = h("input", { type: "checkbox", role: "switch", class: "switch", id: "brush-mirrored" });
  private readonly hair = h("input", { type: "checkbox", role: "switch", class: "switch", id: "brush-hair" });
  private readonly all = h("button", { type: "button", class: "quiet" }, "Return all guides");
  private readonly strength = new Slider({ id: "brush-strength" }, () => this.tellStrength());
  private readonly strong = h("output", { class: "unit", for: "brush-strength" });
  private readonly falloff = h(
    "select",
    { id: "brush-falloff" },
    ...["smooth", "sharp", "flat"].map((name) => h("option", { value: name }, name)),
  );
  private readonly pen = h("input", { type: "checkbox", role: "switch", class: "switch", id: "brush-pen" });
  /** Of the pen; a mouse has half of it. */
  private pressure = 0.5;
  private gesture = 0;
  private place: Vector3 | null = null;
  private way = new Vector3();
  private sending = 0;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
  ) {
    const tools = Object.entries(TOOLS).map(([name, title]) => {
      const input = h("input", { type: "radio", name: "brush", value: name, checked: name === this.tool });
      input.addEventListener("change", () => {
        this.tool = name as Tool;
      });
      return h("label", { class: "choice", title }, input, h("span", {}, name));
    });
    const row = (label: string, input: HTMLElement, more?: HTMLElement) =>
      h("div", { class: "field-head" }, h("label", { for: input.id }, label), input, more);
    this.element.append(
      h("h2", {}, "Sculpt guides"),
      h("div", { class: "choices", role: "radiogroup", "aria-label": "Brush" }, ...tools),
      row("radius", this.radius, this.readout),
      row("strength", this.strength.element, this.strong),
      row("falloff", this.falloff),
      row("pressure of the pen", this.pen),
      row("both sides", this.mirrored),
      row("show the hair", this.hair),
      h(
        "div",
        { class: "group" },
        this.all,
        h("button", { type: "button", class: "quiet", onclick: () => this.show(false) }, "Done"),
      ),
    );
    this.element.append(
      h("p", { class: "told" }, "The right button, Alt or the arrow keys orbit the camera; so does a finger that starts off the hair."),
    );
    this.strength.set(1, { least: 0.05, most: 1, step: 0.05 });
    this.tellStrength();
    this.mirrored.addEventListener("change", () => this.update());
    this.hair.checked = true;
    this.hair.addEventListener("change", () => viewer.showHair(this.hair.checked));
    this.radius.addEventListener("input", () => this.resize(1));
    this.all.addEventListener("click", () => model.say({ kind: "unsculpt" }));
    const { element } = viewer;
    element.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
    element.addEventListener("pointermove", (event) => this.move(event), { capture: true });
    for (const end of ["pointerup", "pointercancel"] as const)
      element.addEventListener(end, () => this.lift(), { capture: true });
    element.addEventListener("pointerleave", () => this.ring.toggleAttribute("hidden", true));
    bindKey({ keys: "[ and ]", does: "smaller brush, larger brush", on: (event) => this.on && plainKey("[", "]")(event), run: (event) => this.resize(event.key === "[" ? 1 / STEP : STEP) });
    bindKey({ keys: "B", does: "turn the brush on or off", on: plainKey("b"), run: () => this.show(!this.on) });
    bindKey({ keys: "Escape", does: "turn the brush off", on: (event) => this.on && event.key === "Escape", run: () => this.show(false) });
    for (const topic of ["role", "guides"] as const) model.on(topic, () => this.update());
    this.resize(1);
  }

  /** Takes up the brush, or lays it down. */
  show(on: boolean): void {
    this.on = on && this.model.guides !== null;
    this.element.toggleAttribute("hidden", !this.on);
    this.viewer.guides.shown = this.on;
    this.viewer.controls.mouseButtons.RIGHT = this.on ? MOUSE.ROTATE : MOUSE.PAN;
    this.viewer.showHair(!this.on || this.hair.checked);
    this.viewer.element.classList.toggle("sculpts", this.on);
    if (!this.on) this.ring.toggleAttribute("hidden", true);
    this.update();
    for (const listener of this.changed) listener(this.on);
  }

  private update(): void {
    this.element.toggleAttribute("inert", !this.model.role.leads);
    this.viewer.guides.showPlane(this.on && this.mirrored.checked);
    this.viewer.invalidate();
    this.all.toggleAttribute("disabled", !this.model.guides?.changed.some((one) => one > 0));
  }

  private tellStrength(): void {
    this.strong.textContent = `${Math.round(100 * this.strength.value)} %`;
  }

  /** What of its strength the brush has under the pen. */
  private get applied(): number {
    const pressed = this.pen.checked ? Math.max(0.02, this.pressure) : 1;
    return Math.min(1, this.strength.value * pressed);
  }

  private get metres(): number {
    return Number(this.radius.value) / 1000;
  }

  private resize(factor: number): void {
    this.radius.value = String(Math.min(LARGEST, Math.max(SMALLEST, this.metres * factor)) * 1000);
    this.readout.textContent = `${this.radius.value} mm`;
    this.radius.style.setProperty("--part", `${(100 * (this.metres - SMALLEST)) / (LARGEST - SMALLEST)}%`);
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
    const reach = this.metres * pixelsPerMetre(controls.target, camera, this.viewer.clear.height);
    const found = pick(guides.points, guides.offsets, camera, this.viewer.size, at, Math.max(reach, 8), counts);
    return found && new Vector3().fromArray(guides.points, 3 * (guides.offsets[found.lock] + found.point));
  }

  private press(event: PointerEvent): void {
    if (!this.on || event.button !== 0 || this.viewer.compared || !this.model.role.leads) return;
    if (event.altKey) return; // turns the head
    const near = this.under(this.viewer.at(event));
    if (!near && event.pointerType === "touch") return; // a finger has no other button to turn the head
    event.stopPropagation();
    event.preventDefault();
    if (!near) return;
    this.pressure = event.pressure;
    this.viewer.element.setPointerCapture(event.pointerId);
    this.gesture = this.model.newGesture();
    this.place = inPlane(this.viewer.at(event), near, this.viewer.camera, this.viewer.size);
    this.way.set(0, 0, 0);
    this.send(event.shiftKey, false);
  }

  private move(event: PointerEvent): void {
    if (!this.on) return;
    const at = this.viewer.at(event);
    if (!this.place) {
      this.draw(at, this.under(at));
      return;
    }
    event.stopPropagation();
    this.pressure = event.pressure;
    const there = inPlane(at, this.place, this.viewer.camera, this.viewer.size);
    this.way.add(there.clone().sub(this.place));
    const near = this.tool === "grab" ? null : this.under(at);
    this.place = near ? inPlane(at, near, this.viewer.camera, this.viewer.size) : there;
    this.draw(at, this.place);
    const smooth = event.shiftKey;
    if (!this.sending) this.sending = requestAnimationFrame(() => this.send(smooth, false));
  }

  private lift(): void {
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
      radius: this.metres,
      mirrored: this.mirrored.checked,
      strength: this.applied,
      falloff: this.falloff.value as "smooth" | "sharp" | "flat",
      gesture: this.gesture,
      resting,
    });
    way.set(0, 0, 0);
  }

  /** Puts the ring where the brush is. */
  private draw(at: { x: number; y: number }, near: Vector3 | null): void {
    const place = near ?? this.viewer.controls.target;
    const pixels = this.metres * pixelsPerMetre(place, this.viewer.camera, this.viewer.clear.height);
    this.ring.toggleAttribute("hidden", false);
    this.ring.classList.toggle("idle", !near);
    Object.assign(this.ring.style, {
      left: `${at.x - pixels}px`,
      top: `${at.y - pixels}px`,
      width: `${2 * pixels}px`,
      height: `${2 * pixels}px`,
    });
  }
}
