// Light in the mass of the hair, on a grid of voxels: how much of each lamp reaches a place, and the light that hairs,
// skin and surroundings scatter there.
//
// Extinction is that of fibers of all directions, σ = Σ π/4 · diameter · length per volume. A lamp is a disk nearby: its
// light comes from three points of it, each of which throws its own shadow. A beam includes what is
// scattered forward: extinction is scaled by 1 - ωf, with f = g² (delta-Eddington: Joseph et al. 1976). The rest is
// scattered with the mean cosine g' = g / (1 + g), and transported along the six directions of the axes (six-flux: Chu
// and Churchill 1955).

import {
  type Box3,
  ClampToEdgeWrapping,
  Data3DTexture,
  DataUtils,
  HalfFloatType,
  LinearFilter,
  RGBAFormat,
  Vector3,
} from "three";
import { at, type Transport } from "./fiber";

/** Voxels along the longest side of the grid. */
const VOXELS = 64;
const LAMP_POINTS = 3; // of a lamp's disk, from which shadows are cast
const DARKEST = 1e-6; // least part of a lamp's light: keeps optical depths finite
const SHELL = 6; // optical depth of a voxel of skin
const SWEEPS = 12; // of the scattered light: it converges by the depth of the hair in free paths
const SWEEPS_MORE = 3; // where it begins with a field that is nearly right

/** A lamp: a disk at a place, direction from the subject towards it, its radius, and the irradiance at its reach [m]. */
export interface Beam {
  from: Vector3;
  place: Vector3;
  reach: number;
  radius: number;
  strength: Vector3;
}

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

/** What fills the grid: extinction by hair [1/m], its q and its direction times that, optical depth and albedo of skin. */
export interface Matter {
  grid: Grid;
  hair: Float32Array;
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

/** Optical depth towards each of four lamps, or the part of its light that passes skin. */
type Four = [Float32Array, Float32Array, Float32Array, Float32Array];

export class LightVolume {
  readonly uniforms = {
    gridOrigin: { value: new Vector3() },
    gridSize: { value: new Vector3(1, 1, 1) },
    gridDepth: { value: texture([1, 1, 1]) },
    gridPassed: { value: open() },
    gridField: { value: texture([1, 1, 1]) },
    gridFlux: { value: texture([1, 1, 1]) },
  };
  private depth: Four | null = null;
  private passed: Four | null = null;
  private coarse: Coarse | null = null;
  private matter: Matter | null = null;

  fill(matter: Matter): void {
    const { grid } = matter;
    if (!this.matter || !same(this.matter.grid.counts, grid.counts)) {
      this.depth = four(grid.voxels);
      this.passed = four(grid.voxels);
      this.coarse = new Coarse(grid);
    }
    this.matter = matter;
    this.coarse?.reset();
  }

  /** Lights the grid in small steps, with the last of which it is seen. */
  *light(beams: Beam[], ambient: Vector3, transport: Transport): Generator<void, void> {
    const { matter, depth, passed, coarse } = this;
    if (!matter || !depth || !passed || !coarse) return;
    for (const [k, beam] of beams.entries()) yield* cast(matter, beam, depth[k], passed[k]);
    yield* coarse.light(matter, beams, depth, passed, ambient, transport);
    const fine = matter.grid.counts;
    const packed: Uint16Array[] = [];
    for (const values of [depth, passed, coarse.mean, coarse.flow]) {
      packed.push(pack(values));
      yield;
    }
    const { gridOrigin, gridSize, gridDepth, gridPassed, gridField, gridFlux } = this.uniforms;
    [gridDepth, gridPassed, gridField, gridFlux].forEach((one, k) => fillTexture(one, k < 2 ? fine : coarse.counts, packed[k]));
    gridOrigin.value.copy(matter.grid.origin);
    gridSize.value.set(...fine).multiplyScalar(matter.grid.size);
  }

  dispose(): void {
    const { gridDepth, gridPassed, gridField, gridFlux } = this.uniforms;
    for (const uniform of [gridDepth, gridPassed, gridField, gridFlux]) uniform.value.dispose();
  }
}

/** Points of a lamp's disk that stand for it, at the root mean square of its radii. */
function pointsOf({ from, place, radius }: Beam): Vector3[] {
  const right = new Vector3(-from.z, 0, from.x).normalize();
  const up = new Vector3().crossVectors(right, from);
  return Array.from({ length: LAMP_POINTS }, (_, k) => {
    const angle = (2 * Math.PI * k) / LAMP_POINTS;
    const [x, y] = [Math.cos(angle), Math.sin(angle)].map((value) => value * Math.SQRT1_2 * radius);
    return place.clone().addScaledVector(right, x).addScaledVector(up, y);
  });
}

/** Optical depth of hair and passage of skin towards a lamp, by the mean of what passes from its points. */
function* cast(matter: Matter, beam: Beam, depth: Float32Array, passed: Float32Array): Generator<void, void> {
  depth.fill(0);
  passed.fill(0);
  if (beam.strength.lengthSq() === 0) return;
  for (const point of pointsOf(beam)) {
    sweep(matter, point, depth, passed);
    yield;
  }
  for (let i = 0; i < depth.length; i++) {
    depth[i] = depth[i] >= LAMP_POINTS ? 0 : -Math.log(Math.max(depth[i] / LAMP_POINTS, DARKEST));
    passed[i] /= LAMP_POINTS;
  }
}

/** Adds what hair and what skin let pass from a point of light, slice by slice away from it, interpolated in each. */
function sweep({ grid, hair, skin }: Matter, light: Vector3, throughHair: Float32Array, throughSkin: Float32Array): void {
  const { counts, size, origin } = grid;
  const at = light.clone().sub(origin).divideScalar(size).subScalar(0.5).toArray(); // in voxels, from the middle of the first
  const away = at.map((place, axis) => Math.abs(place - 0.5 * (counts[axis] - 1)));
  const main = away.indexOf(Math.max(...away));
  const [u, v] = [(main + 1) % 3, (main + 2) % 3];
  const strides = [1, counts[0], counts[0] * counts[1]];
  const [nu, nv, nm] = [counts[u], counts[v], counts[main]];
  const above = at[main] > 0.5 * (nm - 1);
  // What leaves the slice before, with a border of what comes from outside of the grid.
  const wide = nu + 2;
  let [depths, passages] = [new Float32Array(wide * (nv + 2)), new Float32Array(wide * (nv + 2)).fill(1)];
  let [nextDepths, nextPassages] = [depths.slice(), passages.slice()];
  for (let m = 0; m < nm; m++) {
    const slice = above ? nm - 1 - m : m;
    const nearer = 1 / Math.max(Math.abs(at[main] - slice), 1); // part of the way to the light from slice to slice
    for (let b = 0; b < nv; b++) {
      const dv = (at[v] - b) * nearer;
      const y = Math.min(Math.max(b + dv, -1), nv - 1e-3);
      const iv = Math.floor(y);
      const fv = y - iv;
      const row = 1 + (iv + 1) * wide;
      let here = slice * strides[main] + b * strides[v];
      let to = 1 + (b + 1) * wide;
      for (let a = 0; a < nu; a++, here += strides[u], to++) {
        const du = (at[u] - a) * nearer;
        const x = Math.min(Math.max(a + du, -1), nu - 1e-3);
        const iu = Math.floor(x);
        const fu = x - iu;
        const there = row + iu;
        const d0 = depths[there] + fu * (depths[there + 1] - depths[there]);
        const d1 = depths[there + wide] + fu * (depths[there + wide + 1] - depths[there + wide]);
        const p0 = passages[there] + fu * (passages[there + 1] - passages[there]);
        const p1 = passages[there + wide] + fu * (passages[there + wide + 1] - passages[there + wide]);
        let d = d0 + fv * (d1 - d0);
        let p = p0 + fv * (p1 - p0);
        if (hair[here] > 0 || skin[here] > 0) {
          const half = 0.5 * Math.sqrt(1 + du * du + dv * dv);
          const within = half * size * hair[here];
          const shell = skin[here] > 0 ? Math.exp(-half * skin[here]) : 1;
          p *= shell;
          d += within;
          nextDepths[to] = d + within;
          nextPassages[to] = p * shell;
        } else {
          nextDepths[to] = d;
          nextPassages[to] = p;
        }
        throughHair[here] += d > 0 ? Math.exp(-d) : 1;
        throughSkin[here] += p;
      }
    }
    [depths, nextDepths] = [nextDepths, depths];
    [passages, nextPassages] = [nextPassages, passages];
  }
}

/** The scattered light, on voxels of twice the size. */
class Coarse {
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
    { grid, hair, tone, along, skin, albedo }: Matter,
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
          let [sigma, solid] = [0, 0];
          const [q, bare, mean] = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
          const arriving = [0, 0, 0, 0];
          const optical = [0, 0, 0, 0];
          for (const corner of corners) {
            const at = first + corner;
            sigma += hair[at] / 8;
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
            const rest = (omega * (1 - g * g)) / (1 - omega * g * g);
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

/** Albedo of voxels of a wall that sends as much as a diffuse one of an albedo a, lit from one side: they light each other. */
function wall(a: number): number {
  return (2 * a) / (1 + (4 / 3) * a);
}

type Three = [Float32Array, Float32Array, Float32Array];

function three(count: number): Three {
  return [new Float32Array(count), new Float32Array(count), new Float32Array(count)];
}

function four(count: number): Four {
  return [...three(count), new Float32Array(count)];
}

function same(a: number[], b: number[]): boolean {
  return a.every((value, i) => value === b[i]);
}

function texture([x, y, z]: [number, number, number]): Data3DTexture {
  const made = new Data3DTexture(new Uint16Array(4 * x * y * z), x, y, z);
  return Object.assign(made, {
    type: HalfFloatType,
    format: RGBAFormat,
    minFilter: LinearFilter,
    magFilter: LinearFilter,
    wrapS: ClampToEdgeWrapping,
    wrapT: ClampToEdgeWrapping,
    wrapR: ClampToEdgeWrapping,
  });
}

/** A grid through which all light passes. */
function open(): Data3DTexture {
  const made = texture([1, 1, 1]);
  (made.image.data as unknown as Uint16Array).fill(DataUtils.toHalfFloat(1));
  made.needsUpdate = true;
  return made;
}

function pack(values: Four): Uint16Array {
  const data = new Uint16Array(4 * values[0].length);
  for (let c = 0; c < 4; c++) {
    const from = values[c];
    for (let i = 0; i < from.length; i++) if (from[i] !== 0) data[4 * i + c] = DataUtils.toHalfFloat(from[i]);
  }
  return data;
}

/** Gives a texture other values; the memory on the card is kept where they are as many. */
function fillTexture(uniform: { value: Data3DTexture }, counts: [number, number, number], values: Uint16Array): void {
  const { width, height, depth } = uniform.value.image;
  if (!same([width, height, depth], counts)) {
    uniform.value.dispose();
    uniform.value = texture(counts);
  }
  (uniform.value.image.data as unknown as Uint16Array).set(values);
  uniform.value.needsUpdate = true;
}

/** Looks the grid up. */
export const VOLUME = /* glsl */ `
uniform highp sampler3D gridDepth, gridPassed, gridField, gridFlux;
uniform vec3 gridOrigin, gridSize; // first corner, extent [m]
vec3 inGrid(vec3 place) { return (place - gridOrigin) / gridSize; }
vec4 opticalDepth(vec3 place) { return texture(gridDepth, inGrid(place)); }
vec4 pastBodies(vec3 place) { return texture(gridPassed, inGrid(place)); }

// Mean radiance, weighted by 1 + slope · (cosine of its travel to a direction).
// disorder: mean square of the sine between hairs
vec3 scattered(vec3 place, vec3 direction, vec3 slope, out float disorder) {
  vec3 at = inGrid(place);
  vec4 mean = texture(gridField, at), flux = texture(gridFlux, at);
  float cosine = dot(flux.xyz, direction) / max(mean.w, 1e-6);
  disorder = flux.w;
  return mean.rgb * max(1.0 + slope * cosine, 0.0);
}
`;
