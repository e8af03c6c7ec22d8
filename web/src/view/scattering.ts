// The light that hairs, skin and surroundings scatter.
//
// A beam includes what is scattered forward: extinction is scaled by 1 - ωf, with f = g² (delta-Eddington: Joseph et al.
// 1976). The rest is scattered with the mean cosine g' = g / (1 + g), and transported along the six directions of the
// axes (six-flux: Chu and Churchill 1955).

import type { Vector3 } from "three";
import type { Beam } from "./beam";
import { at, type Transport } from "./fiber";
import { type Four, four, type Grid, type Matter, type Three, three } from "./grid";

const SWEEPS = 12; // of the scattered light: it converges by the depth of the hair in free paths
const SWEEPS_MORE = 3; // where it begins with a field that is nearly right

/** The scattered light, on voxels of twice the size. */
export class Scattering {
  readonly counts: [number, number, number];
  /** Mean radiance in red, green and blue, and its luminance. */
  readonly mean: Four;
  /** Mean of the luminance times the direction in which it travels; mean square of the sine between hairs. */
  readonly flow: Four;
  private readonly keep: Three; // of the light, what crosses a voxel
  private readonly scatter: Three; // albedo
  private readonly forward: Three; // albedo times the mean cosine
  private readonly source: Three; // of the beams: mean radiance
  private readonly stream: Three[]; // of the beams: the same times the direction, of each channel
  private readonly flux: Three[];
  private fresh = true;

  constructor({ counts }: Grid) {
    this.counts = [counts[0] / 2, counts[1] / 2, counts[2] / 2];
    const voxels = this.counts[0] * this.counts[1] * this.counts[2];
    [this.mean, this.flow] = [four(voxels), four(voxels)];
    [this.keep, this.scatter, this.forward, this.source] = [three(voxels), three(voxels), three(voxels), three(voxels)];
    this.stream = [three(voxels), three(voxels), three(voxels)];
    this.flux = [three(voxels), three(voxels), three(voxels)];
  }

  reset(): void {
    this.fresh = true;
  }

  *light(
    matter: Matter,
    beams: Beam[],
    depth: Four,
    passed: Four,
    ambient: Vector3,
    transport: Transport,
  ): Generator<void, void> {
    yield* this.gather(matter, beams, depth, passed, transport);
    const sky = ambient.toArray();
    for (let c = 0; c < 3; c++) {
      if (this.fresh) for (const values of [this.mean[c], ...this.flux[c]]) values.fill(0);
      for (let i = 0; i < (this.fresh ? SWEEPS : SWEEPS_MORE); i++) {
        this.transport(c, sky[c]);
        yield;
      }
    }
    this.fresh = false;
    const luminance = (to: Float32Array, red: Float32Array, green: Float32Array, blue: Float32Array) => {
      for (let i = 0; i < to.length; i++) to[i] = 0.2126 * red[i] + 0.7152 * green[i] + 0.0722 * blue[i];
    };
    luminance(this.mean[3], this.mean[0], this.mean[1], this.mean[2]);
    const [red, green, blue] = this.flux;
    for (let axis = 0; axis < 3; axis++) luminance(this.flow[axis], red[axis], green[axis], blue[axis]);
  }

  /** Matter and beams of the voxels, from the eight of the grid in each. */
  private *gather(
    { grid, hair, loose, tone, along, skin, albedo }: Matter,
    beams: Beam[],
    depth: Four,
    passed: Four,
    t: Transport,
  ): Generator<void, void> {
    const [nx, ny] = grid.counts;
    const [cx, cy, cz] = this.counts;
    const strength = beams.map((beam) => beam.strength.toArray());
    const from = beams.map(() => [0, 0, 0]);
    const near = beams.map(() => 0);
    const corners = Array.from({ length: 8 }, (_, at) => (at & 1) + nx * (((at >> 1) & 1) + ny * (at >> 2)));
    const empty = (first: number) => corners.every((corner) => hair[first + corner] === 0 && skin[first + corner] === 0);
    for (let k = 0, to = 0; k < cz; k++)
      for (let j = 0; j < cy; j++)
        for (let i = 0; i < cx; i++, to++) {
          if (i + j === 0) yield;
          const first = 2 * i + nx * (2 * j + ny * 2 * k);
          if (empty(first)) {
            this.flow[3][to] = 1;
            for (let c = 0; c < 3; c++) {
              this.keep[c][to] = 1;
              for (const values of [this.scatter[c], this.forward[c], this.source[c], ...this.stream[c]]) values[to] = 0;
            }
            continue;
          }
          let [sigma, free, solid] = [0, 0, 0];
          const [q, bare, mean] = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
          const arriving = [0, 0, 0, 0];
          const optical = [0, 0, 0, 0];
          for (const corner of corners) {
            const at = first + corner;
            sigma += hair[at] / 8;
            free += loose[at] / 8;
            solid += skin[at] / 4;
            for (let c = 0; c < 3; c++) {
              q[c] += tone[c][at] / 8;
              mean[c] += along[c][at] / 8;
              bare[c] += (skin[at] * albedo[3 * at + c]) / 4;
            }
            for (let l = 0; l < 4; l++) {
              arriving[l] += passed[l][at] / 8;
              optical[l] += depth[l][at] / 8;
            }
          }
          this.flow[3][to] = sigma > 0 ? Math.max(0, 1 - mean.reduce((sum, x) => sum + x * x, 0) / sigma ** 2) : 1;
          beams.forEach(({ place, reach, radius }, l) => {
            const towards = [place.x, place.y, place.z];
            [i, j, k].forEach((at, axis) => (towards[axis] -= grid.origin.getComponent(axis) + (2 * at + 1) * grid.size));
            const middle = Math.hypot(...towards);
            const edge = Math.hypot(middle, radius);
            near[l] = (2 * reach * reach) / (edge * (edge + middle));
            for (let axis = 0; axis < 3; axis++) from[l][axis] = towards[axis] / middle;
          });
          for (let c = 0; c < 3; c++) {
            const color = sigma > 0 ? q[c] / sigma : 0;
            const [omega, g] = [at(t.albedo, color), at(t.forward, color)];
            const scaled = sigma * (1 - omega * g * g) * 2 * grid.size;
            const rest = escaping((omega * (1 - g * g)) / (1 - omega * g * g), free > 0 ? sigma / free : 1);
            const total = scaled + solid;
            this.keep[c][to] = Math.exp(-total);
            this.scatter[c][to] = total > 0 ? (rest * scaled + wall(solid > 0 ? bare[c] / solid : 0) * solid) / total : 0;
            this.forward[c][to] = total > 0 ? ((g / (1 + g)) * rest * scaled) / total : 0;
            let beamed = 0;
            const streamed = [0, 0, 0];
            for (let l = 0; l < beams.length; l++) {
              const one = (strength[l][c] * near[l] * arriving[l] * Math.exp(-optical[l] * (1 - omega * g * g))) / (4 * Math.PI);
              beamed += one;
              for (let axis = 0; axis < 3; axis++) streamed[axis] -= one * from[l][axis];
            }
            this.source[c][to] = beamed;
            for (let axis = 0; axis < 3; axis++) this.stream[c][axis][to] = streamed[axis];
          }
        }
  }

  /** One sweep along each direction with the source of the sweep before. */
  private transport(c: number, sky: number): void {
    const [nx, ny, nz] = this.counts;
    const strides = [1, nx, nx * ny];
    const counts = [nx, ny, nz];
    const [keep, scatter, forward, source, mean] = [this.keep[c], this.scatter[c], this.forward[c], this.source[c], this.mean[c]];
    const sum = new Float32Array(mean.length);
    for (let axis = 0; axis < 3; axis++) {
      const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
      const [flux, stream] = [this.flux[c][axis], this.stream[c][axis]];
      const net = new Float32Array(mean.length);
      for (let b = 0; b < counts[v]; b++)
        for (let a = 0; a < counts[u]; a++)
          for (const way of [1, -1]) {
            const stride = way * strides[axis];
            let index = a * strides[u] + b * strides[v] + (way < 0 ? (counts[axis] - 1) * strides[axis] : 0);
            let radiance = sky;
            for (let m = 0; m < counts[axis]; m++, index += stride) {
              if (keep[index] === 1) {
                sum[index] += radiance; // nothing is there, as in most voxels
                net[index] += way * radiance;
                continue;
              }
              const even = scatter[index] * (mean[index] + source[index]);
              const sent = even + way * 3 * forward[index] * (flux[index] + stream[index]);
              const after = radiance * keep[index] + (1 - keep[index]) * Math.max(sent, 0);
              const within = 0.5 * (radiance + after);
              sum[index] += within;
              net[index] += way * within;
              radiance = after;
            }
          }
      for (let i = 0; i < net.length; i++) flux[i] = net[i] / 6;
    }
    for (let i = 0; i < mean.length; i++) mean[i] = sum[i] / 6;
  }
}

/** Albedo of a clump of hairs of an albedo, with a clumping index: a scattered photon leaves it with that probability, or
 * meets another of its hairs (Smolander and Stenberg 2005). */
function escaping(albedo: number, index: number): number {
  return (albedo * index) / (1 - albedo * (1 - index));
}

/** Albedo of voxels of a wall that sends as much as a diffuse one of an albedo a, lit from one side: they light each other. */
function wall(a: number): number {
  return (2 * a) / (1 + (4 / 3) * a);
}
