// Drawing on the scalp: a stroke becomes the helper curve that a setting names, such as a part line. A guide begins on the
// scalp and may leave it: off the skin it is drawn in the plane of the picture through its root.

import { BufferGeometry, Line, LineBasicMaterial, MOUSE, Vector3 } from "three";
import { h } from "../dom";
import type { Model, Place } from "../model";
import { inPlane } from "../view/pick";
import { onSurface } from "../view/surface";
import type { Viewer } from "../view/viewer";
import { bindKey } from "./keys";
import { Slider } from "./slider";

const SKIN = 0.0008; // distance of a line from the skin, so that it is seen [m]
const ABOVE = 0.003; // distance of a guide from the skin over which it is drawn [m]
const ON_SKIN = "Draw a line over the scalp. A new line replaces it.";
const FREE = "Draw from the root to the tip: begin on the scalp, and leave it where the hair stands up. Each line is one more guide.";

export class DrawTool {
  readonly element = h("section", { class: "panel brush draw", hidden: true, "aria-label": "Draw on the scalp" });
  on = false;
  readonly changed: ((on: boolean) => void)[] = [];
  private readonly title = h("h2", {});
  private readonly lift = new Slider({ id: "draw-lift" }, () => this.tell());
  private readonly height = h("output", { class: "unit", for: "draw-lift" });
  private readonly hair = h("input", { type: "checkbox", role: "switch", class: "switch", id: "draw-hair" });
  private readonly line = new Line(new BufferGeometry(), new LineBasicMaterial({ color: 0xff9e4d, depthTest: false }));
  private readonly words = h("p", { class: "told" });
  private readonly lifts: HTMLElement;
  private place: Place = [];
  private stroke: Vector3[] = [];

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
  ) {
    this.line.frustumCulled = false;
    this.line.visible = false;
    viewer.painted.scene.add(this.line);
    const row = (label: string, input: HTMLElement, more?: HTMLElement) =>
      h("div", { class: "field-head" }, h("label", { for: input.id }, label), input, more);
    this.lifts = row("end lift", this.lift.element, this.height);
    this.element.append(
      this.title,
      this.words,
      this.lifts,
      row("show the hair", this.hair),
      h("div", { class: "group" }, h("button", { type: "button", class: "quiet", onclick: () => this.show(false) }, "Done")),
    );
    this.lift.set(0, { least: 0, most: 150, step: 1 });
    this.tell();
    this.hair.addEventListener("change", () => this.viewer.showHair(this.hair.checked));
    const { element } = viewer;
    element.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
    element.addEventListener("pointermove", (event) => this.move(event), { capture: true });
    for (const end of ["pointerup", "pointercancel"] as const) element.addEventListener(end, () => this.release(), { capture: true });
    bindKey({ keys: "Escape", does: "end drawing", on: (event) => this.on && event.key === "Escape", run: () => this.show(false) });
    model.on("role", () => this.element.toggleAttribute("inert", !model.role.leads));
  }

  /** Draws the curve of a setting. */
  draw(place: Place, label: string): void {
    this.place = place;
    this.title.textContent = `Draw ${label}`;
    this.words.textContent = `${this.leaves ? FREE : ON_SKIN} The right button, Alt or the arrow keys orbit the camera.`;
    this.lifts.hidden = this.leaves;
    this.show(true);
  }

  /** Whether the line may leave the head, as a guide does. */
  private get leaves(): boolean {
    return this.place.at(-1) === "drawn";
  }

  show(on: boolean): void {
    if (on === this.on && !on) return;
    this.on = on;
    for (const listener of this.changed) listener(on); // other tools are laid down before this one sets the view
    this.element.toggleAttribute("hidden", !on);
    this.viewer.controls.mouseButtons.RIGHT = on ? MOUSE.ROTATE : MOUSE.PAN;
    this.viewer.showHair(!on || this.hair.checked);
    this.viewer.element.classList.toggle("sculpts", on);
    this.line.visible = false;
    this.viewer.invalidate();
  }

  private tell(): void {
    this.height.textContent = `${this.lift.value} mm`;
  }

  private press(event: PointerEvent): void {
    if (!this.on || event.button !== 0 || event.altKey || this.viewer.compared || !this.model.role.leads) return;
    event.stopPropagation();
    event.preventDefault();
    this.viewer.element.setPointerCapture(event.pointerId);
    this.stroke = [];
    this.add(event);
  }

  private move(event: PointerEvent): void {
    if (!this.on || !this.stroke.length) return;
    event.stopPropagation();
    this.add(event);
  }

  private add(event: PointerEvent): void {
    const { viewer } = this;
    const skin = onSurface(viewer.surfaces, viewer.camera, viewer.size, viewer.at(event));
    const at = this.leaves && this.stroke.length ? this.before(skin, inPlane(viewer.at(event), this.stroke[0], viewer.camera, viewer.size)) : skin;
    if (!at) return;
    this.stroke.push(at);
    this.line.geometry.dispose();
    this.line.geometry = new BufferGeometry().setFromPoints(this.lifted(this.leaves ? 0 : Math.max(SKIN, this.lift.value / 1000)));
    this.line.visible = this.stroke.length > 1;
    viewer.invalidate();
  }

  /** Of a place on the skin, if there is one, and one in the plane the nearer to the eye; above the skin. */
  private before(skin: Vector3 | null, plane: Vector3): Vector3 {
    const eye = this.viewer.camera.position;
    if (!skin || plane.distanceTo(eye) < skin.distanceTo(eye)) return plane;
    return skin.clone().addScaledVector(skin.clone().sub(this.viewer.middle).normalize(), ABOVE);
  }

  /** The stroke, whose end is lifted off the head. */
  private lifted(height: number): Vector3[] {
    const { middle } = this.viewer;
    const last = Math.max(1, this.stroke.length - 1);
    return this.stroke.map((at, k) => at.clone().addScaledVector(at.clone().sub(middle).normalize(), (height * k) / last));
  }

  private release(): void {
    if (!this.stroke.length) return;
    const points = this.lifted(this.leaves ? 0 : this.lift.value / 1000).map(({ x, y, z }): [number, number, number] => [x, y, z]);
    this.stroke = [];
    this.line.visible = false;
    if (points.length > 1) this.model.say({ kind: "draw", place: this.place, points, gesture: this.model.newGesture() });
    this.viewer.invalidate();
  }
}
