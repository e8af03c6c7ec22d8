// How a hair catches light: dual highlights, transmission and what hairs scatter to each other.
//
// S = Σ over R, TT, TRT of  M(θ) N(φ) A, with the longitudinal lobes M as Gaussians of sin θi + sin θr shifted by the
// cuticle's tilt (Marschner et al. 2003) and the azimuthal lobes N and attenuations A fitted with few terms (Karis 2016).
// C is the colour of hair after many scatterings (Chiang et al. 2016), which ringlet.data.pigment computes from pigments.

import { DEVELOP, LIGHTS, LOOKUP, RIBBON, SHADOW } from "./shaders";

const HEAD = /* glsl */ `
precision highp float;
precision highp int;
precision highp sampler2D;
`;

export const HAIR_VERTEX = /* glsl */ `${HEAD}
${LOOKUP}
${RIBBON}
uniform sampler2D hairPlace, lockPlace, lockPoint;
uniform sampler2D hairColor;  // of each hair at its stations: the fourth root of its reflectance
uniform int stations;         // along a hair; 0: all hairs have one colour
uniform vec3 reflectance;     // of all hairs
out vec3 place, direction, tone;
out float along, covered, chance, mark, overlay;
invariant gl_Position;

void main() {
  ribbon(place, direction, along, covered);
  vec4 sits = lookup(hairPlace, gl_InstanceID), lock = lookup(lockPlace, int(sits.x));
  mark = lock.z;
  float at = along * lock.y * sits.y;
  int row = int(lock.x) + int(at);
  overlay = mix(lookup(lockPoint, row).w, lookup(lockPoint, row + 1).w, fract(at));
  chance = fract(sin(float(gl_InstanceID) * 12.9898 + 4.1) * 43758.5453);
  tone = pow(reflectance, vec3(sqrt(0.8 + 0.4 * chance)));
  if (stations > 0) {
    float station = along * float(stations - 1);
    int first = gl_InstanceID * stations + int(station), last = gl_InstanceID * stations + stations - 1;
    vec3 root = mix(lookup(hairColor, first).rgb, lookup(hairColor, min(first + 1, last)).rgb, fract(station));
    tone = root * root * root * root;
  }
  gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}
`;

export const HAIR_FRAGMENT = /* glsl */ `${HEAD}
${LIGHTS}
${SHADOW}
${DEVELOP}
uniform float roughness, tilt; // of the fibre; tilt of its cuticle [radians]
uniform vec3 eye, middle;  // the camera; the middle of the hair
uniform vec3 highlight;
uniform float showOverlay;
in vec3 place, direction, tone;
in float along, covered, chance, mark, overlay;
out vec4 color;

float gauss(float width, float x) { return exp(-0.5 * x * x / (width * width)) / (2.5066 * width); }
float fresnel(float c) { float f = 1.0 - clamp(c, 0.0, 1.0); return 0.0465 + 0.9535 * f * f * f * f * f; }

vec3 fibre(vec3 T, vec3 V, vec3 L, vec3 C, float through) {
  float sinL = clamp(dot(T, L), -1.0, 1.0), sinV = clamp(dot(T, V), -1.0, 1.0);
  float cosD = cos(0.5 * abs(asin(sinV) - asin(sinL)));
  vec3 flatL = L - sinL * T, flatV = V - sinV * T;
  float cosPhi = dot(flatL, flatV) * inversesqrt(dot(flatL, flatL) * dot(flatV, flatV) + 1e-4);
  float cosHalf = sqrt(clamp(0.5 + 0.5 * cosPhi, 0.0, 1.0));
  float shift = tilt + 0.02 * (chance - 0.5), width = roughness * roughness + 0.02, sum = sinL + sinV;

  vec3 S = vec3(0.14 * cosHalf * gauss(width, sum + 2.0 * shift) * fresnel(sqrt(clamp(0.5 + 0.5 * dot(V, L), 0.0, 1.0))));

  float a = 1.0 / (1.19 / cosD + 0.36 * cosD);
  float h = cosHalf * (1.0 + a * (0.6 - 0.8 * cosPhi));
  float f = fresnel(cosD * sqrt(clamp(1.0 - h * h, 0.0, 1.0)));
  vec3 once = pow(C, vec3(0.5 * sqrt(max(1.0 - h * h * a * a, 0.0)) / cosD));
  S += gauss(0.5 * width, sum - shift) * exp(-3.65 * cosPhi - 3.98) * (1.0 - f) * (1.0 - f) * once * through;

  f = fresnel(0.5 * cosD);
  S += gauss(2.0 * width, sum - 4.0 * shift) * exp(17.0 * cosPhi - 16.78) * (1.0 - f) * (1.0 - f) * f * pow(C, vec3(0.8 / cosD));

  // What has been scattered by many hairs before.
  vec3 N = normalize(V - T * sinV);
  float luminance = max(dot(C, vec3(0.3, 0.6, 0.1)), 1e-4);
  vec3 tint = pow(C / luminance, vec3(1.0 - through));
  S += sqrt(C) * tint * 0.318 * clamp((dot(N, L) + 1.0) * 0.25, 0.0, 1.0);
  return S;
}

vec3 heat(float x) { // from pale over orange to dark red
  return x < 0.5 ? mix(vec3(0.72, 0.70, 0.62), vec3(0.86, 0.36, 0.06), 2.0 * x) : mix(vec3(0.86, 0.36, 0.06), vec3(0.42, 0.01, 0.03), 2.0 * x - 1.0);
}

vec3 ramp(float x) { // from blue over pale to red
  return x < 0.5 ? mix(vec3(0.10, 0.28, 0.62), vec3(0.72, 0.70, 0.62), 2.0 * x) : mix(vec3(0.72, 0.70, 0.62), vec3(0.80, 0.10, 0.06), 2.0 * x - 1.0);
}

void main() {
  vec3 T = normalize(direction), V = normalize(eye - place);
  vec3 C = max(tone, vec3(1e-6));
  vec3 outward = normalize(place - middle + vec3(0.0, 1e-5, 0.0));
  float open = mix(0.2, 1.0, smoothstep(0.0, 0.75, along)); // roots lie in the shade of what is above them
  vec3 light = sqrt(C) * ambient * open * (0.6 + 0.4 * outward.y) * 0.32;
  for (int k = 0; k < LIGHTS; k++) {
    float through = k == 0 ? seenThrough(place) * mix(0.25, 1.0, seenPast(place, 0.004))
                           : smoothstep(-0.35, 0.7, dot(outward, lightFrom[k])) * open;
    light += lightStrength[k] * through * fibre(T, V, lightFrom[k], C, through);
  }
  if (showOverlay > 0.5) {
    vec3 tint = showOverlay > 1.5 ? heat(clamp(overlay, 0.0, 1.0)) : ramp(clamp(overlay, 0.0, 1.0));
    light = tint * (0.3 + 0.7 * open) * (0.35 + 0.65 * clamp(dot(normalize(V - T * dot(T, V)), lightFrom[0]) * 0.5 + 0.5, 0.0, 1.0));
  }
  if (mark > 0.5) light = mix(light, highlight * (0.25 + 0.75 * open) + light, mark > 1.5 ? 0.85 : 0.45);
  color = vec4(develop(light), 1.0);
}
`;

/** Depth of the first hair: seen from the light, or from the eye, so that only hairs that are seen are shaded. */
export const DEPTH_VERTEX = /* glsl */ `${HEAD}
${LOOKUP}
${RIBBON}
out float covered;
invariant gl_Position;
void main() {
  vec3 place, tangent;
  float along;
  ribbon(place, tangent, along, covered);
  gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}
`;
export const DEPTH_FRAGMENT = /* glsl */ `${HEAD}
out vec4 color;
void main() { color = vec4(1.0); }
`;

/** How much hair there is up to the end of each layer. */
export const LAYERS_FRAGMENT = /* glsl */ `${HEAD}
uniform sampler2D hairNearest;
uniform vec4 layers;
uniform float density;
in float covered;
out vec4 color;
void main() {
  float behind = gl_FragCoord.z - texelFetch(hairNearest, ivec2(gl_FragCoord.xy), 0).r;
  color = covered * density * step(vec4(behind), layers);
}
`;
