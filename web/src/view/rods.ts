// How rods carry hair in live motion: the motions of their vertices. The same as in src/ringlet/live/carried_locks.cpp.

import { Box3, Matrix4, Vector3 } from "three";
import type { LiveStep, Rods as RodsMessage } from "../protocol";
import { frames } from "./table";

export const MOST_VERTICES = 16; // of a rod

const NARROWEST = 0.25; // coil that is drawn out, by its radius
const STRAIGHT = 0.95; // rise of a coil that is nearly straight: what is straighter gets no narrower

/** The rods of a groom. */
export class Rods {
  /** Vertices of each. */
  readonly vertices: number;
  private readonly groomed: Float32Array;
  private readonly lengths: Float32Array;
  private readonly axis: Float32Array;
  /** The rod of a lock, by its id. */
  private readonly rodOf: Map<number, number>;
  /** What hair reaches beyond its rods [m]. */
  private reach = 0;

  constructor(readonly message: RodsMessage) {
    this.vertices = message.along.length;
    this.groomed = this.framesOf(message.points, message.axis);
    this.lengths = this.lengthsOf(message.points);
    this.rodOf = new Map(Array.from(message.ids, (id, lock) => [id, message.carrier[lock]]));
    this.axis = new Float32Array(message.axis.length);
  }

  /** The first vertex of the rod of each lock; locks without a rod go with the head, by the last motions. */
  first(ids: Float64Array): number[] {
    const none = this.message.points.length / (3 * this.vertices);
    return Array.from(ids, (id) => this.vertices * (this.rodOf.get(id) ?? none));
  }

  /**
   * Motions [A t] of all vertices since they were groomed: twelve numbers each, rows of four. Behind them are as many as a
   * rod has, of the head.
   */
  motions(points: Float32Array, head: Matrix4): Float32Array {
    const { axis, groomed, message } = this;
    const across = new Vector3();
    const turn = head.clone().setPosition(0, 0, 0);
    for (let i = 0; i < axis.length; i += 3) across.fromArray(message.axis, i).applyMatrix4(turn).toArray(axis, i);
    const now = this.framesOf(points, axis);
    const lengths = this.lengthsOf(points);
    const motions = new Float32Array(4 * points.length + 12 * this.vertices);
    const ofHead = head.clone().transpose().elements.slice(0, 12);
    for (let at = 4 * points.length; at < motions.length; at += 12) motions.set(ofHead, at);
    for (let v = 0; 3 * v < points.length; v++) {
      const along = lengths[v] / this.lengths[v];
      const across = narrowing(along, message.rise[Math.floor(v / this.vertices)]);
      for (let row = 0; row < 3; row++) {
        const at = 12 * v + 4 * row;
        let shift = points[3 * v + row];
        for (let c = 0; c < 3; c++) {
          let entry = 0;
          for (let k = 0; k < 9; k += 3) entry += (k < 6 ? across : along) * now[9 * v + k + row] * groomed[9 * v + k + c];
          motions[at + c] = entry;
          shift -= entry * message.points[3 * v + c];
        }
        motions[at + 3] = shift;
      }
    }
    return motions;
  }

  /** The box of hair whose rods have these vertices, of one that fills another box as groomed. */
  box(points: Float32Array, rest: Box3): Box3 {
    const groomed = boxOf(this.message.points);
    this.reach ||= Math.max(...rest.max.clone().sub(groomed.max).toArray(), ...groomed.min.sub(rest.min).toArray(), 0);
    return boxOf(points).expandByScalar(this.reach);
  }

  /** Length about each vertex: half of the edges that meet there. */
  private lengthsOf(points: Float32Array): Float32Array {
    const { vertices } = this;
    const lengths = new Float32Array(points.length / 3);
    for (let v = 1; v < lengths.length; v++) {
      if (v % vertices === 0) continue;
      const [i, j] = [3 * v - 3, 3 * v];
      const half = 0.5 * Math.hypot(points[j] - points[i], points[j + 1] - points[i + 1], points[j + 2] - points[i + 2]);
      lengths[v - 1] += half;
      lengths[v] += half;
    }
    return lengths;
  }

  /** Frames along all rods: three axes a vertex, nine numbers. */
  private framesOf(points: Float32Array, axis: Float32Array): Float32Array {
    const { vertices } = this;
    const count = points.length / 3;
    const [a, b] = [new Float32Array(4 * count), new Float32Array(4 * count)];
    const tangents = new Float64Array(3 * vertices);
    const all = new Float32Array(9 * count);
    for (let rod = 0; rod * vertices < count; rod++) {
      const from = rod * vertices;
      frames(points, from, vertices, rod, axis, tangents, a, b, from);
      for (let i = 0; i < vertices; i++)
        for (let c = 0; c < 3; c++) {
          const at = 9 * (from + i) + c;
          all[at] = a[4 * (from + i) + c];
          all[at + 3] = b[4 * (from + i) + c];
          all[at + 6] = tangents[3 * i + c];
        }
    }
    return all;
  }
}

/** How much narrower a coil of some rise gets that is longer by a factor, its wire as long as before. */
function narrowing(along: number, rise: number): number {
  const sine = Math.min(rise, STRAIGHT);
  return Math.max(Math.sqrt(Math.max(1 - (along * sine) ** 2, 0) / (1 - sine ** 2)), NARROWEST);
}

/** The motion of the head in a step. */
export function headOf({ head }: LiveStep): Matrix4 {
  return new Matrix4().set(...([...head, 0, 0, 0, 1] as Parameters<Matrix4["set"]>));
}

const STILL = 2e-5; // way of a vertex in a step that is not seen [m]

/** Whether two steps are not seen to differ. */
export function sameStep(a: LiveStep, b: LiveStep): boolean {
  const near = (one: ArrayLike<number>, other: ArrayLike<number>) => Array.prototype.every.call(one, (x: number, i) => Math.abs(x - other[i]) < STILL);
  return a.key === b.key && near(a.head, b.head) && near(a.trunk, b.trunk) && near(a.points, b.points);
}

function boxOf(points: Float32Array): Box3 {
  const box = new Box3();
  const place = new Vector3();
  for (let i = 0; i < points.length; i += 3) box.expandByPoint(place.fromArray(points, i));
  return box;
}
