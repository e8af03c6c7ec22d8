// Puts every hair in its place around its lock, on the graphics card. The formula is that of src/ringlet/groom/hairs.h.

import {
  FloatType,
  GLSL3,
  Mesh,
  NearestFilter,
  OrthographicCamera,
  PlaneGeometry,
  RawShaderMaterial,
  RGBAFormat,
  Scene,
  UnsignedByteType,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import type { Hairs } from "../protocol";
import { Tubes } from "./tubes";
import { MOST_VERTICES } from "./rods";
import { LOOKUP } from "./shaders";
import type { Slices, Work } from "./slices";
import { type LockTable, squaredRadii } from "./table";
import { Numbers, Shares, WIDTH } from "./textures";

const VERTEX = /* glsl */ `
in vec3 position;
void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }
`;

const FRAGMENT = /* glsl */ `
precision highp float;
precision highp int;
#define MOST_VERTICES ${MOST_VERTICES}
${LOOKUP}
uniform highp sampler2D lockPoint, lockA, lockB, lockPlace;
uniform highp sampler2D hairPlace;  // lock, tip, offset
uniform highp sampler2D hairRoot;   // root, width; join, flat, groom: two texels a hair
uniform highp sampler2D hairFrizz;  // two knots a texel
uniform highp sampler2D hairMix;    // taper, another lock, the share that it has, relaxation
uniform highp sampler2D lockU, lockV; // frame of the centre line, and the lock's place in it
uniform highp sampler2D hairTurn;   // slip and phase of two knots a texel
uniform highp sampler2D hairCoil;   // radius times direction, turns, kink
uniform highp sampler2D hairAway;   // family, escape
uniform highp sampler2D curlRamps;  // escaping, relaxing, tight, opening
uniform bool curled;
uniform highp sampler2D ramps;      // profile, hold, thinning, blend; pace: two texels a point of each groom
uniform highp sampler2D left;       // the part of its way from the lock that each point keeps, as many texels as the result
uniform int hairs, points, knots;
uniform bool live;                    // whether rods carry the hair
uniform highp sampler2D rodMotion;    // motions of their vertices: three texels each
uniform float along[MOST_VERTICES];   // places of the vertices of a rod on a lock
uniform int vertices;
uniform highp sampler2D lockEase;     // how far points of locks are seen from rest after a change
uniform float easing;                 // the share of it that is left
uniform highp sampler2D lockTube;     // of each lock: widths of hairs; mean squares of offsets, of what the profile leaves, and of roots
layout(location = 0) out vec4 result;
layout(location = 1) out vec4 tube;

vec2 knot(highp sampler2D values, int hair, int i) {
  vec4 two = lookup(values, hair * ((knots + 1) / 2) + i / 2);
  return (i & 1) == 0 ? two.xy : two.zw;
}

// Of a phase in turns, as in the core.
float cosine(float turns) {
  float shifted = turns + 0.25, t = shifted - floor(shifted + 0.5);
  float parabola = 8.0 * t * (1.0 - 2.0 * abs(t));
  return parabola + 0.225 * (parabola * abs(parabola) - parabola);
}
float zigzag(float turns) { return 1.0 - 4.0 * abs(turns - floor(turns + 0.5)); }

// Moves the lock in the frame of its centre line: turned by the slip and relaxed, and by the escape.
vec3 curl(int row, float t, vec4 turned) {
  vec4 u = mix(lookup(lockU, row), lookup(lockU, row + 1), t), v = mix(lookup(lockV, row), lookup(lockV, row + 1), t);
  return (turned.z + turned.x * u.w - turned.y * v.w) * u.xyz + (turned.w + turned.y * u.w + turned.x * v.w) * v.xyz;
}

vec3 eased(int row, float t) {
  return easing > 0.0 ? easing * mix(lookup(lockEase, row).xyz, lookup(lockEase, row + 1).xyz, t) : vec3(0.0);
}

// A place on a lock at so many points from its root, and how far from there a hair is. Catmull–Rom for the points, straight
// for the frame.
vec3 onLock(vec4 lock, float at, vec2 across, vec4 turned, out vec3 away) {
  int last = int(lock.y), j = min(int(at), last), row = int(lock.x) + j;
  float t = j == last ? 0.0 : at - float(j);
  vec3 p0 = lookup(lockPoint, row - 1).xyz, p1 = lookup(lockPoint, row).xyz;
  vec3 p2 = lookup(lockPoint, row + 1).xyz, p3 = lookup(lockPoint, row + 2).xyz;
  vec3 on = p1 + 0.5 * t * ((p2 - p0) + t * ((2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) + t * (3.0 * (p1 - p2) + p3 - p0)));
  vec3 a = mix(lookup(lockA, row).xyz, lookup(lockA, row + 1).xyz, t);
  vec3 b = mix(lookup(lockB, row).xyz, lookup(lockB, row + 1).xyz, t);
  away = across.x * a + across.y * b;
  if (curled) away += curl(row, t, turned);
  return on + eased(row, t);
}

// The same on the polyline of the lock, which touches nothing.
vec3 onPolyline(vec4 lock, float at) {
  int j = min(int(at), int(lock.y) - 1), row = int(lock.x) + j;
  return mix(lookup(lockPoint, row).xyz, lookup(lockPoint, row + 1).xyz, at - float(j)) + eased(row, at - float(j));
}

// A place of hair at a fraction of a lock, where the rod has carried it: as in src/ringlet/live/carried_locks.h.
vec3 carried(vec4 lock, float at, vec3 place) {
  if (!live) return place;
  int v = 0;
  while (v < vertices - 2 && at >= along[v + 1]) v++;
  float t = clamp((at - along[v]) / (along[v + 1] - along[v]), 0.0, 1.0), w = t * t * (3.0 - 2.0 * t);
  int row = 3 * (int(lock.w) + v);
  vec3 moved;
  for (int c = 0; c < 3; c++) moved[c] = dot(mix(lookup(rodMotion, row + c), lookup(rodMotion, row + 3 + c), w), vec4(place, 1.0));
  return moved;
}

void main() {
  int index = int(gl_FragCoord.x) + 2048 * int(gl_FragCoord.y);
  int hair = index / points, k = index - hair * points;
  if (hair >= hairs) { result = vec4(0.0); return; }
  vec4 sits = lookup(hairPlace, hair), root = lookup(hairRoot, 2 * hair), mixed = lookup(hairMix, hair);
  vec3 joins = lookup(hairRoot, 2 * hair + 1).xyz;
  int station = int(joins.z) * points + k;
  vec4 ramp = lookup(ramps, 2 * station);
  vec4 lock = lookup(lockPlace, int(sits.x));
  float u = float(k) / float(points - 1);

  // Across the lock: the offset, and a wander eased from knot to knot.
  float knotAt = u * float(knots - 1);
  int i = min(int(knotAt), knots - 2);
  float ease = knotAt - float(i);
  ease = ease * ease * (3.0 - 2.0 * ease);
  vec2 wander = mix(knot(hairFrizz, hair, i), knot(hairFrizz, hair, i + 1), ease);
  vec2 across = (1.0 - ramp.y) * (ramp.x * (1.0 - mixed.x * u) * sits.zw + wander);

  vec4 turned = vec4(0.0); // cosine of the slip times the radius that is left, less 1; its sine; escape
  if (curled) {
    vec4 coil = lookup(hairCoil, hair), away = lookup(hairAway, hair), along = lookup(curlRamps, station);
    vec2 phase = mix(knot(hairTurn, hair, i), knot(hairTurn, hair, i + 1), ease);
    float follow = 1.0 - ramp.y, turn = coil.z * u + phase.y, flatly = cosine(turn);
    vec2 wound = vec2(mix(flatly, zigzag(turn), coil.w), (1.0 - coil.w) * cosine(turn - 0.25));
    across += follow * ramp.x * (1.0 - mixed.x * u) * along.z * away.xy;
    across += follow * along.w * vec2(wound.x * coil.x - wound.y * coil.y, wound.x * coil.y + wound.y * coil.x);
    float radius = 1.0 - mixed.w * along.y;
    turned.xy = follow * vec2(radius * cosine(phase.x) - 1.0, radius * cosine(phase.x - 0.25));
    turned.zw = follow * along.x * away.zw;
  }

  float at = lock.y * (joins.x + (sits.y - joins.x) * mix(u, lookup(ramps, 2 * station + 1).x, joins.y));
  vec3 away;
  if (joins.x > 0.0) root.xyz += lookup(lockPoint, int(lock.x)).xyz - onLock(lock, joins.x * lock.y, vec2(0.0), vec4(0.0), away);
  float part = at / lock.y;
  vec3 on = onLock(lock, at, across, turned, away);
  vec3 place = carried(lock, part, on + away + ramp.y * root.xyz), within = place - carried(lock, part, on);
  if (mixed.z > 0.0) { // drawn to a neighbouring lock: the same hair about that one
    vec4 other = lookup(lockPlace, int(mixed.y));
    vec3 there = root.xyz + lookup(lockPoint, int(lock.x)).xyz - lookup(lockPoint, int(other.x)).xyz;
    on = onLock(other, part * other.y, across, turned, away);
    vec3 theirs = carried(other, part, on + away + ramp.y * there);
    place += mixed.z * ramp.w * (theirs - place);
  }
  float keeps = texelFetch(left, ivec2(gl_FragCoord.xy), 0).r;
  if (keeps < 1.0) place = mix(carried(lock, part, onPolyline(lock, at)), place, keeps);
  result = vec4(place, root.w * ramp.z);

  // The lock is a tube here: where in it the hair is, and the optical depth of its radius, which is that of a disk.
  vec4 of = lookup(lockTube, int(sits.x));
  vec2 follows = vec2(1.0 - ramp.y, ramp.y);
  float radius = sqrt(2.0 * dot(follows * follows, vec2(of.y * ramp.x * ramp.x + of.z, of.w)));
  float depth = of.x * ramp.z / max(3.1415927 * radius, 1e-6);
  tube = vec4(0.5 + 0.5 * keeps * within / max(max(radius, length(within)), 1e-6), depth / (1.0 + depth));
}
`;

/** The hairs of one look. `points` is a texture with a texel for each point of each hair: its position and width. */
export class Carry {
  private target: WebGLRenderTarget;
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera();
  private readonly material: RawShaderMaterial;
  private readonly numbers: Record<string, Numbers> = {};
  private readonly left: Shares;
  private readonly tubes: Tubes;
  private roots: Float32Array | null = null;
  /** Rows of the target that are up to date. */
  private carried = 0;
  /** Number of the hairs that the card holds: the first ones, which stand for all. */
  readonly count: number;

  /** most: rows that a texture of the card has at most */
  constructor(
    readonly hairs: Hairs,
    most: number,
  ) {
    this.count = Math.min(hairs.count, Math.floor((most * WIDTH) / hairs.points));
    this.tubes = new Tubes(hairs);
    this.left = new Shares(this.count * hairs.points);
    this.target = target(this.count * hairs.points);
    this.material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      depthTest: false,
      uniforms: {
        hairs: { value: this.count },
        points: { value: hairs.points },
        knots: { value: hairs.knots },
        left: { value: this.left.texture },
        curled: { value: false },
        live: { value: false },
        along: { value: new Float32Array(MOST_VERTICES) },
        vertices: { value: 2 },
        easing: { value: 0 },
      },
    });
    this.scene.add(new Mesh(new PlaneGeometry(2, 2), this.material));
    const { count } = hairs;
    const place = new Float32Array(4 * count);
    for (let i = 0; i < count; i++)
      place.set([hairs.lock[i], hairs.tip[i], hairs.offset[2 * i], hairs.offset[2 * i + 1]], 4 * i);
    this.put("hairPlace", place);
    const mix = new Float32Array(4 * count);
    for (let i = 0; i < count; i++)
      mix.set([hairs.taper[i], hairs.other[i], hairs.share[i], hairs.relax[i] ?? 0], 4 * i);
    this.put("hairMix", mix);
    this.put("hairFrizz", evenKnots(hairs, hairs.frizz));
    this.setCurl();
    const stations = hairs.profile.length;
    const ramps = new Float32Array(8 * stations);
    for (let k = 0; k < stations; k++)
      ramps.set([hairs.profile[k], hairs.hold[k], hairs.thinning[k], hairs.blend[k], hairs.pace[k]], 8 * k);
    this.put("ramps", ramps);
    this.setRoots(hairs.root);
    this.put("rodMotion", new Float32Array(4));
    this.put("lockEase", new Float32Array(4));
    this.put("lockTube", new Float32Array(4));
  }

  /** Mean diameter of the hairs at their thickest [m]. */
  get width(): number {
    const { width, count } = this.hairs;
    return width.reduce((sum, one) => sum + one, 0) / Math.max(count, 1);
  }

  get points() {
    return this.target.textures[0];
  }

  /** Where each point is in the tube of its lock, by its radius, and the optical depth of the radius. */
  get within() {
    return this.target.textures[1];
  }

  /** A texture by the name that it has in the shader. */
  texture(name: string) {
    return this.numbers[name]?.texture ?? null;
  }

  /** Where roots are, from those of their locks: they turn with the head. */
  setRoots(root: Float32Array): void {
    if (root === this.roots) return;
    this.roots = root;
    const { count, width, join, flat, group } = this.hairs;
    const rows = new Float32Array(8 * count);
    for (let i = 0; i < count; i++)
      rows.set([root[3 * i], root[3 * i + 1], root[3 * i + 2], width[i], join[i], flat[i], group[i]], 8 * i);
    this.put("hairRoot", rows);
  }

  /** Which hairs are drawn towards their lock, and the part of their way from it that is left, point by point. */
  setDrawn(drawn: Uint32Array, left: Uint8Array): void {
    this.left.update(drawn, left, this.hairs.points);
  }

  /** The curl of hairs; one texel each where they only follow their lock. */
  private setCurl(): void {
    const { hairs } = this;
    this.put("hairTurn", evenKnots(hairs, interleaved(hairs.slip, hairs.phase, 1)));
    this.put("hairCoil", hairs.coil);
    this.put("hairAway", interleaved(hairs.family, hairs.escape, 2));
    const ramps = interleaved(hairs.escaping, hairs.relaxing, 1);
    this.put("curlRamps", interleaved(ramps, interleaved(hairs.tight, hairs.opening, 1), 2));
  }

  setLocks(table: LockTable): void {
    this.put("lockPoint", table.point);
    this.put("lockA", table.a);
    this.put("lockB", table.b);
    this.put("lockU", table.u);
    this.put("lockV", table.v);
    this.put("lockTube", this.tubes.measure(squaredRadii(table)));
    // Locks with the frames of their coils follow the hairs that need them: until then these follow their lock.
    this.material.uniforms["curled"].value = this.hairs.coil.length > 0 && table.curled;
    this.setPlaces(table);
  }

  /** Where the rows of each lock are, and how it is marked. */
  setPlaces(table: LockTable): void {
    this.put("lockPlace", table.places);
  }

  /** Where rods carry the hair from there: the places of their vertices, and the motions of these; none: it stays. */
  setMotions(along: Float32Array, motions: Float32Array | null): void {
    const { uniforms } = this.material;
    uniforms["live"].value = motions !== null;
    if (!motions) return;
    (uniforms["along"].value as Float32Array).set(along);
    uniforms["vertices"].value = along.length;
    this.put("rodMotion", motions);
  }

  /** How far points of locks are seen from rest, in rows as those of the table, and the share of it that is left. */
  setEase(rows: Float32Array | null, share: number): void {
    if (rows) this.put("lockEase", rows);
    this.material.uniforms["easing"].value = share;
  }

  /** All hairs are to be carried again. */
  begin(): void {
    this.carried = 0;
  }

  /** Brings hairs to their places, up to a number of them; those that are there stay. Begins again where they move meanwhile. */
  *update(renderer: WebGLRenderer, hairs: number, slices: Slices): Work {
    const rows = Math.min(this.target.height, Math.ceil((hairs * this.hairs.points) / WIDTH));
    for (let done = this.carried; done < rows; done = this.carried)
      yield* slices.draw("carry", rows - done, (first, count) => {
        if (this.carried !== done + first) return;
        this.target.scissorTest = true;
        this.target.scissor.set(0, done + first, WIDTH, count);
        const before = renderer.getRenderTarget();
        renderer.setRenderTarget(this.target);
        renderer.render(this.scene, this.camera);
        renderer.setRenderTarget(before);
        this.carried = done + first + count;
      });
  }

  /** The points of the first hairs, as they are on the card: four numbers a point. */
  read(renderer: WebGLRenderer, hairs: number): Float32Array {
    const rows = Math.min(this.target.height, Math.ceil((hairs * this.hairs.points) / WIDTH));
    const values = new Float32Array(4 * WIDTH * rows);
    renderer.readRenderTargetPixels(this.target, 0, 0, WIDTH, rows, values);
    return values.subarray(0, 4 * Math.min(hairs, this.count) * this.hairs.points);
  }

  dispose(): void {
    this.target.dispose();
    this.material.dispose();
    this.left.dispose();
    for (const numbers of Object.values(this.numbers)) numbers.dispose();
  }

  private put(name: string, values: Float32Array): void {
    if (this.numbers[name]) {
      this.numbers[name].update(values);
      return;
    }
    this.numbers[name] = new Numbers(values);
    this.material.uniforms[name] = { value: this.numbers[name].texture };
  }
}

function target(texels: number): WebGLRenderTarget {
  const made = new WebGLRenderTarget(WIDTH, Math.max(1, Math.ceil(texels / WIDTH)), {
    count: 2,
    type: FloatType,
    format: RGBAFormat,
    minFilter: NearestFilter,
    magFilter: NearestFilter,
    depthBuffer: false,
    generateMipmaps: false,
  });
  made.textures[1].type = UnsignedByteType;
  return made;
}

/** Knots of each hair in whole texels: an odd number gets one more at its end, which nobody reads. */
function evenKnots({ count, knots }: Hairs, values: Float32Array): Float32Array {
  if (knots % 2 === 0 || !values.length) return values;
  const even = new Float32Array(2 * (knots + 1) * count);
  for (let i = 0; i < count; i++) even.set(values.subarray(2 * knots * i, 2 * knots * (i + 1)), 2 * (knots + 1) * i);
  return even;
}

/** Rows of `size` numbers of one array, each followed by that of the other. */
function interleaved(one: Float32Array, other: Float32Array, size: number): Float32Array {
  const both = new Float32Array(2 * one.length);
  for (let i = 0; i < one.length; i += size) {
    both.set(one.subarray(i, i + size), 2 * i);
    both.set(other.subarray(i, i + size), 2 * i + size);
  }
  return both;
}
