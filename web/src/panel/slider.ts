// A slider that says when the hand rests: at release, also where the value ends as it began. A drag changes the value by how
// far it goes, wherever it begins, so that a press makes no jump; with Shift it is ten times finer.

import { h } from "../dom";
import { type Range, rounded } from "./range";

const WHOLE = 300; // least length of a drag over the whole range [pixels]
const STILL = 3; // a pointer that moves less has clicked [pixels]
const FINE = 0.1;

export class Slider {
  readonly element: HTMLInputElement;
  private range: Range = { least: 0, most: 1, step: 0.01 };
  private moving = false;
  private key = false;

  /** moved: called while it moves, and once more with `resting` when the hand lets go. */
  constructor(
    attributes: Record<string, unknown>,
    private readonly moved: (value: number, resting: boolean) => void,
  ) {
    this.element = h("input", { type: "range", step: "any", ...attributes });
    this.element.addEventListener("input", () => this.move());
    const rest = (event: Event) => {
      if (event.type === "keyup") this.key = false;
      if (this.key && event.type !== "blur") return;
      this.rest();
    };
    // `change` does not fire where a drag ends at the value that it began with. It comes after pointerup where it does.
    this.element.addEventListener("keydown", (event) => {
      this.key = true; // a key that is held moves on; the hand rests when it comes up
      const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      this.put(this.value + step * this.range.step * (event.shiftKey ? FINE : 1), event.shiftKey);
    });
    for (const name of ["change", "pointerup", "pointercancel", "keyup", "blur"]) this.element.addEventListener(name, rest);
    this.drags();
  }

  /** Whether a hand moves it. */
  get held(): boolean {
    return this.moving;
  }

  get value(): number {
    return Number(this.element.value);
  }

  set(value: number, range?: Range): void {
    if (range) {
      this.range = range;
      this.element.min = String(range.least);
      this.element.max = String(range.most);
    }
    this.element.value = String(value);
    this.paint();
  }

  /** A mouse or a pen drags from where the value is; a finger, which has no Shift, as the browser does. */
  private drags(): void {
    const { element } = this;
    let [held, far] = [false, false];
    let [x, value] = [0, 0];
    element.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || event.pointerType === "touch" || element.disabled) return;
      event.preventDefault(); // the browser would let the value jump to the pointer
      element.focus();
      element.setPointerCapture(event.pointerId);
      [held, far, x, value] = [true, false, event.clientX, this.value];
    });
    element.addEventListener("pointermove", (event) => {
      if (!held) return;
      const by = event.clientX - x;
      if (!far && Math.abs(by) < STILL) return;
      far = true;
      const { least, most } = this.range;
      value += ((by * (most - least)) / Math.max(WHOLE, element.clientWidth)) * (event.shiftKey ? FINE : 1);
      value = Math.min(most, Math.max(least, value));
      x = event.clientX;
      this.put(value, event.shiftKey);
    });
    element.addEventListener("pointerup", (event) => {
      if (held && !far) this.put(this.under(event.clientX), false);
    }, { capture: true });
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"] as const) element.addEventListener(name, () => (held = false));
  }

  /** The value at a place of the track. */
  private under(x: number): number {
    const { left, width } = this.element.getBoundingClientRect();
    const { least, most } = this.range;
    return width ? least + ((x - left) / width) * (most - least) : this.value;
  }

  private put(value: number, fine: boolean): void {
    const { least, most, step } = this.range;
    const to = fine && !Number.isInteger(step) ? step * FINE : step;
    this.element.value = String(Math.min(most, Math.max(least, rounded(Math.round(value / to) * to, to))));
    this.move();
  }

  private move(): void {
    this.moving = true;
    this.paint();
    this.moved(this.value, false);
  }

  private rest(): void {
    if (!this.moving) return;
    this.moving = false;
    this.moved(this.value, true);
  }

  private paint(): void {
    const { min, max } = this.element;
    const part = (this.value - Number(min)) / (Number(max) - Number(min) || 1);
    this.element.style.setProperty("--part", `${100 * part}%`);
  }
}
