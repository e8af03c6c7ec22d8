// A slider that says when the hand rests: at release, also where the value ends as it began.

import { h } from "../dom";
import type { Range } from "./range";

export class Slider {
  readonly element: HTMLInputElement;
  private moving = false;
  private key = false;

  /** moved: called while it moves, and once more with `resting` when the hand lets go. */
  constructor(attributes: Record<string, unknown>, moved: (value: number, resting: boolean) => void) {
    this.element = h("input", { type: "range", ...attributes });
    this.element.addEventListener("input", () => {
      this.moving = true;
      this.paint();
      moved(this.value, false);
    });
    const rest = (event: Event) => {
      if (event.type === "keyup") this.key = false;
      if (!this.moving || (this.key && event.type !== "blur")) return;
      this.moving = false;
      moved(this.value, true);
    };
    // `change` does not fire where a drag ends at the value that it began with. It comes after pointerup where it does.
    this.element.addEventListener("keydown", () => {
      this.key = true; // a key that is held moves on; the hand rests when it comes up
    });
    for (const name of ["change", "pointerup", "pointercancel", "keyup", "blur"]) this.element.addEventListener(name, rest);
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
      this.element.min = String(range.least);
      this.element.max = String(range.most);
      this.element.step = String(range.step);
    }
    this.element.value = String(value);
    this.paint();
  }

  private paint(): void {
    const { min, max } = this.element;
    const part = (this.value - Number(min)) / (Number(max) - Number(min) || 1);
    this.element.style.setProperty("--part", `${100 * part}%`);
  }
}
