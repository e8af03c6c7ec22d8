// Which looks are in the picture, and where: one alone, up to four next to one another, or two in one place.

import type { Arranged, Hairs } from "../protocol";
import type { Box, Size } from "./box";

/** A look in the picture: that of the open recipe is on side a. */
export type Side = Hairs["side"];

export type Arrangement = Arranged["arrangement"];

const SUBJECT = 0.8; // width of a subject, as a fraction of the height of the picture that frames it
const WORTH = 1.2; // factor by which looks are larger where one more row is worth it
export const MOST_LOOKS = 4;

/** Where a look is drawn. */
export interface Cell {
  side: Side;
  /** What it fills of the canvas. */
  box: Box;
  /** The canvas of its camera, of which the box is a part. */
  canvas: Box;
  /** What panels leave clear of that canvas: the camera aims at the middle of it, and sees its height. */
  clear: Box;
  /** How much nearer than alone it is seen, so that all of it fits what is clear. */
  zoom: number;
}

export class Looks {
  /** The looks in the picture, the first on the left. */
  order: Side[] = ["a"];
  arrangement: Arrangement = "split";
  /** The one that is seen alone. */
  front: Side = "a";
  /** Where the wipe is, as a fraction of the clear width. */
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

  /** The arrangement of several looks, to be shared. */
  get arranged(): Arranged | null {
    const { arrangement, order, front, wipe } = this;
    return this.several ? { arrangement, order: [...order], front, wipe } : null;
  }

  /** Arranges the looks that are here as another page does. */
  arrangeAs({ arrangement, order, front, wipe }: Arranged): void {
    this.arrangement = arrangement;
    this.wipe = wipe;
    this.order.sort((a, b) => order.indexOf(a) - order.indexOf(b));
    if (this.order.includes(front)) this.front = front;
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

  /** The looks that are drawn, and where. clear: what panels leave of the canvas */
  cells(size: Size, clear: Box): Cell[] {
    const all = { x: 0, y: 0, ...size };
    const whole = (side: Side, box: Box = all): Cell => ({ side, box, canvas: all, clear, zoom: 1 });
    if (!this.several) return [whole(this.order[0])];
    if (this.split) return this.grid(all, clear);
    if (this.arrangement === "flip") return [whole(this.front)];
    const [first, second] = this.order;
    if (this.arrangement === "difference") return [whole(first), whole(second)];
    const at = Math.round(clear.x + this.wipe * clear.width);
    return [
      whole(first, { ...all, width: at }),
      whole(second, { ...all, x: at, width: size.width - at }),
    ];
  }

  /** Looks next to one another, in more rows where they are much larger so; those at the border of the canvas reach it. */
  private grid(all: Box, clear: Box): Cell[] {
    const count = this.order.length;
    const plans = Array.from({ length: count }, (_, k) => {
      const columns = count - k;
      const rows = Math.ceil(count / columns);
      const [width, height] = [clear.width / columns, clear.height / rows];
      return { columns, rows, width, height, size: fits({ width, height }) };
    });
    const plan = plans.reduce((best, one) => (one.size > WORTH * best.size ? one : best));
    const subject = Math.min(SUBJECT, clear.width / clear.height);
    return this.order.map((side, k) => {
      const [column, row] = [k % plan.columns, Math.floor(k / plan.columns)];
      const last = k === count - 1 || column === plan.columns - 1;
      const span = last ? plan.columns - column : 1; // the last of an incomplete row fills it
      const mine = {
        x: clear.x + column * plan.width,
        y: clear.y + row * plan.height,
        width: span * plan.width,
        height: plan.height,
      };
      const [x, y] = [column === 0 ? 0 : mine.x, row === 0 ? 0 : mine.y];
      const [toX, toY] = [last ? all.width : mine.x + mine.width, row === plan.rows - 1 ? all.height : mine.y + mine.height];
      const box = { x, y, width: toX - x, height: toY - y };
      return { side, box, canvas: box, clear: mine, zoom: Math.min(1, mine.width / (subject * mine.height)) };
    });
  }
}

/** Height at which a subject fits [pixels]. */
export function fits({ width, height }: Size): number {
  return Math.min(width / SUBJECT, height);
}
