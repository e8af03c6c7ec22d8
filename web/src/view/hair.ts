// The hair of one look: carried by its locks, drawn as ribbons, and what it does to the key light.

import {
  AddEquation,
  Box3,
  CustomBlending,
  GLSL3,
  InstancedBufferGeometry,
  Mesh,
  OneFactor,
  RawShaderMaterial,
  Scene,
  Vector3,
  type WebGLRenderer,
} from "three";
import type { Colors, Frame, Hairs, Locks } from "../protocol";
import { Carry } from "./carry";
import { DEPTH_FRAGMENT, DEPTH_VERTEX, HAIR_FRAGMENT, HAIR_VERTEX, LAYERS_FRAGMENT } from "./hair_shader";
import type { Lights } from "./lights";
import type { Shadow } from "./shadow";
import { type LockTable, lockTable } from "./table";
import { Colours } from "./textures";

/** A hair colour: linear reflectance in red, green and blue, and roughness. */
export type Colour = [number, number, number, number];

/** The least width at which a hair is drawn [pixels]. */
const THINNEST = 0.9;

/** Where locks are; in a frame also where roots are from those of their locks, and which hairs are drawn to theirs. */
type Placed = Pick<Locks, "points" | "axis"> & Partial<Pick<Frame, "root" | "drawn" | "left">>;

type Uniforms = Record<string, { value: unknown }>;

export class Hair {
  readonly scene = new Scene();
  readonly depthScene = new Scene();
  readonly layersScene = new Scene();
  readonly firstScene = new Scene();
  readonly box = new Box3();
  locks: Locks | null = null;
  /** Points of the locks where they are now, at rest or in a frame. */
  placed: Float32Array | null = null;
  table: LockTable | null = null;
  private carry: Carry | null = null;
  private geometry = new InstancedBufferGeometry();
  private readonly shared: Uniforms;
  private readonly material: RawShaderMaterial;
  private readonly depth: RawShaderMaterial;
  private readonly layers: RawShaderMaterial;
  private readonly first: RawShaderMaterial;
  private stale = true;
  private stride = 1;
  private overlay: Uint8Array | undefined;
  private own: Colors | null = null;
  private named: Colour | null = null;
  private ownShown = true;
  private colours: Colours | null = null;

  constructor(lights: Lights, shadow: Shadow) {
    this.shared = {
      hairPoints: { value: null },
      points: { value: 2 },
      stride: { value: 1 },
      thicken: { value: 1 },
      hairPlace: { value: null },
      lockPlace: { value: null },
      lockPoint: { value: null },
    };
    this.material = this.make(HAIR_VERTEX, HAIR_FRAGMENT, {
      ...lights.uniforms,
      ...shadow.uniforms,
      ...view(),
      reflectance: { value: new Vector3() },
      roughness: { value: 0.35 },
      tilt: { value: 0.035 },
      hairColor: { value: null },
      stations: { value: 0 },
      middle: { value: new Vector3() },
      highlight: { value: new Vector3(0.2, 0.55, 0.9) },
      showOverlay: { value: 0 },
    });
    this.depth = this.make(DEPTH_VERTEX, DEPTH_FRAGMENT, view(1));
    this.layers = this.make(DEPTH_VERTEX, LAYERS_FRAGMENT, {
      ...view(1),
      hairNearest: shadow.uniforms.hairNearest,
      layers: shadow.uniforms.layers,
      density: { value: 0.5 },
    });
    Object.assign(this.layers, {
      blending: CustomBlending,
      blendEquation: AddEquation,
      blendSrc: OneFactor,
      blendDst: OneFactor,
      depthTest: false,
      depthWrite: false,
      transparent: true,
    });
    this.first = this.make(DEPTH_VERTEX, DEPTH_FRAGMENT, view());
    this.first.colorWrite = false;
    for (const [scene, material] of [
      [this.scene, this.material],
      [this.firstScene, this.first],
      [this.depthScene, this.depth],
      [this.layersScene, this.layers],
    ] as const) {
      const mesh = new Mesh(this.geometry, material);
      mesh.frustumCulled = false;
      mesh.name = "hair";
      scene.add(mesh);
    }
  }

  get count(): number {
    return this.carry?.hairs.count ?? 0;
  }

  /** Removes the hair. */
  clear(): void {
    this.carry?.dispose();
    this.carry = this.locks = this.table = null;
    this.box.makeEmpty();
  }

  setHairs(hairs: Hairs): void {
    this.carry?.dispose();
    this.carry = new Carry(hairs);
    this.shared["points"].value = hairs.points;
    this.setStride(this.stride, true);
    this.recolour();
    if (this.locks) this.setLocks(this.locks);
    this.stale = true;
  }

  setLocks(locks: Locks): void {
    this.locks = locks;
    this.place(locks);
  }

  /** Puts the hair where it is, at rest or in a frame. */
  place({ points, axis, root, drawn, left }: Placed): void {
    if (!this.locks || points.length !== this.locks.points.length) return;
    this.placed = points;
    this.table = lockTable(points, this.locks.offsets, axis, this.carry?.hairs.window ?? new Int32Array());
    this.setMarks(this.locks.marked);
    this.spread();
    if (root?.length) this.carry?.setRoots(root);
    this.carry?.setDrawn(drawn ?? new Uint32Array(), left ?? new Uint8Array());
    measure(this.box, points);
    (this.material.uniforms["middle"].value as Vector3).copy(this.box.getCenter(new Vector3()));
    this.carry?.setLocks(this.table);
    this.stale = true;
  }

  /** Sets which locks are marked: 1 isolated, 2 chosen. */
  mark(marked: ArrayLike<number>): void {
    this.setMarks(marked);
    if (this.table) this.carry?.setPlaces(this.table);
    this.stale = true;
  }

  /** Colours of the hairs by their pigments; without stations they have none. */
  setColors(colors: Colors): void {
    this.own = colors;
    this.colours?.dispose();
    this.colours = colors.stations ? new Colours(colors.reflectance) : null;
    this.material.uniforms["hairColor"].value = this.colours?.texture ?? null;
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
    const { uniforms } = this.material;
    const fits = own !== null && own.reflectance.length === 3 * own.stations * this.count;
    const shown = this.ownShown && own !== null && own.stations > 0 && fits;
    uniforms["stations"].value = shown ? own.stations : 0;
    if (named) (uniforms["reflectance"].value as Vector3).fromArray(named);
    uniforms["roughness"].value = shown || !named ? (own?.roughness ?? 0.25) : named[3];
    uniforms["tilt"].value = ((own?.tilt ?? 2) * Math.PI) / 180;
  }

  /** Tints the hair by a value for each point of the locks; nothing: the hair as it is. */
  setOverlay(values: Uint8Array | undefined, diverging: boolean): void {
    this.material.uniforms["showOverlay"].value = values?.length ? (diverging ? 1 : 2) : 0;
    if (values === this.overlay) return;
    this.overlay = values;
    this.spread();
    if (this.table) this.carry?.setLocks(this.table);
    this.stale = true;
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

  /** Draws only a part of the hairs, wider, so that the whole keeps its weight. */
  setDetail(fraction: number, stride: number): void {
    this.geometry.instanceCount = Math.max(1, Math.round(this.count * fraction));
    this.shared["thicken"].value = Math.min(3, 1 / Math.sqrt(fraction));
    this.setStride(stride, false);
  }

  /** Brings the hairs to their places; true when they have moved since the last time. */
  update(renderer: WebGLRenderer): boolean {
    if (!this.stale || !this.carry || !this.table) return false;
    this.stale = false;
    this.carry.update(renderer);
    this.shared["hairPoints"].value = this.carry.points;
    for (const name of ["hairPlace", "lockPlace", "lockPoint"]) this.shared[name].value = this.carry.texture(name);
    return true;
  }

  seenFrom(eye: Vector3, pixel: number): void {
    for (const material of [this.material, this.first]) {
      (material.uniforms["eye"].value as Vector3).copy(eye);
      material.uniforms["pixel"].value = pixel * THINNEST;
    }
  }

  litFrom(direction: Vector3, texel: number): void {
    for (const material of [this.depth, this.layers]) {
      (material.uniforms["eyeward"].value as Vector3).copy(direction);
      material.uniforms["pixel"].value = texel;
    }
  }

  read(renderer: WebGLRenderer, hairs: number): Float32Array {
    return this.carry?.read(renderer, hairs) ?? new Float32Array();
  }

  dispose(): void {
    this.carry?.dispose();
    this.colours?.dispose();
    this.geometry.dispose();
    for (const material of [this.material, this.first, this.depth, this.layers]) material.dispose();
  }

  private make(vertexShader: string, fragmentShader: string, uniforms: Uniforms): RawShaderMaterial {
    return new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader,
      fragmentShader,
      uniforms: { ...this.shared, ...uniforms },
      side: 2,
    });
  }

  /** A strip of two triangles between every `stride` points. */
  private setStride(stride: number, always: boolean): void {
    if (!always && stride === this.stride) return;
    this.stride = stride;
    this.shared["stride"].value = stride;
    const spans = Math.ceil(((this.shared["points"].value as number) - 1) / stride);
    const index = new Uint16Array(6 * spans);
    for (let k = 0; k < spans; k++) index.set([2 * k, 2 * k + 1, 2 * k + 2, 2 * k + 2, 2 * k + 1, 2 * k + 3], 6 * k);
    const { instanceCount } = this.geometry;
    this.geometry.dispose();
    this.geometry = new InstancedBufferGeometry();
    this.geometry.setIndex([...index]);
    this.geometry.instanceCount = Math.min(instanceCount, this.count);
    for (const scene of [this.scene, this.firstScene, this.depthScene, this.layersScene])
      (scene.children[0] as Mesh).geometry = this.geometry;
  }
}

function view(parallel = 0): Uniforms {
  return {
    pixel: { value: 0.001 },
    eye: { value: new Vector3() },
    parallel: { value: parallel },
    eyeward: { value: new Vector3(0, 0, 1) },
  };
}

function measure(box: Box3, points: Float32Array): void {
  box.makeEmpty();
  const place = new Vector3();
  for (let i = 0; i < points.length; i += 3) box.expandByPoint(place.fromArray(points, i));
}
