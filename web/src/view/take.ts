// A take of live hair: some seconds of its rods, each step as it was sent when it moved. See python/ringlet/viewer/show/live_take.py.

import { Matrix4, Vector3 } from "three";
import type { LiveTake } from "../protocol";
import type { Pose } from "./body";
import { Rods } from "./rods";

export class Take {
  readonly rods: Rods;

  constructor(readonly message: LiveTake) {
    const { pivot, points, along, axis, rise, ids, carrier } = message;
    this.rods = new Rods({ kind: "rods", side: "a", key: 0, pivot, points, along, axis, rise, ids, carrier });
  }

  /** How many steps it takes, with those that were left out. */
  get length(): number {
    return this.message.steps.at(-1)! + 1;
  }

  /** Hair and head in a step, or in the last one before it that is there. */
  at(step: number): { points: Float32Array; pose: Pose; worn: Float32Array } {
    const { steps, heads, trunks, moved, worn, points, pivot } = this.message;
    const later = steps.findIndex((one) => one > step);
    const row = Math.max(0, (later < 0 ? steps.length : later) - 1);
    const head = new Matrix4().set(...([...heads.subarray(12 * row, 12 * row + 12), 0, 0, 0, 1] as Parameters<Matrix4["set"]>));
    const part = (parts: Int16Array) => parts.subarray((row * parts.length) / steps.length, ((row + 1) * parts.length) / steps.length);
    const trunk = new Vector3().fromArray(trunks, 3 * row);
    return { points: this.place(part(moved), head, points), pose: { head, trunk, pivot: new Vector3(...pivot) }, worn: this.place(part(worn), head) };
  }

  /** Points that are so many parts away in the frame of the head, from where they were groomed. */
  private place(parts: Int16Array, head: Matrix4, groomed?: Float32Array): Float32Array {
    const { unit } = this.message;
    const { elements: m } = head;
    const placed = new Float32Array(parts.length);
    for (let i = 0; i < parts.length; i += 3) {
      const [x, y, z] = [0, 1, 2].map((c) => (groomed ? groomed[i + c] : 0) + unit * parts[i + c]);
      for (let c = 0; c < 3; c++) placed[i + c] = m[c] * x + m[4 + c] * y + m[8 + c] * z + m[12 + c];
    }
    return placed;
  }
}
