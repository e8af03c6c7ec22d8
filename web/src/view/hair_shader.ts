// How a hair catches light: the fiber of the path tracer under the lamps, and what hairs scatter to each other.

import { FIBER } from "./fiber";
import { LIGHTS, LOOKUP, POINTS, RIBBON, TONE, TUBES } from "./shaders";
import { VOLUME } from "./volume";

const HEAD = /* glsl */ `
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;
`;

/** What is read of a hair at a fraction of it: colour, and what is marked or laid over it. */
const TRAITS = /* glsl */ `
${TONE}
uniform sampler2D hairPlace, lockPlace, lockPoint;
void traits(int hair, float along, out vec3 q, out float mark, out float overlay) {
  vec4 sits = lookup(hairPlace, hair), lock = lookup(lockPlace, int(sits.x));
  mark = lock.z;
  float at = along * lock.y * sits.y;
  int row = int(lock.x) + int(at);
  overlay = mix(lookup(lockPoint, row).w, lookup(lockPoint, row + 1).w, fract(at));
  q = toneOf(hair, along);
}

// Width of the shadow that the lock throws [m]. depth: of the radius of its tube
uniform highp sampler2D lockTube;
float shadowOf(int hair, float depth) {
  return lookup(lockTube, int(lookup(hairPlace, hair).x)).x * clumping(depth);
}
`;

/** The way of light through a lock, as a tube of hairs that are nearly straight. */
const WITHIN = /* glsl */ `
// Optical depth of the way to the surface of the tube. A ray has the depth of its way across, however slanted it is.
// place: across the tube, by its radius; towards: direction of the ray across it
float depthWithin(float depth, vec3 place, vec3 towards) {
  float b = dot(place, towards);
  return depth * (sqrt(max(b * b + 1.0 - dot(place, place), 0.0)) - b);
}

// Optical depth of the hair around the lock towards a lamp, of a hair that is seen. The way to the eye is free, and so are
// ways next to it, by exp(-distance / length) with the length π/2 · shadow of strips of all directions (the hot spot of
// Kuusk 1985). The voxels have the lock itself too: half of a line whose middle, spread by voxels and filter, is 0.46 of it
// over a voxel. sine: of the angle between light and lock
float depthAround(int k, vec3 place, vec3 towards, vec3 V, float shadow, float sine) {
  float free = 1.5707963 * shadow / max(length(towards - V), 0.1);
  float own = 0.5 * 0.46 * 0.7853982 * shadow / (voxelSize() * sine);
  return max(opticalDepth(place + free * towards)[k] - own, 0.0);
}

// The part of even light that reaches a place from outside of the tube: by ways at 45° to that from its axis.
vec3 opened(vec3 depth, vec3 place) {
  float square = 0.5 * min(dot(place, place), 1.0), near = sqrt(1.0 - square), far = sqrt(square);
  return 0.5 * (exp(-depth * (near - far)) + exp(-depth * (near + far)));
}
`;

export const HAIR_VERTEX = /* glsl */ `${HEAD}
${LOOKUP}
${TUBES}
${RIBBON}
${TRAITS}
out vec3 place, direction, q;
out vec4 tube;
out float shadow;
out float mark, overlay;
invariant gl_Position;

void main() {
  float along;
  ribbon(place, direction, along);
  traits(hairNumber(), along, q, mark, overlay);
  tube = tubeOf(hairNumber() * points + pointNumber());
  shadow = shadowOf(hairNumber(), tube.w);
  gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}
`;

const SHADE = /* glsl */ `${HEAD}
${LIGHTS}
${FIBER}
${VOLUME}
${LOOKUP}
${TUBES}
${WITHIN}
uniform vec3 eye;
uniform vec3 highlight;
uniform float showOverlay;

vec3 heat(float x) { // from pale over orange to dark red
  return x < 0.5 ? mix(vec3(0.72, 0.70, 0.62), vec3(0.86, 0.36, 0.06), 2.0 * x) : mix(vec3(0.86, 0.36, 0.06), vec3(0.42, 0.01, 0.03), 2.0 * x - 1.0);
}

vec3 ramp(float x) { // from blue over pale to red
  return x < 0.5 ? mix(vec3(0.10, 0.28, 0.62), vec3(0.72, 0.70, 0.62), 2.0 * x) : mix(vec3(0.72, 0.70, 0.62), vec3(0.80, 0.10, 0.06), 2.0 * x - 1.0);
}

// Light that a place on a hair sends to the eye. q: C^¼
vec3 shade(vec3 place, vec3 direction, vec4 tube, float shadow, vec3 q, float mark, float overlay) {
  vec3 T = normalize(direction), V = normalize(eye - place);
  vec3 omega, cosine;
  float spread, disorder;
  transportOf(q, omega, cosine, spread);
  vec3 passing = 1.0 - omega * cosine * cosine;
  vec4 past = pastBodies(place);
  vec3 light = vec3(0.0), field = scattered(place, V, 3.0 * cosine, disorder), beamed = vec3(0.0);
  vec3 within = tube.xyz - dot(tube.xyz, T) * T;
  float shares[LAMPS], even = ambient;
  vec3 from[LAMPS];
  for (int k = 0; k < LAMPS; k++) {
    vec3 E = fluence(k, place, from[k]);
    vec3 across = from[k] - dot(from[k], T) * T;
    float sine = max(length(across), 0.05);
    float depth = depthAround(k, place, from[k], V, shadow, sine) + depthWithin(tube.w, within, across / sine);
    vec3 arriving = E * past[k] * exp(-depth * passing);
    beamed += arriving * 0.0795775; // 1 / 4π
    shares[k] = arriving.g * 0.0795775;
    if (arriving.g > 1e-3) light += arriving * fiber(T, V, from[k], q, 0.25 * lampSpread[k] * lampSpread[k]);
  }
  // The field comes from outside of the tube where that is open, and from hairs of the tube that are lit alike elsewhere.
  vec3 open = opened(tube.w * passing, within), among = (1.0 - open) * omega * (1.0 - cosine * cosine) / passing;
  field = (open * field + among * beamed) / (1.0 - among);
  // Hairs that lie alike scatter light to a cone about them, wider by each scattering and by how they differ. Orders of
  // scattering fall by the ratio of the field to the field with the beams, so that their mean is 2 + field / beams at
  // the eye. Light of all directions has a density of 1/2.
  float orders = 2.0 + field.g / (beamed.g + 1e-6), cones = ambient;
  for (int k = 0; k < LAMPS; k++) {
    if (shares[k] < 1e-4) continue;
    even += shares[k];
    float wide = orders * spread + 0.25 * lampSpread[k] * lampSpread[k] + disorder;
    cones += shares[k] * 2.0 * cone(min(wide, 4.0), T, V, from[k]);
  }
  light += omega * field * cones / max(even, 1e-6);
  if (showOverlay > 0.5) {
    vec3 tint = showOverlay > 1.5 ? heat(clamp(overlay, 0.0, 1.0)) : ramp(clamp(overlay, 0.0, 1.0));
    vec3 L = normalize(lampAt[0] - place);
    float lit = 0.35 + 0.65 * clamp(dot(normalize(V - T * dot(T, V)), L) * 0.5 + 0.5, 0.0, 1.0);
    light = tint * lit * mix(0.3, 1.0, exp(-opticalDepth(place)[0]));
  }
  if (mark > 0.5) light = mix(light, highlight * mix(0.25, 1.0, exp(-opticalDepth(place)[0])) + light, mark > 1.5 ? 0.85 : 0.45);
  return light;
}
`;

export const HAIR_FRAGMENT = /* glsl */ `${SHADE}
in vec3 place, direction, q;
in vec4 tube;
in float shadow;
in float mark, overlay;
out vec4 color;
void main() { color = vec4(shade(place, direction, tube, shadow, q, mark, overlay), 1.0); }
`;

/** Deferred shading. First each pixel gets the number of the point where the part of the hair ends that is seen there. */
export const SEEN_VERTEX = /* glsl */ `${HEAD}
${LOOKUP}
${RIBBON}
flat out uint seenPoint;
void main() {
  vec3 place, tangent;
  float along;
  ribbon(place, tangent, along);
  seenPoint = uint(hairNumber() * points + pointNumber()) + 1u;
  gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}
`;
export const SEEN_FRAGMENT = /* glsl */ `${HEAD}
flat in uint seenPoint;
out uint color;
void main() { color = seenPoint; }
`;

/** Then pixels are shaded, at the place between two points that is nearest on the screen. */
export const DEFERRED_VERTEX = /* glsl */ `
in vec3 position;
out vec2 screen;
void main() {
  screen = position.xy;
  gl_Position = vec4(position.xy, 0.0, 1.0);
}
`;
export const DEFERRED_FRAGMENT = /* glsl */ `${SHADE}
${POINTS}
${TRAITS}
uniform highp usampler2D seen;
in vec2 screen;
out vec4 color;
vec2 onScreen(vec3 place) {
  vec4 at = projectionMatrix * viewMatrix * vec4(place, 1.0);
  return at.xy / at.w;
}
void main() {
  uint found = texelFetch(seen, ivec2(gl_FragCoord.xy), 0).r;
  for (uint once = min(found, 1u); once > 0u; once--) { // SwiftShader skips the body of a loop, but not that of an if
    int hair = int(found - 1u) / points, last = int(found - 1u) - hair * points, first = (last - 1) / stride * stride;
    vec3 from = hairAt(hair, first).xyz, to = hairAt(hair, last).xyz;
    vec2 square = vec2(projectionMatrix[1][1] / projectionMatrix[0][0], 1.0), begin = onScreen(from);
    vec2 way = square * (onScreen(to) - begin);
    float t = clamp(dot(square * (screen - begin), way) / max(dot(way, way), 1e-12), 0.0, 1.0);
    vec3 q;
    float mark, overlay;
    traits(hair, mix(float(first), float(last), t) / float(points - 1), q, mark, overlay);
    vec3 direction = mix(tangentAt(hair, first), tangentAt(hair, last), t);
    vec4 tube = mix(tubeOf(hair * points + first), tubeOf(hair * points + last), t);
    color = vec4(shade(mix(from, to, t), direction, tube, shadowOf(hair, tube.w), q, mark, overlay), 1.0);
  }
  if (found == 0u) discard;
}
`;

/** Depth alone, so that only hairs that are seen are shaded. */
export const DEPTH_VERTEX = /* glsl */ `${HEAD}
${LOOKUP}
${RIBBON}
invariant gl_Position;
void main() {
  vec3 place, tangent;
  float along;
  ribbon(place, tangent, along);
  gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}
`;
export const DEPTH_FRAGMENT = /* glsl */ `${HEAD}
out vec4 color;
void main() { color = vec4(1.0); }
`;
