// The clumping index of hairs: light meets a lock as a tube, and hairs behind others in it take little away (Nilson 1971).

import type { Hairs } from "../protocol";

export class Clumps {
  /** Of each lock: its hairs, the sum of their widths [m], mean squares of their offsets [m²] and of their slips about its coil. */
  private readonly number: Float64Array;
  private readonly widths: Float64Array;
  private readonly offsets: Float64Array;
  private readonly slips: Float64Array;

  constructor(private readonly hairs: Hairs) {
    const { count, lock, group, offset, taper, width, frizz, slip } = hairs;
    const locks = lock.reduce((most, one) => Math.max(most, one + 1), 0);
    const [number, widths, offsets, slips] = Array.from({ length: 4 }, () => new Float64Array(locks));
    const means = (ramp: Float32Array, power: number) => meansOf(ramp, hairs.points, power);
    const [thin, spread, away] = [means(hairs.thinning, 1), means(hairs.profile, 2), means(hairs.escaping, 2)];
    const knots = 2 * hairs.knots;
    for (let i = 0; i < count; i++) {
      const [l, g] = [lock[i], group[i]];
      number[l]++;
      widths[l] += width[i] * thin[g];
      offsets[l] += square(offset, 2 * i, 2) * spread[g] * (1 - 0.5 * taper[i]) ** 2 + (2 * square(frizz, knots * i, knots)) / knots;
      if (!slip.length) continue;
      offsets[l] += square(hairs.escape, 2 * i, 2) * away[g];
      for (let k = 0; k < hairs.knots; k++) slips[l] += (2 - 2 * Math.cos(2 * Math.PI * slip[hairs.knots * i + k])) / hairs.knots;
    }
    for (let l = 0; l < locks; l++) for (const of of [offsets, slips]) of[l] /= Math.max(number[l], 1);
    [this.number, this.widths, this.offsets, this.slips] = [number, widths, offsets, slips];
  }

  /** The factor on the extinction of each hair in the tube of its lock, (1 - e^-τ) / τ.
   *
   * τ is the optical depth of the tube: the widths of its hairs by its own width, that of a disk with the mean square of
   * their distances from the lock. Tubes finer than a voxel let more light pass than hairs in no order.
   * radii: mean square radius of each lock's coil [m²]
   */
  indices(radii: ArrayLike<number>): Float32Array {
    const ofLocks = this.widths.map((widths, l) => {
      const depth = widths / Math.max(Math.sqrt(8 * (this.offsets[l] + this.slips[l] * (radii[l] ?? 0))), 1e-6);
      return this.number[l] < 2 || depth < 1e-3 ? 1 : -Math.expm1(-depth) / depth;
    });
    const result = new Float32Array(this.hairs.count);
    for (let i = 0; i < result.length; i++) result[i] = ofLocks[this.hairs.lock[i]];
    return result;
  }
}

function square(values: Float32Array, from: number, count: number): number {
  let sum = 0;
  for (let i = from; i < from + count; i++) sum += values[i] ** 2;
  return sum;
}

/** Mean of a power of a ramp of each groom, which has so many points. */
function meansOf(ramp: Float32Array, points: number, power: number): number[] {
  return Array.from({ length: ramp.length / points }, (_, k) => {
    let sum = 0;
    for (let i = k * points; i < (k + 1) * points; i++) sum += ramp[i] ** power;
    return sum / points;
  });
}
