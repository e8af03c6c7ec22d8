// Which looks are in the picture, and where: one alone, up to four next to one another, or two in one place.

import type { Hairs } from "../protocol";

/** A look in the picture: that of the open recipe is on side a. */
export type Side = Hairs["side"];

export type Arrangement = "split" | "wipe" | "flip" | "difference";

const SUBJECT = 0.8; // width of what is framed, as a part of the height of its cell
export const MOST_LOOKS = 4;

/** Where a look is drawn, from the top left of the picture [pixels]. */
export interface Cell {
  side: Side;
  /** What it fills. */
  box: Box;
  /** What is not covered by panels there: the camera aims at the middle of it. */
  clear: Box;
}

interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** How much of the picture panels cover: on the left, on the right, above and below [pixels]. */
export type Covered = [number, number, number, number];

export class Looks {
  /** The looks in the picture, the first on the left. */
  order: Side[] = ["a"];
  arrangement: Arrangement = "split";
  /** The one that is seen alone. */
  front: Side = "a";
  /** Where the wipe is, as a part of the width. */
  wipe = 0.5;

  get several(): boolean {
    return this.order.length > 1;
  }

  /** Whether looks are next to one another, so that each has a part of the picture. */
  get split(): boolean {
    return this.several && this.arrangement === "split";
  }

  get difference(): boolean {
    return this.several && this.arrangement === "difference";
  }

  add(side: Side): void {
    if (!this.order.includes(side)) this.order.push(side);
  }

  remove(side: Side): void {
    this.order = this.order.filter((one) => one !== side);
    if (!this.order.length) this.order = ["a"];
    if (!this.order.includes(this.front)) this.front = this.order[0];
  }

  /** Exchanges the first two. */
  swap(): void {
    const [first, second, ...rest] = this.order;
    if (second) this.order = [second, first, ...rest];
  }

  /** Shows the next one alone. */
  flip(): void {
    this.front = this.order[(this.order.indexOf(this.front) + 1) % this.order.length];
  }

  /** The looks that are drawn, and where. */
  cells(width: number, height: number, covered: Covered): Cell[] {
    const all = { x: 0, y: 0, width, height };
    const whole = (side: Side, box: Box = all): Cell => ({ side, box, clear: all });
    if (!this.several) return [whole(this.order[0])];
    if (this.split) return this.grid(width, height, covered);
    if (this.arrangement === "flip") return [whole(this.front)];
    const [first, second] = this.order;
    if (this.arrangement === "difference") return [whole(first), whole(second)];
    const at = Math.round(this.wipe * width);
    return [
      whole(first, { ...all, width: at }),
      whole(second, { ...all, x: at, width: width - at }),
    ];
  }

  /** How much nearer than alone a look is seen, so that all of it fits its cell. */
  zoom({ clear }: Cell): number {
    return this.split ? Math.min(1, clear.width / (SUBJECT * clear.height)) : 1;
  }

  /** Rows and columns in which looks are largest; those at the border of the picture reach it. */
  private grid(width: number, height: number, covered: Covered): Cell[] {
    const [left, right] = covered.slice(0, 2).map((pixels) => Math.min(pixels, 0.4 * width));
    const count = this.order.length;
    const plans = Array.from({ length: count }, (_, k) => {
      const columns = k + 1;
      const rows = Math.ceil(count / columns);
      const [top, bottom] = rows > 1 ? covered.slice(2) : [0, 0];
      const [w, h] = [(width - left - right) / columns, (height - top - bottom) / rows];
      return { columns, rows, top, w, h, size: Math.min(w / SUBJECT, h) };
    });
    const plan = plans.reduce((best, one) => (one.size > best.size ? one : best));
    return this.order.map((side, k) => {
      const [column, row] = [k % plan.columns, Math.floor(k / plan.columns)];
      const last = k === count - 1 || column === plan.columns - 1;
      const span = last ? plan.columns - column : 1; // the last of an incomplete row fills it
      const clear = {
        x: left + column * plan.w,
        y: plan.top + row * plan.h,
        width: span * plan.w,
        height: plan.h,
      };
      const x = column === 0 ? 0 : clear.x;
      const y = row === 0 ? 0 : clear.y;
      const [toX, toY] = [last ? width : clear.x + clear.width, row === plan.rows - 1 ? height : clear.y + clear.height];
      return { side, box: { x, y, width: toX - x, height: toY - y }, clear };
    });
  }
}
