// The voxels in which hair and bodies are summed up, and what fills them.

import { type Box3, Vector3 } from "three";

/** Voxels along the longest side of the grid. */
const VOXELS = 64;
const SHELL = 6; // optical depth of a voxel of skin
const MARGIN = 0.35; // how far the grid reaches around the hair and below it, in heights of the hair

/** The voxels: how many along each axis, their size and first corner [m]. */
export class Grid {
  readonly counts: [number, number, number];
  readonly origin = new Vector3();
  readonly size: number;

  constructor(box: Box3, voxels: number) {
    const extent = box.getSize(new Vector3());
    this.size = Math.max(extent.x, extent.y, extent.z, 1e-3) / (voxels - 4);
    const even = (length: number) => 2 * Math.ceil((length / this.size + 4) / 2);
    this.counts = [even(extent.x), even(extent.y), even(extent.z)];
    const middle = box.getCenter(new Vector3());
    const half = new Vector3(...this.counts).multiplyScalar(0.5 * this.size);
    this.origin.copy(middle).sub(half);
  }

  static of(box: Box3): Grid {
    return new Grid(box, VOXELS);
  }

  get voxels(): number {
    return this.counts[0] * this.counts[1] * this.counts[2];
  }

  /** Index of the voxel of a place; -1 outside. */
  index(x: number, y: number, z: number): number {
    const [nx, ny, nz] = this.counts;
    const i = Math.floor((x - this.origin.x) / this.size);
    const j = Math.floor((y - this.origin.y) / this.size);
    const k = Math.floor((z - this.origin.z) / this.size);
    if (i < 0 || j < 0 || k < 0 || i >= nx || j >= ny || k >= nz) return -1;
    return i + nx * (j + ny * k);
  }
}

/** A surface of skin or cloth: three numbers a point. */
export interface Surface {
  points: Float32Array;
  normals: Float32Array;
  colors: Float32Array;
  triangles: Uint32Array;
}

/** What the grid covers: the hair, what it throws shadows on below it, and the surfaces within a margin around it: a place outside of the grid has the light of its border. */
export function around(hair: Box3, bodies: Iterable<Surface>): Box3 {
  const margin = MARGIN * (hair.max.y - hair.min.y);
  const box = hair.clone();
  box.min.y -= margin;
  const within = box.clone().expandByVector(new Vector3(margin, 0, margin));
  const place = new Vector3();
  for (const { points } of bodies)
    for (let i = 0; i < points.length; i += 3) if (within.containsPoint(place.fromArray(points, i))) box.expandByPoint(place);
  return box;
}

/** What fills the grid: extinction by hair [1/m], the same if hairs did not cover one another in their locks, its q and its direction times that, optical depth and albedo of skin. */
export interface Matter {
  grid: Grid;
  hair: Float32Array;
  loose: Float32Array;
  tone: [Float32Array, Float32Array, Float32Array];
  along: [Float32Array, Float32Array, Float32Array];
  skin: Float32Array;
  albedo: Float32Array; // three a voxel
}

/** Fills the voxels under surfaces: a shell one voxel below them, so that what lies on them is outside of it. */
export function* shell(grid: Grid, surfaces: Iterable<Surface>): Generator<void, Pick<Matter, "skin" | "albedo">> {
  const skin = new Float32Array(grid.voxels);
  const albedo = new Float32Array(3 * grid.voxels);
  for (const { points, normals, colors, triangles } of surfaces)
    for (let t = 0; t < triangles.length; t += 3) {
      if (t % 1500 === 0) yield;
      const corners = [triangles[t], triangles[t + 1], triangles[t + 2]];
      let longest = 0;
      for (let c = 0; c < 3; c++) {
        const [p, q] = [3 * corners[c], 3 * corners[(c + 1) % 3]];
        longest = Math.max(longest, Math.hypot(points[p] - points[q], points[p + 1] - points[q + 1], points[p + 2] - points[q + 2]));
      }
      const n = Math.min(Math.ceil((2 * longest) / grid.size), 64) || 1;
      for (let i = 0; i <= n; i++)
        for (let j = 0; i + j <= n; j++) {
          const weights = [i / n, j / n, 1 - (i + j) / n];
          const place = [0, 0, 0];
          for (let c = 0; c < 3; c++)
            for (let x = 0; x < 3; x++) {
              const from = 3 * corners[c] + x;
              place[x] += weights[c] * (points[from] - grid.size * normals[from]);
            }
          const index = grid.index(place[0], place[1], place[2]);
          if (index < 0) continue;
          skin[index] = SHELL;
          for (let x = 0; x < 3; x++) albedo[3 * index + x] = colors[3 * corners[0] + x];
        }
    }
  return { skin, albedo };
}

/** A number of each voxel towards each of four lamps, or in red, green and blue and their luminance. */
export type Four = [...Three, Float32Array];
export type Three = [Float32Array, Float32Array, Float32Array];

export function three(count: number): Three {
  return [new Float32Array(count), new Float32Array(count), new Float32Array(count)];
}

export function four(count: number): Four {
  return [...three(count), new Float32Array(count)];
}
