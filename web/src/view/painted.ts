// What is laid over the scalp: a painted map, black where it is 0 and the accent where it is 1, and lines that are drawn.

import { BufferAttribute, BufferGeometry, Mesh, MeshBasicMaterial, Scene } from "three";
import type { Painted } from "../protocol";

const LOW = [0.05, 0.06, 0.1];
const HIGH = [1.0, 0.62, 0.3];

export class PaintedMap {
  readonly scene = new Scene();
  private readonly mesh: Mesh;
  private readonly geometry = new BufferGeometry();

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
    this.scene.add(this.mesh);
  }

  get shown(): boolean {
    return this.mesh.visible;
  }

  set shown(on: boolean) {
    this.mesh.visible = on;
  }

  set({ points, triangles, values }: Painted): void {
    const colors = new Float32Array(points.length);
    values.forEach((value, k) => {
      for (let c = 0; c < 3; c++) colors[3 * k + c] = LOW[c] + (value / 255) * (HIGH[c] - LOW[c]);
    });
    this.geometry.setIndex(new BufferAttribute(triangles, 1));
    this.geometry.setAttribute("position", new BufferAttribute(points, 3));
    this.geometry.setAttribute("color", new BufferAttribute(colors, 3));
  }
}
