// Locks as tubes: light meets a lock as such, in which hairs shade one another.

import type { Hairs } from "../protocol";

export class Tubes {
  /** Of each lock: its hairs, the sum of their widths [m], mean squares of their offsets, wanders and roots [m²], and of their slips about its coil. */
  private readonly number: Float64Array;
  private readonly widths: Float64Array;
  private readonly offsets: Float64Array;
  private readonly wanders: Float64Array;
  private readonly roots: Float64Array;
  private readonly slips: Float64Array;

  constructor({ points, knots, escaping, opening, ...hairs }: Hairs) {
    const { count, lock, group, offset, taper, width, frizz, root, slip, coil } = hairs;
    const locks = lock.reduce((most, one) => Math.max(most, one + 1), 0);
    const made = Array.from({ length: 6 }, () => new Float64Array(locks));
    const [number, widths, offsets, wanders, roots, slips] = made;
    const [away, wound] = [escaping, opening].map((ramp) => meanSquares(ramp, points));
    for (let i = 0; i < count; i++) {
      const [l, g] = [lock[i], group[i]];
      number[l]++;
      widths[l] += width[i];
      offsets[l] += square(offset, 2 * i, 2) * (1 - 0.5 * taper[i]) ** 2;
      wanders[l] += square(frizz, 2 * knots * i, 2 * knots) / knots;
      roots[l] += square(root, 3 * i, 3);
      if (!slip.length) continue;
      wanders[l] += square(hairs.escape, 2 * i, 2) * away[g] + square(coil, 4 * i, 2) * wound[g];
      for (let k = 0; k < knots; k++) slips[l] += (2 - 2 * Math.cos(2 * Math.PI * slip[knots * i + k])) / knots;
    }
    for (let l = 0; l < locks; l++) for (const of of [offsets, wanders, roots, slips]) of[l] /= Math.max(number[l], 1);
    [this.number, this.widths, this.offsets, this.wanders, this.roots, this.slips] = made;
  }

  /** Of each lock: the widths of the hairs next to each of it, and the mean squares of offsets, which follow the profile, of
   * what does not, and of roots.
   *
   * radii: mean square radius of each lock's coil [m²]
   */
  measure(radii: ArrayLike<number>): Float32Array {
    const result = new Float32Array(4 * this.number.length);
    for (let l = 0; l < this.number.length; l++) {
      const widths = this.widths[l] * (1 - 1 / Math.max(this.number[l], 1));
      result.set([widths, this.offsets[l], this.wanders[l] + this.slips[l] * (radii[l] ?? 0), this.roots[l]], 4 * l);
    }
    return result;
  }
}

function square(values: Float32Array, from: number, count: number): number {
  let sum = 0;
  for (let i = from; i < from + count; i++) sum += values[i] ** 2;
  return sum;
}

/** Mean square of a ramp of each groom, which has so many points. */
function meanSquares(ramp: Float32Array, points: number): number[] {
  return Array.from({ length: ramp.length / points }, (_, k) => square(ramp, k * points, points) / points);
}
