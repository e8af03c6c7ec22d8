// Drawing on the scalp: a stroke becomes the helper curve that a setting names, such as a part line. A guide begins on the
// scalp and may leave it: off the skin it is drawn in the plane of the picture through its root.

import { BufferGeometry, Line, LineBasicMaterial, type Vector3 } from "three";
import { h } from "../dom";
import type { Model, Place } from "../model";
import { inPlane } from "../view/pick";
import { onSurface } from "../view/surface";
import type { Viewer } from "../view/viewer";
import { HandTool, row } from "./hand_tool";
import { Slider } from "./slider";

const SKIN = 0.0008; // distance of a line from the skin, so that it is seen [m]
const ABOVE = 0.003; // distance of a guide from the skin over which it is drawn [m]
const ON_SKIN = "Draw a line over the scalp. A new line replaces it.";
const FREE = "Draw from the root to the tip: begin on the scalp, and leave it where the hair stands up. Each line is one more guide.";

export class DrawTool extends HandTool {
  private readonly endLift = new Slider({ id: "draw-lift" }, () => this.tell());
  private readonly height = h("output", { class: "unit", for: "draw-lift" });
  private readonly line = new Line(new BufferGeometry(), new LineBasicMaterial({ color: 0xff9e4d, depthTest: false }));
  private readonly words = h("p", { class: "hint" });
  private readonly lifts: HTMLElement;
  private place: Place = [];
  private stroke: Vector3[] = [];

  constructor(model: Model, viewer: Viewer) {
    super(model, viewer, "draw", "Draw on the scalp", "end drawing");
    this.line.frustumCulled = false;
    this.line.visible = false;
    viewer.painted.scene.add(this.line);
    this.lifts = row("end lift", this.endLift.element, this.height);
    this.element.append(
      this.words,
      this.lifts,
      row("show hair", this.hair),
      h("div", { class: "group" }, this.done),
    );
    this.endLift.set(0, { least: 0, most: 150, step: 1 });
    this.tell();
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

  protected turned(): void {
    this.line.visible = false;
  }

  private tell(): void {
    this.height.textContent = `${this.endLift.value} mm`;
  }

  protected press(event: PointerEvent): void {
    this.hold(event);
    this.stroke = [];
    this.add(event);
  }

  protected move(event: PointerEvent): void {
    if (!this.stroke.length) return;
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
    this.line.geometry = new BufferGeometry().setFromPoints(this.lifted(this.leaves ? 0 : Math.max(SKIN, this.endLift.value / 1000)));
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

  protected lift(): void {
    if (!this.stroke.length) return;
    const points = this.lifted(this.leaves ? 0 : this.endLift.value / 1000).map(({ x, y, z }): [number, number, number] => [x, y, z]);
    this.stroke = [];
    this.line.visible = false;
    if (points.length > 1) this.model.say({ kind: "draw", place: this.place, points, gesture: this.model.newGesture() });
    this.viewer.invalidate();
  }
}
