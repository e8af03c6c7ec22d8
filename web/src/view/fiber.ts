// The scattering of a hair fiber, tabulated and averaged over the width of the fiber. It is the model of the path tracer,
// "hair" of Mitsuba (Chiang et al., "A practical and controllable hair and fur model", 2016).
//
// S(θi, θo, φ) = Σ over R, TT, TRT and the rest of M_p(θi, θo) N_p(φ). The table holds N_p with its attenuation; the
// shader evaluates M_p. A colour enters as q = C^¼, the fourth root of the reflectance of dense hair.

import {
  ClampToEdgeWrapping,
  Data3DTexture,
  DataTexture,
  DataUtils,
  HalfFloatType,
  LinearFilter,
  RGBAFormat,
} from "three";

const ETA = 1.55;
const PHI = 32; // stations of the azimuth from 0 to π
const TONE = 16; // of q from 0 to 1
const THETA = 8; // of cos θo from 0 to 1
const ACROSS = 48; // offsets h across the fiber, of the integrals
const BRIGHTEST = 0.999; // q of the lightest fiber: at 1 it absorbs nothing

/** Roughness of a fiber: along it and around it, from 0 to 1. */
export interface Roughness {
  along: number;
  around: number;
}

/** Transport in a volume of fibers by q: of one scattering the albedo, the mean cosine, and the variance along a fiber without the peak. */
export interface Transport {
  albedo: Float32Array;
  forward: Float32Array;
  variance: Float32Array;
}

/** Variances of the lobes R, TT, and TRT with the rest. */
export function variances(along: number): [number, number, number] {
  const v = (0.726 * along + 0.812 * along ** 2 + 3.7 * along ** 20) ** 2;
  return [v, 0.25 * v, 4 * v];
}

/** Absorption per radius of a fiber at q: C = exp(-D(β) √σ). */
export function absorption(q: number, around: number): number {
  const b = around;
  const falloff = 5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245))));
  return ((4 * Math.log(Math.min(Math.max(q, 0.02), BRIGHTEST))) / falloff) ** 2;
}

/** N_p(φ) of a fiber, four lobes a texel: φ by q by cos θo. */
export class FiberTable {
  readonly texture: Data3DTexture;
  readonly transport: Transport;
  /** The transport as a texture. */
  readonly means: DataTexture;

  /** spread: variance of the direction to a light, which softens the lobes as its size does [rad²] */
  constructor({ along, around }: Roughness, spread: number) {
    const lobes = new Float32Array(4 * PHI * TONE * THETA);
    const logistic = 0.626657 * (0.265 * around + 1.194 * around ** 2 + 5.372 * around ** 22);
    const scale = Math.sqrt(logistic ** 2 + (3 * spread) / Math.PI ** 2); // a logistic of scale s has variance s²π²/3
    for (let c = 0; c < THETA; c++) {
      const cosine = Math.max((c + 0.5) / THETA, 0.02);
      for (let t = 0; t < TONE; t++)
        azimuthal(lobes, PHI * (t + TONE * c), absorption(t / (TONE - 1), around), cosine, scale);
    }
    this.transport = transport(lobes, along);
    const half = new Uint16Array(lobes.length);
    for (let i = 0; i < lobes.length; i++) half[i] = DataUtils.toHalfFloat(lobes[i]);
    this.texture = new Data3DTexture(half, PHI, TONE, THETA);
    Object.assign(this.texture, {
      type: HalfFloatType,
      format: RGBAFormat,
      minFilter: LinearFilter,
      magFilter: LinearFilter,
      wrapS: ClampToEdgeWrapping,
      wrapT: ClampToEdgeWrapping,
      wrapR: ClampToEdgeWrapping,
    });
    this.texture.needsUpdate = true;
    this.means = means(this.transport);
  }

  dispose(): void {
    this.texture.dispose();
    this.means.dispose();
  }
}

function means({ albedo, forward, variance }: Transport): DataTexture {
  const half = new Uint16Array(4 * TONE);
  for (let t = 0; t < TONE; t++)
    half.set([albedo[t], forward[t], variance[t], 0].map((x) => DataUtils.toHalfFloat(x)), 4 * t);
  const made = new DataTexture(half, TONE, 1, RGBAFormat, HalfFloatType);
  made.minFilter = made.magFilter = LinearFilter;
  made.needsUpdate = true;
  return made;
}

/** A row of the table: N_p with its attenuation, averaged over the offset h of the ray. */
function azimuthal(lobes: Float32Array, row: number, sigma: number, cosine: number, scale: number): void {
  const sine2 = 1 - cosine * cosine;
  const etaAcross = Math.sqrt(ETA * ETA - sine2) / cosine; // Bravais
  const inside = Math.sqrt(1 - sine2 / (ETA * ETA));
  const trim = 1 - 2 / (1 + Math.exp(Math.PI / scale));
  for (let j = 0; j < ACROSS; j++) {
    const h = -1 + (2 * (j + 0.5)) / ACROSS;
    const out = Math.asin(h);
    const refracted = Math.asin(h / etaAcross);
    const f = fresnel(cosine * Math.sqrt(1 - h * h));
    const through = Math.exp((-sigma * 2 * Math.cos(refracted)) / inside);
    const attenuation = [f, (1 - f) ** 2 * through, 0, 0];
    attenuation[2] = attenuation[1] * through * f;
    attenuation[3] = (attenuation[2] * f * through) / Math.max(1 - through * f, 1e-6);
    for (let i = 0; i < PHI; i++) {
      const phi = (Math.PI * i) / (PHI - 1);
      for (let p = 0; p < 3; p++) {
        let away = phi - (2 * p * refracted - 2 * out + p * Math.PI);
        away -= 2 * Math.PI * Math.round(away / (2 * Math.PI));
        const e = Math.exp(-Math.abs(away) / scale);
        lobes[4 * (row + i) + p] += (attenuation[p] * e) / (scale * (1 + e) ** 2 * trim) / ACROSS;
      }
      lobes[4 * (row + i) + 3] += attenuation[3] / (2 * Math.PI) / ACROSS;
    }
  }
}

/** Reflectance of a dielectric without polarization. */
function fresnel(cosine: number): number {
  const t = Math.sqrt(1 - (1 - cosine * cosine) / (ETA * ETA));
  const parallel = (ETA * cosine - t) / (ETA * cosine + t);
  const across = (cosine - ETA * t) / (cosine + ETA * t);
  return 0.5 * (parallel * parallel + across * across);
}

/** Means over fibers of all directions, which light meets in proportion to their projected area: weights cos²θ. */
function transport(lobes: Float32Array, along: number): Transport {
  const albedo = new Float32Array(TONE);
  const forward = new Float32Array(TONE);
  const variance = new Float32Array(TONE);
  const v = variances(along);
  const shrink = [v[0], v[1], v[2], v[2]].map((one) => Math.exp(-0.5 * one));
  for (let t = 0; t < TONE; t++) {
    let [weights, scattered, deflected, spread] = [0, 0, 0, 0];
    for (let c = 0; c < THETA; c++) {
      const cosine = (c + 0.5) / THETA; // uniform in cos θ: dθ = dc / sin θ
      const weight = cosine ** 2 / Math.sqrt(1 - cosine * cosine);
      weights += weight;
      for (let i = 0; i < PHI; i++) {
        const phi = (Math.PI * i) / (PHI - 1);
        const step = (2 * Math.PI) / (PHI - 1) / (i === 0 || i === PHI - 1 ? 2 : 1);
        for (let p = 0; p < 4; p++) {
          const part = weight * step * lobes[4 * (i + PHI * (t + TONE * c)) + p];
          scattered += part;
          spread += part * v[Math.min(p, 2)];
          deflected += part * shrink[p] * (1 - cosine * cosine - cosine * cosine * Math.cos(phi));
        }
      }
    }
    albedo[t] = Math.min(scattered / weights, BRIGHTEST);
    forward[t] = Math.max(deflected / Math.max(scattered, 1e-9), 0);
    const peak = forward[t] ** 2; // a part of TT, which the beam keeps
    variance[t] = Math.max(spread / Math.max(scattered, 1e-9) - peak * v[1], 0) / (1 - peak);
  }
  return { albedo, forward, variance };
}

/** A function of q, tabulated at even steps, by linear interpolation. */
export function at(values: Float32Array, q: number): number {
  const x = Math.min(Math.max(q, 0), 1) * (values.length - 1);
  const i = Math.min(Math.floor(x), values.length - 2);
  return values[i] + (x - i) * (values[i + 1] - values[i]);
}

/** Evaluates the table. The weights of the lobes M_p are normalized over cos θ dθ. */
export const FIBER = /* glsl */ `
uniform highp sampler3D fiberTable; // N_p of R, TT, TRT and the rest: azimuth by C^¼ by cos θ of the eye
uniform vec3 variance;              // of M_p: R, TT, and TRT with the rest
uniform float tilt;                 // of the cuticle [radians]
uniform sampler2D fiberTransport;   // albedo, mean cosine and variance of a scattering, by C^¼

void transportOf(vec3 q, out vec3 albedo, out vec3 cosine, out float spread) {
  vec3 at = (q * ${TONE - 1}.0 + 0.5) / ${TONE}.0;
  vec3 r = texture(fiberTransport, vec2(at.r, 0.5)).rgb, g = texture(fiberTransport, vec2(at.g, 0.5)).rgb;
  vec3 b = texture(fiberTransport, vec2(at.b, 0.5)).rgb;
  albedo = vec3(r.x, g.x, b.x);
  cosine = vec3(r.y, g.y, b.y);
  spread = g.z;
}

float besselLog(float x) { // ln(I0(x) exp(-x)), after Olivares et al. 2018
  float x2 = x * x;
  return log((1.0 + exp(-2.0 * x)) * 0.5 * (1.0 + 0.24273 * x2) / (1.0 + 0.43023 * x2)) - 0.25 * log(1.0 + 0.25 * x2);
}

// M_p of d'Eon et al. 2011: sines and cosines of the angles of light and eye.
float longitudinal(float v, float sinL, float cosL, float sinV, float cosV) {
  float a = cosL * cosV / v, b = sinL * sinV / v;
  return exp(besselLog(a) + a - b - 1.0 / v) / (v * (1.0 - exp(-2.0 / v)));
}

// M of a variance, of light from L.
float cone(float v, vec3 T, vec3 V, vec3 L) {
  float sinL = clamp(dot(T, L), -0.9999, 0.9999), sinV = clamp(dot(T, V), -0.9999, 0.9999);
  return longitudinal(v, sinL, sqrt(1.0 - sinL * sinL), sinV, sqrt(1.0 - sinV * sinV));
}

// Radiance that a fiber sends to the eye, of light with an irradiance of 1. q: C^¼; size: variance of its directions
vec3 fiber(vec3 T, vec3 V, vec3 L, vec3 q, float size) {
  float sinL = clamp(dot(T, L), -0.9999, 0.9999), sinV = clamp(dot(T, V), -0.9999, 0.9999);
  float cosL = sqrt(1.0 - sinL * sinL), cosV = sqrt(1.0 - sinV * sinV);
  float phi = acos(clamp((dot(L, V) - sinL * sinV) / (cosL * cosV), -1.0, 1.0)) * 0.3183099;
  float azimuth = (phi * ${PHI - 1}.0 + 0.5) / ${PHI}.0;
  vec3 at = (q * ${TONE - 1}.0 + 0.5) / ${TONE}.0;
  vec4 red = texture(fiberTable, vec3(azimuth, at.r, cosV));
  vec4 green = texture(fiberTable, vec3(azimuth, at.g, cosV));
  vec4 blue = texture(fiberTable, vec3(azimuth, at.b, cosV));
  vec3 v = variance + size;
  vec3 a = tilt * vec3(2.0, -1.0, -4.0); // of the eye's angle, for R, TT and TRT
  vec3 s = sinV * cos(a) - cosV * sin(a), c = abs(cosV * cos(a) + sinV * sin(a));
  float R = longitudinal(v.x, sinL, cosL, s.x, c.x);
  float TT = longitudinal(v.y, sinL, cosL, s.y, c.y);
  float TRT = longitudinal(v.z, sinL, cosL, s.z, c.z);
  float rest = longitudinal(v.z, sinL, cosL, sinV, cosV);
  vec4 M = vec4(R, TT, TRT, rest);
  return vec3(dot(M, red), dot(M, green), dot(M, blue));
}
`;
