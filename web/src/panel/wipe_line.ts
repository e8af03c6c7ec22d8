// The line between two pictures that share a place, dragged or moved by the arrow keys.

import "./wipe_line.css";
import { h } from "../dom";

const STEP = 0.02; // of an arrow key

export class WipeLine {
  readonly element: HTMLElement;
  private at = 0.5;

  /** moved: hears the fraction of the width of the element around the line. */
  constructor(
    label: string,
    private readonly moved: (at: number) => void,
  ) {
    this.element = h("div", {
      class: "wipe-line",
      role: "slider",
      tabindex: 0,
      "aria-label": label,
      "aria-valuemin": 0,
      "aria-valuemax": 100,
    });
    const { element } = this;
    let held = false;
    element.addEventListener("pointerdown", (event) => {
      held = true;
      element.setPointerCapture(event.pointerId);
    });
    element.addEventListener("pointermove", (event) => {
      const box = element.parentElement!.getBoundingClientRect();
      if (held) this.moved(inside((event.clientX - box.left) / box.width));
    });
    for (const name of ["pointerup", "pointercancel"] as const) element.addEventListener(name, () => (held = false));
    element.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -STEP, ArrowRight: STEP }[event.key];
      if (!by) return;
      event.preventDefault();
      event.stopPropagation();
      this.moved(inside(this.at + by));
    });
  }

  place(at: number): void {
    this.at = at;
    this.element.style.left = `clamp(12px, ${100 * at}%, calc(100% - 12px))`;
    this.element.setAttribute("aria-valuenow", String(Math.round(100 * at)));
  }
}

function inside(at: number): number {
  return Math.min(1, Math.max(0, at));
}
