// Hair that goes on from where it is seen while its groom, or what carries it, becomes another.

import { Matrix4, Vector3 } from "three";
import type { Locks } from "../protocol";
import type { Rods } from "./rods";

/** What places the locks that are seen. */
export interface Carried {
  locks: Pick<Locks, "ids" | "offsets">;
  /** Points at rest [m]. */
  points: Float32Array;
  rods: Rods;
  /** Motions of the vertices of rods. */
  motions: Float32Array;
}

const TIME = 0.1; // in which hair goes to its new rest, to 1/e [s]
const OVER = 1e-3; // share that is none
const FLAT = 0.1; // determinant of a motion that cannot be undone

/** What is left of a change after some seconds. */
export function shareLeft(seconds: number): number {
  const share = Math.exp(-seconds / TIME);
  return share < OVER ? 0 : share;
}

/** Where points are seen; ease: how far they are from rest [m], of which a share is left. */
export function seen(carried: Carried, ease: Float32Array | null, share: number): Float32Array {
  const result = new Float32Array(carried.points.length);
  const place = new Vector3();
  each(carried, (at, motion) => {
    place.fromArray(carried.points, at);
    if (ease) place.set(place.x + share * ease[at], place.y + share * ease[at + 1], place.z + share * ease[at + 2]);
    place.applyMatrix4(motion).toArray(result, at);
  });
  return result;
}

/** How far from rest points are so that they are seen where those of the same locks were; none for new locks. */
export function easeFrom(before: Pick<Locks, "ids" | "offsets">, places: Float32Array, now: Carried): Float32Array {
  const rowOf = new Map(Array.from(before.ids, (id, row) => [id, row]));
  const { ids, offsets } = now.locks;
  const from = new Float32Array(now.points.length).fill(NaN);
  for (let lock = 0; lock < ids.length; lock++) {
    const row = rowOf.get(ids[lock]);
    if (row === undefined) continue;
    const [first, last] = [before.offsets[row], before.offsets[row + 1] - 1];
    const points = offsets[lock + 1] - offsets[lock];
    for (let i = 0; i < points; i++) {
      const exact = first + ((last - first) * i) / Math.max(points - 1, 1);
      const below = Math.min(Math.floor(exact), Math.max(last - 1, first));
      const t = exact - below;
      for (let c = 0; c < 3; c++) {
        const [a, b] = [places[3 * below + c], places[3 * Math.min(below + 1, last) + c]];
        from[3 * (offsets[lock] + i) + c] = a + t * (b - a);
      }
    }
  }
  const ease = new Float32Array(now.points.length);
  const place = new Vector3();
  each(now, (at, motion) => {
    if (Number.isNaN(from[at]) || motion.determinant() < FLAT) return;
    place.fromArray(from, at).applyMatrix4(motion.invert());
    for (let c = 0; c < 3; c++) ease[at + c] = place.getComponent(c) - now.points[at + c];
  });
  return ease;
}

/** Each point with the motion that carries it, as in the shader. */
function each({ locks, rods, motions }: Carried, does: (at: number, motion: Matrix4) => void): void {
  const { along } = rods.message;
  const motion = new Matrix4();
  const first = rods.first(locks.ids);
  for (let lock = 0; lock < locks.ids.length; lock++) {
    const [from, to] = [locks.offsets[lock], locks.offsets[lock + 1]];
    let v = 0;
    for (let i = from; i < to; i++) {
      const at = (i - from) / Math.max(to - from - 1, 1);
      while (v < along.length - 2 && at >= along[v + 1]) v++;
      const t = Math.min(1, Math.max(0, (at - along[v]) / (along[v + 1] - along[v])));
      const w = t * t * (3 - 2 * t);
      const a = 12 * (first[lock] + v);
      const m = (k: number) => motions[a + k] + w * (motions[a + 12 + k] - motions[a + k]);
      motion.set(m(0), m(1), m(2), m(3), m(4), m(5), m(6), m(7), m(8), m(9), m(10), m(11), 0, 0, 0, 1);
      does(3 * i, motion);
    }
  }
}
