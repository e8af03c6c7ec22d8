// What is laid over the scalp: a painted map, black where it is 0 and the accent where it is 1, with a short line along
// each of its directions, and lines that are drawn.

import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, Scene } from "three";
import type { Painted } from "../protocol";

const LOW = [0.05, 0.06, 0.1];
const HIGH = [1.0, 0.62, 0.3];
const LENGTH = 0.006; // of the line of a direction [m]
const ABOVE = 0.0015; // of these lines over the skin [m]

export class PaintedMap {
  readonly scene = new Scene();
  private readonly mesh: Mesh;
  private readonly geometry = new BufferGeometry();
  private readonly lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: 0xfff2e0 }));

  constructor() {
    const material = new MeshBasicMaterial({
      vertexColors: true,
      transparent: true,
      opacity: 0.72,
      polygonOffset: true,
      polygonOffsetFactor: -2,
      polygonOffsetUnits: -4,
    });
    this.mesh = new Mesh(this.geometry, material);
    this.mesh.frustumCulled = this.mesh.visible = false;
    this.lines.frustumCulled = this.lines.visible = false;
    this.scene.add(this.mesh, this.lines);
  }

  get shown(): boolean {
    return this.mesh.visible;
  }

  set shown(on: boolean) {
    this.mesh.visible = this.lines.visible = on;
  }

  set({ points, triangles, values, directions }: Painted): void {
    const colors = new Float32Array(points.length);
    values.forEach((value, k) => {
      for (let c = 0; c < 3; c++) colors[3 * k + c] = LOW[c] + (value / 255) * (HIGH[c] - LOW[c]);
    });
    this.geometry.setIndex(new BufferAttribute(triangles, 1));
    this.geometry.setAttribute("position", new BufferAttribute(points, 3));
    this.geometry.setAttribute("color", new BufferAttribute(colors, 3));
    this.geometry.computeVertexNormals();
    const normals = this.geometry.getAttribute("normal").array;
    const ends: number[] = [];
    values.forEach((value, k) => {
      if (!value || !directions.length) return;
      for (const part of [0, LENGTH])
        for (let i = 3 * k; i < 3 * k + 3; i++) ends.push(points[i] + ABOVE * normals[i] + part * directions[i]);
    });
    this.lines.geometry.dispose();
    this.lines.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(ends), 3));
  }
}
