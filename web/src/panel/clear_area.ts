// What panels leave clear of the picture, measured: the subject is in the middle of it, and what is laid over the
// picture goes by it, as CSS variables.

import type { Box } from "../view/box";
import { fits } from "../view/looks";

const SMALL = 900; // width of a window in which what floats over the picture would cover the subject [pixels]
const GAP = 14; // between a panel and what is next to it [pixels]

export class ClearArea {
  private box = "";

  /**
   * above, below: bars at the edges; over: bars at the top of the picture; sides: panels in columns on both sides
   */
  constructor(
    private readonly above: HTMLElement[],
    private readonly over: HTMLElement[],
    private readonly sides: HTMLElement[],
    private readonly below: HTMLElement[],
    private readonly changed: (clear: Box) => void,
  ) {
    const observer = new ResizeObserver(() => this.measure());
    for (const element of [document.documentElement, ...above, ...over, ...sides, ...below]) observer.observe(element);
  }

  /** Whether panels are where they were measured last. */
  get settled(): boolean {
    return JSON.stringify(this.clear()) === this.box;
  }

  private measure(): void {
    const { innerWidth, innerHeight } = window;
    const { style } = document.documentElement;
    style.setProperty("--below", `${innerHeight - this.bottom + GAP / 2}px`);
    const clear = this.clear();
    style.setProperty("--left", `${clear.x}px`);
    style.setProperty("--right", `${innerWidth - clear.x - clear.width}px`);
    style.setProperty("--over", `${this.largest(this.bottom).y}px`);
    style.setProperty("--top", `${clear.y}px`);
    style.setProperty("--bottom", `${innerHeight - clear.y - clear.height}px`);
    const now = JSON.stringify(clear);
    if (now === this.box) return;
    this.box = now;
    this.changed(clear);
  }

  /** Upper edge of the bars at the bottom. */
  private get bottom(): number {
    return Math.min(window.innerHeight, ...this.below.flatMap(seen).map(({ top }) => top - GAP / 2));
  }

  private clear(): Box {
    const clear = this.largest(this.bottom);
    if (window.innerWidth <= SMALL)
      for (const { height } of this.over.flatMap(seen)) {
        clear.y += Math.round(height + GAP);
        clear.height = Math.max(clear.height - Math.round(height + GAP), 1);
      }
    return clear;
  }

  /** The largest rectangle above a line that is between the columns, or below one of them or both. */
  private largest(bottom: number): Box {
    const { innerWidth } = window;
    const top = Math.max(0, ...this.above.flatMap(seen).map(({ bottom }) => bottom));
    let [left, right] = [0, innerWidth];
    let [underLeft, underRight] = [top, top];
    for (const box of this.sides.flatMap(seen)) {
      if (box.width > 0.5 * innerWidth) bottom = Math.min(bottom, box.top - GAP / 2);
      else if (box.left + box.right < innerWidth) {
        left = Math.max(left, box.right + GAP);
        underLeft = Math.max(underLeft, box.bottom + GAP / 2);
      } else {
        right = Math.min(right, box.left - GAP);
        underRight = Math.max(underRight, box.bottom + GAP / 2);
      }
    }
    const between = (x: number, y: number, end: number): Box => ({
      x: Math.round(x),
      y: Math.round(y),
      width: Math.max(Math.round(end - x), 1),
      height: Math.max(Math.round(bottom - y), 1),
    });
    const places = [
      between(left, top, right),
      between(left, underRight, innerWidth),
      between(0, underLeft, right),
      between(0, Math.max(underLeft, underRight), innerWidth),
    ];
    return places.reduce((best, one) => (fits(one) > fits(best) ? one : best));
  }
}

/** The box of an element, if it is seen; of what is scrolled within its parent, the part that is in sight. */
function seen(element: HTMLElement): DOMRect[] {
  const box = element.getBoundingClientRect();
  if (!box.width || !box.height) return [];
  const parent = element.parentElement;
  if (!parent || parent.scrollHeight <= parent.clientHeight) return [box];
  const { top, bottom } = parent.getBoundingClientRect();
  const [from, to] = [Math.max(box.top, top), Math.min(box.bottom, bottom)];
  return to > from ? [new DOMRect(box.left, from, box.width, to - from)] : [];
}
