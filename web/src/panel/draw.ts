// Drawing on the scalp: a stroke becomes the helper curve that a setting names, such as a part line.

import { BufferGeometry, Line, LineBasicMaterial, Vector3 } from "three";
import { h } from "../dom";
import type { Model, Place } from "../model";
import { onSurface } from "../view/surface";
import type { Viewer } from "../view/viewer";
import { HandTool, row } from "./hand_tool";
import { Slider } from "./slider";

const SKIN = 0.0008; // distance of a line from the skin, so that it is seen [m]

export class DrawTool extends HandTool {
  private readonly endLift = new Slider({ id: "draw-lift" }, () => this.tell());
  private readonly height = h("output", { class: "unit", for: "draw-lift" });
  private readonly line = new Line(new BufferGeometry(), new LineBasicMaterial({ color: 0xff9e4d, depthTest: false }));
  private place: Place = [];
  private stroke: Vector3[] = [];

  constructor(model: Model, viewer: Viewer) {
    super(model, viewer, "draw", "Draw on the scalp", "end drawing");
    this.line.frustumCulled = false;
    this.line.visible = false;
    viewer.painted.scene.add(this.line);
    this.element.append(
      h("p", { class: "told" }, "Draw a line over the scalp. A new line replaces it; the right button, Alt or the arrow keys orbit the camera."),
      row("end lift", this.endLift.element, this.height),
      row("show the hair", this.hair),
      h("div", { class: "group" }, this.done),
    );
    this.endLift.set(0, { least: 0, most: 150, step: 1 });
    this.tell();
  }

  /** Draws the curve of a setting. */
  draw(place: Place, label: string): void {
    this.place = place;
    this.title.textContent = `Draw ${label}`;
    this.show(true);
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
    const at = onSurface(viewer.surfaces, viewer.camera, viewer.size, viewer.at(event));
    if (!at) return;
    this.stroke.push(at);
    this.line.geometry.dispose();
    this.line.geometry = new BufferGeometry().setFromPoints(this.lifted(Math.max(SKIN, this.endLift.value / 1000)));
    this.line.visible = this.stroke.length > 1;
    viewer.invalidate();
  }

  /** The stroke, whose end is lifted off the head. */
  private lifted(height: number): Vector3[] {
    const { middle } = this.viewer;
    const last = Math.max(1, this.stroke.length - 1);
    return this.stroke.map((at, k) => at.clone().addScaledVector(at.clone().sub(middle).normalize(), (height * k) / last));
  }

  protected lift(): void {
    if (!this.stroke.length) return;
    const points = this.lifted(this.endLift.value / 1000).map(({ x, y, z }): [number, number, number] => [x, y, z]);
    this.stroke = [];
    this.line.visible = false;
    if (points.length > 1) this.model.say({ kind: "draw", place: this.place, points, gesture: this.model.newGesture() });
    this.viewer.invalidate();
  }
}
