// The hair of one look: carried by its locks, drawn as ribbons, and the light in its mass.

import {
  Box3,
  GLSL3,
  InstancedBufferGeometry,
  type Matrix4,
  Mesh,
  PlaneGeometry,
  RawShaderMaterial,
  Scene,
  Vector3,
  type Texture,
  type WebGLRenderer,
} from "three";
import type { Colors, Frame, Hairs, Locks } from "../protocol";
import { Carry } from "./carry";
import { Density } from "./density";
import { type Carried, easeFrom, seen, shareLeft } from "./ease";
import { FiberTable, type Roughness, type Transport, variances } from "./fiber";
import {
  DEFERRED_FRAGMENT,
  DEFERRED_VERTEX,
  DEPTH_FRAGMENT,
  DEPTH_VERTEX,
  HAIR_FRAGMENT,
  HAIR_VERTEX,
  SEEN_FRAGMENT,
  SEEN_VERTEX,
} from "./hair_shader";
import type { Lights } from "./lights";
import type { Rods } from "./rods";
import { complete, Slices, type Work } from "./slices";
import { type LockTable, lockTable } from "./table";
import { Colours } from "./textures";
import type { Beam } from "./beam";
import { around, Grid, shell, type Surface } from "./grid";
import { LightVolume } from "./volume";

/** A hair colour: linear reflectance in red, green and blue, and the roughness of the fiber along and around it. */
export type Colour = [number, number, number, number, number];

/** Where locks are; in a frame also where roots are from those of their locks, and which hairs are drawn to theirs. */
type Placed = Pick<Locks, "points" | "axis"> & Partial<Pick<Frame, "root" | "drawn" | "left">>;

/** What the light in the hair is computed for: the state of hair and bodies by a number that grows, lamps, surroundings. */
interface Lit {
  revision: number;
  beams: Beam[];
  ambient: Vector3;
}

type Uniforms = Record<string, { value: unknown }>;

export class Hair {
  readonly scene = new Scene();
  readonly firstScene = new Scene();
  readonly box = new Box3();
  /** That of the hair where it is placed. */
  private readonly placedBox = new Box3();
  readonly volume = new LightVolume();
  locks: Locks | null = null;
  /** Points of the locks where they are now, at rest or in a frame. */
  placed: Float32Array | null = null;
  table: LockTable | null = null;
  /** The rods that carry the hair in live motion, where their vertices are, and the motion of the head. */
  private carrying: { rods: Rods; points: Float32Array; head: Matrix4 } | null = null;
  /** Motions of the vertices of rods that carry the hair; null: none do. */
  motions: Float32Array | null = null;
  /** How far points of locks were seen from rest when something changed, and when that was [ms]. */
  private ease: { from: Float32Array; since: number } | null = null;
  private carry: Carry | null = null;
  private geometry = new InstancedBufferGeometry();
  private readonly shared: Uniforms;
  private readonly material: RawShaderMaterial;
  private readonly first: RawShaderMaterial;
  private readonly ribbons: Mesh[];
  private readonly density: Density;
  /** Grows with each change of what the light is in: hair and bodies. */
  private revision = 0;
  /** Revision with which the light volume is filled. */
  private filled = -1;
  /** The light that is seen, and that which is being computed. */
  private lit: Lit | null = null;
  private lighting: { lit: Lit; work: Work } | null = null;
  private stride = 1;
  private overlay: Uint8Array | undefined;
  private own: Colors | null = null;
  private named: Colour | null = null;
  private ownShown = true;
  private colours: Colours | null = null;
  private fiber: FiberTable | null = null;
  private fiberKey = "";
  private roughness: Roughness = { along: 0.25, around: 0.38 };

  /**
   * deferred: whether hairs are shaded once it is known which are seen. A processor shades hidden ones too otherwise; a
   * card does not, and its several samples of a pixel want hairs that are shaded on their own.
   * most: rows that a texture of the card has at most
   */
  constructor(
    private readonly lights: Lights,
    deferred: boolean,
    private readonly most: number,
  ) {
    this.shared = {
      hairPoints: { value: null },
      hairTubes: { value: null },
      points: { value: 2 },
      hairColor: { value: null },
      stations: { value: 0 },
      tone: { value: new Vector3() },
    };
    const drawn = {
      ...this.shared,
      stride: { value: 1 },
      thicken: { value: 1 },
      hairs: { value: 1 },
      firstHair: { value: 0 },
      eye: { value: new Vector3() },
    };
    const uniforms = {
      ...drawn,
      ...lights.uniforms,
      ...this.volume.uniforms,
      hairPlace: { value: null },
      lockPlace: { value: null },
      lockPoint: { value: null },
      lockTube: { value: null },
      fiberTable: { value: null },
      fiberTransport: { value: null },
      variance: { value: new Vector3() },
      tilt: { value: 0.035 },
      highlight: { value: new Vector3(0.2, 0.55, 0.9) },
      showOverlay: { value: 0 },
      seen: { value: null },
    };
    if (deferred) {
      this.material = this.make(DEFERRED_VERTEX, DEFERRED_FRAGMENT, uniforms);
      this.material.depthTest = this.material.depthWrite = false;
      this.first = this.make(SEEN_VERTEX, SEEN_FRAGMENT, uniforms);
    } else {
      this.material = this.make(HAIR_VERTEX, HAIR_FRAGMENT, uniforms);
      this.first = this.make(DEPTH_VERTEX, DEPTH_FRAGMENT, uniforms);
      this.first.colorWrite = false;
    }
    this.density = new Density(this.shared);
    const ribbons = new Mesh(this.geometry, this.first);
    const shaded = new Mesh(deferred ? new PlaneGeometry(2, 2) : this.geometry, this.material);
    this.ribbons = deferred ? [ribbons] : [ribbons, shaded];
    for (const mesh of [ribbons, shaded]) mesh.frustumCulled = false;
    for (const mesh of this.ribbons) mesh.name = "hair";
    this.firstScene.add(ribbons);
    this.scene.add(shaded);
  }

  /** Number of the hairs that the card holds, which stand for all. */
  get count(): number {
    return this.carry?.count ?? 0;
  }

  /** Number of hairs, also of those that the card does not hold. */
  get all(): number {
    return this.carry?.hairs.count ?? 0;
  }

  /** Removes the hair. */
  clear(): void {
    this.carry?.dispose();
    this.carry = this.locks = this.table = this.carrying = null;
    this.box.makeEmpty();
  }

  setHairs(hairs: Hairs): void {
    this.carry?.dispose();
    this.carry = new Carry(hairs, this.most);
    this.lighting = null;
    this.shared["points"].value = hairs.points;
    this.material.uniforms["hairs"].value = this.count;
    this.setStride(this.stride, true);
    this.recolour();
    if (this.locks) this.place(this.locks);
    this.showEase(true);
    this.moved();
  }

  setLocks(locks: Locks): void {
    this.goOn(() => {
      this.locks = locks;
      this.place(locks);
    });
  }

  /** Changes what places the hair; while rods carry it, it goes on from where it is seen. */
  private goOn(change: () => void): void {
    const before = this.carried;
    const places = before && seen(before, this.ease?.from ?? null, this.shareLeft);
    change();
    const now = this.carried;
    this.ease = before && places && now ? { from: easeFrom(before.locks, places, now), since: performance.now() } : null;
    this.showEase(true);
  }

  /** What places the hair that rods carry. */
  private get carried(): Carried | null {
    const { locks, placed: points, carrying, motions } = this;
    return locks && points && carrying && motions ? { locks, points, rods: carrying.rods, motions } : null;
  }

  /** Where the points of locks are seen, also while rods carry them. */
  get seen(): Float32Array | null {
    const { carried } = this;
    return carried ? seen(carried, this.ease?.from ?? null, this.shareLeft) : this.placed;
  }

  /** The share that is left of how far hair was seen from rest. */
  private get shareLeft(): number {
    return this.ease ? shareLeft((performance.now() - this.ease.since) / 1000) : 0;
  }

  /** Hands on how far hair is seen from rest; anew: after a change */
  private showEase(anew: boolean): void {
    const { ease, carry, locks, table, shareLeft } = this;
    if (!carry || !table || !locks) return;
    if (!shareLeft) this.ease = null;
    let rows: Float32Array | null = null;
    if (anew && ease) {
      rows = new Float32Array(4 * table.rows);
      for (let lock = 0; lock + 1 < locks.offsets.length; lock++)
        for (let i = locks.offsets[lock]; i < locks.offsets[lock + 1]; i++)
          rows.set(ease.from.subarray(3 * i, 3 * i + 3), 4 * (i + 3 * lock + 1));
    }
    carry.setEase(rows, shareLeft);
  }

  /** Puts the hair where it is, at rest or in a frame. */
  place({ points, axis, root, drawn, left }: Placed): void {
    if (!this.locks || points.length !== this.locks.points.length) return;
    this.placed = points;
    this.table = lockTable(points, this.locks.offsets, axis, this.locks.window);
    this.setMarks(this.locks.marked);
    this.spread();
    this.carry?.setRoots(root?.length ? root : this.carry.hairs.root);
    this.carry?.setDrawn(drawn ?? new Uint32Array(), left ?? new Uint8Array());
    measure(this.placedBox, points);
    this.carry?.setLocks(this.table);
    this.follow();
    this.moved();
  }

  /** Lets rods carry the hair from where it is placed; nothing: it is where it is placed. */
  carryBy(rods: Rods | null, points: Float32Array = new Float32Array(), head?: Matrix4): void {
    const carrying = rods && head ? { rods, points, head } : null;
    if (!carrying && !this.carrying) return;
    const follow = () => {
      this.carrying = carrying;
      this.follow();
    };
    if (this.carrying && carrying?.rods !== this.carrying.rods) this.goOn(follow);
    else follow();
    this.showEase(false);
    this.moved();
  }

  /** The hair follows the rods that carry it. */
  private follow(): void {
    const { carrying, carry, table, locks } = this;
    this.box.copy(this.placedBox);
    if (!carry || !table || !locks) return;
    if (!carrying) {
      this.motions = null;
      carry.setMotions(new Float32Array(), null);
      return;
    }
    const { rods, points, head } = carrying;
    this.motions = rods.motions(points, head);
    rods.first(locks.ids).forEach((vertex, lock) => (table.places[4 * lock + 3] = vertex));
    carry.setPlaces(table);
    carry.setMotions(rods.message.along, this.motions);
    this.box.copy(rods.box(points, this.placedBox));
  }

  /** Sets which locks are marked: 1 isolated, 2 chosen. */
  mark(marked: ArrayLike<number>): void {
    this.setMarks(marked);
    if (this.table) this.carry?.setPlaces(this.table);
  }

  /** Colours of the hairs by their pigments; without stations they have none. */
  setColors(colors: Colors): void {
    this.own = colors;
    this.colours?.dispose();
    this.colours = colors.stations ? new Colours(colors.reflectance) : null;
    this.shared["hairColor"].value = this.colours?.texture ?? null;
    this.recolour();
  }

  /** Shows all hair in one colour; null: in its own, or in `otherwise` where it has none. */
  setColour(named: Colour | null, otherwise: Colour): void {
    this.named = named ?? otherwise;
    this.ownShown = named === null;
    this.recolour();
  }

  private recolour(): void {
    const { own, named } = this;
    const fits = own !== null && own.reflectance.length >= 3 * own.stations * this.all; // the first of all where few stand for them
    const shown = this.ownShown && own !== null && own.stations > 0 && fits;
    this.shared["stations"].value = shown ? own.stations : 0;
    if (named) (this.shared["tone"].value as Vector3).fromArray(named.slice(0, 3).map((c) => c ** 0.25));
    this.material.uniforms["tilt"].value = ((own?.tilt ?? 2) * Math.PI) / 180;
    if (shown) this.roughness = { along: own.roughness, around: own.azimuthal_roughness };
    else if (named) this.roughness = { along: named[3], around: named[4] };
    this.revision++;
  }

  /** The table of the fiber as it is rough now, under lamps of their size. */
  private tabulate(): FiberTable {
    const { roughness, lights } = this;
    const key = JSON.stringify([roughness, lights.spread]);
    if (this.fiber && key === this.fiberKey) return this.fiber;
    this.fiberKey = key;
    this.fiber?.dispose();
    this.fiber = new FiberTable(roughness, lights.spread);
    const { uniforms } = this.material;
    uniforms["fiberTable"].value = this.fiber.texture;
    uniforms["fiberTransport"].value = this.fiber.means;
    (uniforms["variance"].value as Vector3).fromArray(variances(roughness.along));
    this.revision++;
    return this.fiber;
  }

  /** Tints the hair by a value for each point of the locks; nothing: the hair as it is. */
  setOverlay(values: Uint8Array | undefined, diverging: boolean): void {
    this.material.uniforms["showOverlay"].value = values?.length ? (diverging ? 1 : 2) : 0;
    if (values === this.overlay) return;
    this.overlay = values;
    this.spread();
    if (this.table) this.carry?.setLocks(this.table);
  }

  private setMarks(marked: ArrayLike<number>): void {
    if (!this.table) return;
    for (let lock = 0; lock < marked.length; lock++) this.table.places[4 * lock + 2] = marked[lock];
  }

  /** Puts the overlay's values into the rows of the table. */
  private spread(): void {
    const { table, overlay, locks } = this;
    if (!table || !locks || overlay?.length !== locks.points.length / 3) return;
    const { offsets } = locks;
    for (let lock = 0; lock + 1 < offsets.length; lock++) {
      const first = offsets[lock] + 3 * lock + 1;
      const count = offsets[lock + 1] - offsets[lock];
      for (let i = -1; i < count + 2; i++)
        table.point[4 * (first + i) + 3] = overlay[offsets[lock] + Math.min(Math.max(i, 0), count - 1)] / 255;
    }
  }

  /** Number of the hairs that stand for all in a drawing. */
  private drawn(fraction: number): number {
    return Math.max(1, Math.round(this.count * fraction));
  }

  /** Draws a part of the hairs, the first, the second or another one, wider, so that they cover as much as all. */
  *draw(fraction: number, stride: number, number: number, slices: Slices, render: () => void): Work {
    const begin = Math.round(number * fraction * this.count) % Math.max(this.count, 1);
    yield* slices.draw("hairs", this.drawn(fraction), (first, count) => {
      const { uniforms } = this.material;
      uniforms["thicken"].value = this.all / this.drawn(fraction);
      uniforms["firstHair"].value = begin + first;
      this.setStride(stride, false);
      this.geometry.instanceCount = count;
      render();
    });
  }

  /** Brings the hairs of some drawings to their places. */
  *update(renderer: WebGLRenderer, fraction: number, drawings: number, slices: Slices): Work {
    if (!this.carry || !this.table) return;
    yield* this.carry.update(renderer, Math.min(this.count, Math.ceil(drawings * fraction * this.count) + 1), slices);
    this.shared["hairPoints"].value = this.carry.points;
    this.shared["hairTubes"].value = this.carry.within;
    for (const name of ["hairPlace", "lockPlace", "lockPoint", "lockTube"])
      this.material.uniforms[name].value = this.carry.texture(name);
  }

  /**
   * Lights the mass of the hair, and the bodies within its reach. While something moves, each picture takes a slice of
   * that work, and is lit as it was before.
   */
  *light(renderer: WebGLRenderer, surfaces: () => Surface[], moving: boolean, slices: Slices): Work {
    if (!this.carry || !this.table || this.box.isEmpty()) return;
    const { transport } = this.tabulate();
    const { revision } = this;
    const now: Lit = { revision, beams: this.lights.beams.map(copied), ambient: this.lights.ambient };
    if (this.lit && isSame(now, this.lit)) return;
    const kept = moving && this.lit !== null;
    if (!this.lighting || !(kept || isSame(now, this.lighting.lit)))
      this.lighting = { lit: now, work: this.computeLight(renderer, surfaces, now, transport, slices) };
    const { lit, work } = this.lighting;
    if (!kept) yield* work;
    else if (!work.next(0).done) return;
    this.lit = lit;
    this.lighting = null;
  }

  private *computeLight(
    renderer: WebGLRenderer,
    surfaces: () => Surface[],
    { revision, beams, ambient }: Lit,
    transport: Transport,
    slices: Slices,
  ): Work {
    if (this.filled !== revision) {
      const bodies = surfaces();
      const grid = Grid.of(around(this.box, bodies));
      yield* this.update(renderer, this.density.measured(this.all) / this.count, 1, slices);
      const hair = yield* this.density.measure(renderer, grid, this.all, slices);
      const skin = yield* slices.compute(shell(grid, bodies));
      this.volume.fill({ grid, ...hair, ...skin });
      this.filled = revision;
    }
    yield* slices.compute(this.volume.light(beams, ambient, transport));
  }

  /** Bodies have moved: the light in the hair is to be computed again. */
  relight(): void {
    this.revision++;
  }

  /** Hairs have other places. */
  private moved(): void {
    this.revision++;
    this.carry?.begin();
  }

  /** Which hairs are seen, pixel by pixel: what is drawn from `firstScene`. */
  set seen(points: Texture) {
    this.material.uniforms["seen"].value = points;
  }

  seenFrom(eye: Vector3): void {
    (this.material.uniforms["eye"].value as Vector3).copy(eye);
  }

  /** Diameter of the hairs [m]. */
  get width(): number {
    return this.carry?.width ?? 7e-5;
  }

  read(renderer: WebGLRenderer, hairs: number): Float32Array {
    complete(this.update(renderer, 1, 1, new Slices()));
    return this.carry?.read(renderer, hairs) ?? new Float32Array();
  }

  dispose(): void {
    this.carry?.dispose();
    this.colours?.dispose();
    this.geometry.dispose();
    this.fiber?.dispose();
    this.density.dispose();
    this.volume.dispose();
    for (const material of [this.material, this.first]) material.dispose();
  }

  private make(vertexShader: string, fragmentShader: string, uniforms: Uniforms): RawShaderMaterial {
    return new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader,
      fragmentShader,
      uniforms,
      side: 2,
    });
  }

  /** A strip of two triangles between every `stride` points. */
  private setStride(stride: number, always: boolean): void {
    if (!always && stride === this.stride) return;
    this.stride = stride;
    this.material.uniforms["stride"].value = stride;
    const spans = Math.ceil(((this.shared["points"].value as number) - 1) / stride);
    const index = new Uint16Array(6 * spans);
    for (let k = 0; k < spans; k++) index.set([2 * k, 2 * k + 1, 2 * k + 2, 2 * k + 2, 2 * k + 1, 2 * k + 3], 6 * k);
    const { instanceCount } = this.geometry;
    this.geometry.dispose();
    this.geometry = new InstancedBufferGeometry();
    this.geometry.setIndex([...index]);
    this.geometry.instanceCount = Math.min(instanceCount, this.count);
    for (const mesh of this.ribbons) mesh.geometry = this.geometry;
  }
}

function copied({ from, place, reach, radius, strength }: Beam): Beam {
  return { from: from.clone(), place: place.clone(), reach, radius, strength: strength.clone() };
}

function isSame(one: Lit, other: Lit): boolean {
  if (one.revision !== other.revision) return false;
  const same = (a: Vector3, b: Vector3) => a.distanceToSquared(b) < 1e-12;
  const beams = one.beams.every((beam, k) => {
    const { place, reach, radius, strength } = other.beams[k];
    return same(beam.place, place) && beam.reach === reach && beam.radius === radius && same(beam.strength, strength);
  });
  return beams && same(one.ambient, other.ambient);
}

function measure(box: Box3, points: Float32Array): void {
  box.makeEmpty();
  const place = new Vector3();
  for (let i = 0; i < points.length; i += 3) box.expandByPoint(place.fromArray(points, i));
}
