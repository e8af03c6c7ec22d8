// What the shaders share.

export const LOOKUP = /* glsl */ `
vec4 lookup(highp sampler2D numbers, int i) { return texelFetch(numbers, ivec2(i & 2047, i >> 11), 0); }
`;

/** A film's response, as in python/ringlet/picture/tone.py, so that the page and the stills look alike. */
export const DEVELOP = /* glsl */ `
uniform float exposure;
vec3 develop(vec3 light) {
  vec3 x = max(light * exposure, 0.0);
  float luminance = dot(x, vec3(0.2126, 0.7152, 0.0722));
  vec3 film = 0.5 * (x * (1.0 + luminance / 25.0) / (1.0 + luminance) + x * (1.0 + x / 25.0) / (1.0 + x));
  film = clamp(film, 0.0, 1.0);
  vec3 encoded = mix(12.92 * film, 1.055 * pow(film, vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), film));
  return encoded + 0.4 * (encoded * encoded * (3.0 - 2.0 * encoded) - encoded);
}
`;

export const LIGHTS = /* glsl */ `
const int LIGHTS = 4;
uniform vec3 lightFrom[LIGHTS];     // directions towards the lights, the first of which casts shadows
uniform vec3 lightStrength[LIGHTS];
uniform vec3 ambient;
`;

/** How much of the key light gets through the hair (deep opacity maps, Yuksel and Keyser 2008) and past the bodies. */
export const SHADOW = /* glsl */ `
uniform highp sampler2D hairNearest; // depth of the first hair, seen from the light
uniform highp sampler2D hairLayers;  // opacity of four layers behind it
uniform highp sampler2D bodyNearest;
uniform mat4 toLight;
uniform vec4 layers;                 // where the layers end, in depth behind the first hair
uniform float shadowOn;

float seenPast(vec3 place, float bias) {
  vec3 at = (toLight * vec4(place, 1.0)).xyz * 0.5 + 0.5;
  if (shadowOn < 0.5 || any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
  vec2 texel = 1.0 / vec2(textureSize(bodyNearest, 0));
  float lit = 0.0;
  for (int i = 0; i < 4; i++) {
    vec2 aside = (vec2(i & 1, i >> 1) - 0.5) * 2.0 * texel;
    lit += step(at.z - bias, texture(bodyNearest, at.xy + aside).r);
  }
  return 0.25 * lit;
}

float seenThrough(vec3 place) {
  vec3 at = (toLight * vec4(place, 1.0)).xyz * 0.5 + 0.5;
  if (shadowOn < 0.5 || any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
  vec2 texel = 1.0 / vec2(textureSize(hairNearest, 0));
  float opacity = 0.0;
  for (int i = 0; i < 5; i++) {
    vec2 aside = i == 0 ? vec2(0.0) : 1.6 * texel * vec2(i < 3 ? (i == 1 ? 1.0 : -1.0) : 0.0, i < 3 ? 0.0 : (i == 3 ? 1.0 : -1.0));
    float behind = at.z - texture(hairNearest, at.xy + aside).r;
    if (behind <= 0.0) continue;
    vec4 sums = texture(hairLayers, at.xy + aside);
    float before = 0.0, start = 0.0, found = sums.w;
    for (int k = 0; k < 4; k++) {
      if (behind < layers[k]) {
        found = mix(before, sums[k], (behind - start) / (layers[k] - start));
        break;
      }
      before = sums[k];
      start = layers[k];
    }
    opacity += found;
  }
  return exp(-0.2 * opacity);
}
`;

/** Ribbons that face the eye: two vertices a point, an instance a hair. Gives `place`, `along` and `tangent`. */
export const RIBBON = /* glsl */ `
uniform highp sampler2D hairPoints; // position and width, point by point
uniform int points, stride;
uniform float thicken, pixel;       // factor on widths; size of a pixel at unit distance
uniform mat4 viewMatrix, projectionMatrix;
uniform vec3 eye;
uniform float parallel;             // 1 for a light that sees in parallel
uniform vec3 eyeward;

vec4 hairAt(int hair, int k) { return lookup(hairPoints, hair * points + clamp(k, 0, points - 1)); }

void ribbon(out vec3 place, out vec3 tangent, out float along, out float cover) {
  int k = min((gl_VertexID >> 1) * stride, points - 1);
  vec4 here = hairAt(gl_InstanceID, k);
  vec3 edge = hairAt(gl_InstanceID, k + stride).xyz - hairAt(gl_InstanceID, k - stride).xyz;
  tangent = normalize(edge + vec3(0.0, 1e-9, 0.0));
  vec3 toEye = mix(eye - here.xyz, eyeward, parallel);
  float least = pixel * mix(length(toEye), 1.0, parallel);
  float wide = max(here.w * thicken, least);
  cover = min(1.0, here.w * thicken / wide);
  vec3 side = normalize(cross(tangent, toEye) + vec3(1e-9, 0.0, 0.0));
  place = here.xyz + side * wide * (float(gl_VertexID & 1) - 0.5);
  along = float(k) / float(points - 1);
}
`;
