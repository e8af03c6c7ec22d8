// The guides as lines: those that were sculpted stand out.

import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineLoop, LineSegments, Scene, Vector3 } from "three";
import type { Guides } from "../protocol";

const PLAIN = [0.93, 0.89, 0.82];
const CHANGED = [1.0, 0.62, 0.3];
const FROZEN = [0.4, 0.7, 1.0];
const PLANE = 0.16; // half the size of the outline of the plane of symmetry [m]

export class GuideLines {
  readonly scene = new Scene();
  guides: Guides | null = null;
  private readonly geometry = new BufferGeometry();
  private readonly lines: LineSegments;

  private readonly plane = new LineLoop(
    new BufferGeometry().setFromPoints(
      [
        [-PLANE, -PLANE],
        [PLANE, -PLANE],
        [PLANE, PLANE],
        [-PLANE, PLANE],
      ].map(([y, z]) => new Vector3(0, y, z)),
    ),
    new LineBasicMaterial({ color: 0x66b2ff, transparent: true, opacity: 0.9 }),
  );

  constructor() {
    this.plane.visible = false;
    this.scene.add(this.plane);
    const material = new LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.85 });
    this.lines = new LineSegments(this.geometry, material);
    this.lines.frustumCulled = this.lines.visible = false;
    this.scene.add(this.lines);
  }

  /** Whether the guides are shown. */
  get shown(): boolean {
    return this.lines.visible;
  }

  set shown(on: boolean) {
    this.lines.visible = on;
  }

  /** Shows the plane in which a brush is mirrored, or hides it. */
  showPlane(on: boolean): void {
    this.plane.visible = on && this.guides !== null;
  }

  set(guides: Guides): void {
    const { points, offsets, changed, frozen } = guides;
    this.plane.position.fromArray(guides.middle);
    const index: number[] = [];
    for (let k = 0; k + 1 < offsets.length; k++)
      for (let i = offsets[k]; i + 1 < offsets[k + 1]; i++) index.push(i, i + 1);
    this.guides = guides;
    this.geometry.setIndex(index);
    this.geometry.setAttribute("position", new BufferAttribute(points, 3));
    const colors = new Float32Array(points.length);
    for (let k = 0; k + 1 < offsets.length; k++)
      for (let i = offsets[k]; i < offsets[k + 1]; i++) colors.set(frozen[k] ? FROZEN : changed[k] ? CHANGED : PLAIN, 3 * i);
    this.geometry.setAttribute("color", new BufferAttribute(colors, 3));
  }
}
