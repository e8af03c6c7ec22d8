// What the shaders share.

export const LOOKUP = /* glsl */ `
vec4 lookup(highp sampler2D numbers, int i) { return texelFetch(numbers, ivec2(i & 2047, i >> 11), 0); }
`;

/** A film's response, as in python/ringlet/picture/tone.py, so that the page and the stills look alike. */
export const DEVELOP = /* glsl */ `
vec3 develop(vec3 light) {
  vec3 x = max(light, 0.0);
  float luminance = dot(x, vec3(0.2126, 0.7152, 0.0722));
  vec3 film = 0.5 * (x * (1.0 + luminance / 25.0) / (1.0 + luminance) + x * (1.0 + x / 25.0) / (1.0 + x));
  film = clamp(film, 0.0, 1.0);
  vec3 encoded = mix(12.92 * film, 1.055 * pow(film, vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), film));
  return encoded + 0.4 * (encoded * encoded * (3.0 - 2.0 * encoded) - encoded); // restores contrast
}
`;

/**
 * The lamps are disks that face the subject. The shader gives the light that arrives from each, without what is in
 * between. A lamp has the strength E at its reach; d is the distance to its middle, s that to its edge. The light is
 * E reach² / s² on a surface that faces it, and 2 E reach² / s (s + d) of all directions.
 */
export const LIGHTS = /* glsl */ `
const int LAMPS = 4;
uniform vec3 lampAt[LAMPS], lampStrength[LAMPS];
uniform float lampSpread[LAMPS]; // radius over reach
uniform float lampReach[LAMPS];  // distance at which the strength holds for a point [m]
uniform float ambient;           // radiance of the surroundings
void lampFrom(int k, vec3 place, out vec3 towards, out float middle, out float edge) { // in reaches
  towards = lampAt[k] - place;
  middle = length(towards) / lampReach[k];
  edge = sqrt(middle * middle + lampSpread[k] * lampSpread[k]);
  towards = normalize(towards);
}
vec3 irradiance(int k, vec3 place, out vec3 towards) {
  float middle, edge;
  lampFrom(k, place, towards, middle, edge);
  return lampStrength[k] / (edge * edge);
}
vec3 fluence(int k, vec3 place, out vec3 towards) {
  float middle, edge;
  lampFrom(k, place, towards, middle, edge);
  return lampStrength[k] * 2.0 / (edge * (edge + middle));
}
`;

/** The color of hairs: `toneOf`, the fourth root of the reflectance of dense hair at a fraction of a hair. */
export const TONE = /* glsl */ `
uniform sampler2D hairColor;  // of each hair at its stations
uniform int stations;         // along a hair; 0: all hairs have one colour
uniform vec3 tone;            // of all hairs
vec3 toneOf(int hair, float along) {
  if (stations == 0) return tone;
  float station = along * float(stations - 1);
  int first = hair * stations + int(station), last = hair * stations + stations - 1;
  return mix(lookup(hairColor, first).rgb, lookup(hairColor, min(first + 1, last)).rgb, fract(station));
}
`;

/** The tubes of locks, by the points of their hairs. */
export const TUBES = /* glsl */ `
uniform sampler2D hairTubes; // place by the radius, and the optical depth of that
vec4 tubeOf(int point) {
  vec4 of = lookup(hairTubes, point);
  return vec4(2.0 * of.xyz - 1.0, of.w / max(1.0 - of.w, 0.004));
}

// The clumping index of hairs: light meets a lock as a tube, and hairs behind others take little away (Nilson 1971).
// depth: of the radius, which is 2/π of that of the mean way through
float clumping(float depth) {
  float mean = 1.5707963 * depth;
  return mean > 1e-3 ? (1.0 - exp(-mean)) / mean : 1.0;
}
`;

/** The points of hairs, of which each `stride`th is drawn. */
export const POINTS = /* glsl */ `
uniform highp sampler2D hairPoints; // position and width, point by point
uniform int points, stride;
uniform mat4 viewMatrix, projectionMatrix;
vec4 hairAt(int hair, int k) { return lookup(hairPoints, hair * points + clamp(k, 0, points - 1)); }
vec3 tangentAt(int hair, int k) {
  return normalize(hairAt(hair, k + stride).xyz - hairAt(hair, k - stride).xyz + vec3(0.0, 1e-9, 0.0));
}
`;

/** Ribbons that face the eye: two vertices a point, an instance a hair. Gives `place`, `tangent` and `along`. */
export const RIBBON = /* glsl */ `
${POINTS}
uniform int hairs, firstHair;       // of all; the first one of this drawing
uniform float thicken;              // factor on widths, for the hairs that are left out
uniform vec3 eye;

int hairNumber() { return (gl_InstanceID + firstHair) % hairs; }
int pointNumber() { return min((gl_VertexID >> 1) * stride, points - 1); }

void ribbon(out vec3 place, out vec3 tangent, out float along) {
  int hair = hairNumber(), k = pointNumber();
  vec4 here = hairAt(hair, k);
  tangent = tangentAt(hair, k);
  vec3 side = normalize(cross(tangent, eye - here.xyz) + vec3(1e-9, 0.0, 0.0));
  place = here.xyz + side * here.w * thicken * (float(gl_VertexID & 1) - 0.5);
  along = float(k) / float(points - 1);
}
`;
