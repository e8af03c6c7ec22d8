// The guides as lines: those that were sculpted stand out.

import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, Scene } from "three";
import type { Guides } from "../protocol";

const PLAIN = [0.93, 0.89, 0.82];
const CHANGED = [1.0, 0.62, 0.3];

export class GuideLines {
  readonly scene = new Scene();
  guides: Guides | null = null;
  shown = false;
  private readonly geometry = new BufferGeometry();

  constructor() {
    const material = new LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.85 });
    const lines = new LineSegments(this.geometry, material);
    lines.frustumCulled = false;
    this.scene.add(lines);
  }

  set(guides: Guides): void {
    const { points, offsets, changed } = guides;
    const index: number[] = [];
    for (let k = 0; k + 1 < offsets.length; k++)
      for (let i = offsets[k]; i + 1 < offsets[k + 1]; i++) index.push(i, i + 1);
    this.guides = guides;
    this.geometry.setIndex(index);
    this.geometry.setAttribute("position", new BufferAttribute(points, 3));
    const colors = new Float32Array(points.length);
    for (let k = 0; k + 1 < offsets.length; k++)
      for (let i = offsets[k]; i < offsets[k + 1]; i++) colors.set(changed[k] ? CHANGED : PLAIN, 3 * i);
    this.geometry.setAttribute("color", new BufferAttribute(colors, 3));
  }
}
