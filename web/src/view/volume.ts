// Light in the mass of the hair, on a grid of voxels: how much of each lamp reaches a place, and the light that hairs,
// skin and surroundings scatter there. Extinction is that of fibers of all directions,
// σ = Σ π/4 · diameter · length per volume.

import { ClampToEdgeWrapping, Data3DTexture, DataUtils, HalfFloatType, LinearFilter, RGBAFormat, Vector3 } from "three";
import { type Beam, cast } from "./beam";
import type { Transport } from "./fiber";
import { type Four, four, type Matter } from "./grid";
import { Scattering } from "./scattering";

export class LightVolume {
  readonly uniforms = {
    gridOrigin: { value: new Vector3() },
    gridSize: { value: new Vector3(1, 1, 1) },
    gridDepth: { value: texture([1, 1, 1]) },
    gridPassed: { value: open() },
    gridField: { value: texture([1, 1, 1]) },
    gridFlux: { value: texture([1, 1, 1]) },
  };
  /** Optical depth towards each of four lamps, and the part of its light that passes skin. */
  private depth: Four | null = null;
  private passed: Four | null = null;
  private scattering: Scattering | null = null;
  private matter: Matter | null = null;

  fill(matter: Matter): void {
    const { grid } = matter;
    if (!this.matter || !same(this.matter.grid.counts, grid.counts)) {
      this.depth = four(grid.voxels);
      this.passed = four(grid.voxels);
      this.scattering = new Scattering(grid);
    }
    this.matter = matter;
    this.scattering?.reset();
  }

  /** Lights the grid in small steps, with the last of which it is seen. */
  *light(beams: Beam[], ambient: Vector3, transport: Transport): Generator<void, void> {
    const { matter, depth, passed, scattering } = this;
    if (!matter || !depth || !passed || !scattering) return;
    for (const [k, beam] of beams.entries()) yield* cast(matter, beam, depth[k], passed[k]);
    yield* scattering.light(matter, beams, depth, passed, ambient, transport);
    const fine = matter.grid.counts;
    const packed: Uint16Array[] = [];
    for (const values of [depth, passed, scattering.mean, scattering.flow]) {
      packed.push(pack(values));
      yield;
    }
    const { gridOrigin, gridSize, gridDepth, gridPassed, gridField, gridFlux } = this.uniforms;
    [gridDepth, gridPassed, gridField, gridFlux].forEach((one, k) => fillTexture(one, k < 2 ? fine : scattering.counts, packed[k]));
    gridOrigin.value.copy(matter.grid.origin);
    gridSize.value.set(...fine).multiplyScalar(matter.grid.size);
  }

  dispose(): void {
    const { gridDepth, gridPassed, gridField, gridFlux } = this.uniforms;
    for (const uniform of [gridDepth, gridPassed, gridField, gridFlux]) uniform.value.dispose();
  }
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
float voxelSize() { return gridSize.x / float(textureSize(gridDepth, 0).x); } // [m]
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
