// How much hair is in each voxel: the points of hairs are added up on the graphics card, slices side by side.

import {
  AddEquation,
  CustomBlending,
  FloatType,
  GLSL3,
  HalfFloatType,
  InstancedBufferGeometry,
  NearestFilter,
  OneFactor,
  OrthographicCamera,
  Points,
  RawShaderMaterial,
  RGBAFormat,
  Scene,
  DataUtils,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { LOOKUP, TONE, TUBES } from "./shaders";
import type { Slices, Work } from "./slices";
import type { Grid, Matter } from "./grid";

const MOST = 300_000; // points that are added up; fewer hairs stand for all

const VERTEX = /* glsl */ `
precision highp float;
precision highp int;
precision highp sampler2D;
${LOOKUP}
${TONE}
uniform highp sampler2D hairPoints;
${TUBES}
uniform int points, every, firstHair;
uniform vec3 origin;
uniform ivec3 counts;
uniform int across;   // slices side by side
uniform vec2 extent;  // of the picture [pixels]
uniform float voxel, share;
uniform bool tangents; // adds up directions from root to tip and hairs as if they were in no order, in place of tones
out vec4 mass;
void main() {
  int hair = gl_InstanceID + firstHair, k = gl_VertexID * every, at = hair * points;
  vec4 here = lookup(hairPoints, at + k);
  vec3 next = here.xyz;
  float way = 0.0; // along the hair, which the chord to the next point cuts short where it bends
  for (int j = k + 1; j <= min(k + every, points - 1); j++) {
    vec3 before = next;
    next = lookup(hairPoints, at + j).xyz;
    way += distance(before, next);
  }
  ivec3 cell = ivec3(floor((here.xyz - origin) / voxel));
  float projected = 0.7853982 * here.w * way / (voxel * voxel * voxel);
  vec3 along = normalize(next - here.xyz + vec3(0.0, 1e-9, 0.0));
  vec3 value = tangents ? along : toneOf(hair, float(k) / float(points - 1));
  float index = clumping(tubeOf(at + k).w);
  mass = projected / share * vec4(index * value, tangents ? 1.0 : index);
  vec2 pixel = vec2(ivec2(cell.z % across, cell.z / across) * counts.xy + cell.xy) + 0.5;
  bool outside = any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, counts));
  gl_Position = outside ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(2.0 * pixel / extent - 1.0, 0.0, 1.0);
  gl_PointSize = 1.0;
}
`;
const FRAGMENT = /* glsl */ `
precision highp float;
in vec4 mass;
out vec4 color;
void main() { color = mass; }
`;

type Uniforms = Record<string, { value: unknown }>;

export class Density {
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera();
  private readonly material: RawShaderMaterial;
  private readonly mesh: Points;
  private target: WebGLRenderTarget | null = null;

  /** hair: the uniforms of the hair with its points and colors */
  constructor(private readonly hair: Uniforms) {
    this.material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        ...hair,
        every: { value: 1 },
        origin: { value: null },
        counts: { value: [1, 1, 1] },
        across: { value: 1 },
        extent: { value: [1, 1] },
        voxel: { value: 1 },
        share: { value: 1 },
        tangents: { value: false },
        firstHair: { value: 0 },
      },
      blending: CustomBlending,
      blendEquation: AddEquation,
      blendSrc: OneFactor,
      blendDst: OneFactor,
      depthTest: false,
      depthWrite: false,
      transparent: true,
    });
    this.mesh = new Points(new InstancedBufferGeometry(), this.material);
    this.mesh.frustumCulled = false;
    this.scene.add(this.mesh);
  }

  /** Number of the hairs that are added up, of so many: the first ones. */
  measured(hairs: number): number {
    return Math.min(hairs, Math.ceil(MOST / this.stations));
  }

  /** Every so many points of a hair one is added up, of as many stations. */
  private get every(): number {
    return Math.max(1, Math.floor((this.hair["points"].value as number) / 48));
  }

  private get stations(): number {
    return Math.ceil(((this.hair["points"].value as number) - 1) / this.every);
  }

  /** Extinction, tone and direction of the hair in the voxels. */
  *measure(renderer: WebGLRenderer, grid: Grid, hairs: number, slices: Slices): Work<Pick<Matter, "hair" | "loose" | "tone" | "along">> {
    const [nx, ny, nz] = grid.counts;
    const across = Math.ceil(Math.sqrt(nz));
    const [width, height] = [across * nx, Math.ceil(nz / across) * ny];
    const drawn = this.measured(hairs);
    const target = this.prepare(renderer, width, height);
    const { uniforms } = this.material;
    uniforms["every"].value = this.every;
    uniforms["origin"].value = grid.origin;
    uniforms["counts"].value = grid.counts;
    uniforms["across"].value = across;
    uniforms["extent"].value = [width, height];
    uniforms["voxel"].value = grid.size;
    uniforms["share"].value = drawn / Math.max(hairs, 1);
    const sums: Float32Array[][] = [];
    for (const tangents of [false, true]) {
      uniforms["tangents"].value = tangents;
      yield* this.add(renderer, target, drawn, slices);
      sums.push(yield* slices.compute(this.sum(renderer, target, grid, across)));
    }
    const [[x, y, z, hair], [dx, dy, dz, loose]] = sums;
    return { hair, loose, tone: [x, y, z], along: [dx, dy, dz] };
  }

  /** Adds up hairs on the graphics card. */
  private add(renderer: WebGLRenderer, target: WebGLRenderTarget, hairs: number, slices: Slices): Work {
    return slices.draw("density", hairs, (first, count) => {
      (this.mesh.geometry as InstancedBufferGeometry).instanceCount = count;
      this.material.uniforms["firstHair"].value = first;
      const before = renderer.getRenderTarget();
      renderer.setRenderTarget(target);
      renderer.setClearColor(0x000000, 0);
      if (!first) renderer.clear();
      renderer.render(this.scene, this.camera);
      renderer.setRenderTarget(before);
    });
  }

  /** Sums in the voxels: three numbers times the extinction, and the extinction. */
  private *sum(renderer: WebGLRenderer, target: WebGLRenderTarget, grid: Grid, across: number): Generator<void, Float32Array[]> {
    const [nx, ny, nz] = grid.counts;
    const values = read(renderer, target);
    const channels = [0, 1, 2, 3].map(() => new Float32Array(grid.voxels));
    for (let k = 0, to = 0; k < nz; k++) {
      for (let j = 0; j < ny; j++)
        for (let i = 0; i < nx; i++, to++) {
          const from = 4 * ((k % across) * nx + i + target.width * (Math.floor(k / across) * ny + j));
          for (let c = 0; c < 4; c++) channels[c][to] = values[from + c];
        }
      yield;
    }
    for (const channel of channels) {
      blur(channel, grid.counts);
      yield;
    }
    return channels;
  }

  dispose(): void {
    this.target?.dispose();
    this.material.dispose();
    this.mesh.geometry.dispose();
  }

  private prepare(renderer: WebGLRenderer, width: number, height: number): WebGLRenderTarget {
    const { stations } = this;
    if (this.mesh.geometry.index?.count !== stations) {
      this.mesh.geometry.dispose();
      const geometry = new InstancedBufferGeometry();
      geometry.setIndex([...Array(stations).keys()]);
      this.mesh.geometry = geometry;
    }
    if (this.target?.width === width && this.target.height === height) return this.target;
    this.target?.dispose();
    const blends = renderer.getContext().getExtension("EXT_float_blend") !== null;
    this.target = new WebGLRenderTarget(width, height, {
      type: blends ? FloatType : HalfFloatType,
      format: RGBAFormat,
      minFilter: NearestFilter,
      magFilter: NearestFilter,
      depthBuffer: false,
    });
    return this.target;
  }
}

function read(renderer: WebGLRenderer, target: WebGLRenderTarget): Float32Array {
  const { width, height } = target;
  const values = new Float32Array(4 * width * height);
  if (target.texture.type === FloatType) {
    renderer.readRenderTargetPixels(target, 0, 0, width, height, values);
    return values;
  }
  const half = new Uint16Array(values.length);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, half);
  for (let i = 0; i < half.length; i++) values[i] = DataUtils.fromHalfFloat(half[i]);
  return values;
}

/** A binomial filter of three voxels along each axis: points are in one voxel each. */
function blur(values: Float32Array, [nx, ny, nz]: [number, number, number]): void {
  const strides = [1, nx, nx * ny];
  const counts = [nx, ny, nz];
  for (let axis = 0; axis < 3; axis++) {
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    const stride = strides[axis];
    for (let b = 0; b < counts[v]; b++)
      for (let a = 0; a < counts[u]; a++) {
        let index = a * strides[u] + b * strides[v];
        let before = 0;
        for (let m = 0; m < counts[axis]; m++, index += stride) {
          const here = values[index];
          const after = m + 1 < counts[axis] ? values[index + stride] : 0;
          values[index] = 0.25 * before + 0.5 * here + 0.25 * after;
          before = here;
        }
      }
  }
}
