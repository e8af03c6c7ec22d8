import { expect, test } from "vitest";
import type { Hairs } from "../src/protocol";
import { Tubes } from "../src/view/tubes";

const [HAIRS, WIDTH, RADIUS] = [60, 7e-5, 1.5e-3]; // of a lock: number, diameter and radius [m]

/** Numbers from 0 to 1 that look random, the same each time. */
function* numbers(): Generator<number, never> {
  for (let k = 1; ; k++) yield (k * 0.618033988749895) % 1;
}

/** One lock of parallel hairs, evenly distributed in a disk. */
function lock(slip = 0): Hairs {
  const [angle, part] = [numbers(), numbers()];
  for (let k = 0; k < 7; k++) part.next();
  const offset = new Float32Array(2 * HAIRS);
  for (let i = 0; i < HAIRS; i++) {
    const [turn, out] = [2 * Math.PI * angle.next().value, RADIUS * Math.sqrt((i + part.next().value) / HAIRS)];
    offset.set([out * Math.cos(turn), out * Math.sin(turn)], 2 * i);
  }
  const even = (count: number, value: number) => new Float32Array(count).fill(value);
  const curled = slip ? HAIRS : 0;
  return {
    count: HAIRS, points: 2, knots: 2, lock: new Uint32Array(HAIRS), group: new Uint8Array(HAIRS), offset, taper: even(HAIRS, 0), width: even(HAIRS, WIDTH),
    frizz: even(4 * HAIRS, 0), profile: even(2, 1), thinning: even(2, 1), escaping: even(2, 1), escape: even(2 * curled, 0), opening: even(2, 1), coil: even(4 * curled, 0), root: even(3 * HAIRS, 0), slip: even(2 * curled, slip),
  } as unknown as Hairs;
}

/** The clumping index of the first lock, as in the shaders. */
function clumping(hairs: Hairs, radii: number[]): number {
  const [widths, offsets, wanders] = new Tubes(hairs).measure(radii);
  const depth = widths / Math.sqrt(8 * (offsets + wanders));
  return depth ? -Math.expm1(-depth) / depth : 1;
}

test("hairs of a lock take away as much light as the shadow of the lock is wide", () => {
  const { offset } = lock();
  let [shadow, directions] = [0, 90];
  for (let d = 0; d < directions; d++) {
    const [x, y] = [Math.cos((Math.PI * d) / directions), Math.sin((Math.PI * d) / directions)];
    const places = Array.from({ length: HAIRS }, (_, i) => x * offset[2 * i] + y * offset[2 * i + 1]).sort((a, b) => a - b);
    let end = -Infinity;
    for (const place of places) {
      shadow += (place + WIDTH / 2 - Math.max(end, place - WIDTH / 2)) / directions;
      end = place + WIDTH / 2;
    }
  }
  const index = clumping(lock(), []);
  expect(index).toBeLessThan(0.6); // they cover one another
  expect(Math.abs(index / (shadow / (HAIRS * WIDTH)) - 1)).toBeLessThan(0.06);
});

test("hairs that slip around the coil of their lock shade each other less, and a single hair nothing", () => {
  const [coiled, slipped] = [lock(), lock(0.25)].map((hairs) => clumping(hairs, [16e-6]));
  expect(slipped).toBeGreaterThan(coiled + 0.2);
  expect(clumping({ ...lock(), count: 1 }, [])).toBe(1);
});
