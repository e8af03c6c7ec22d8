// Settings within a setting, which are made when they are opened.

import { h } from "../dom";
import type { Field } from "./field";

export class Fold {
  readonly element: HTMLDetailsElement;
  private fields: Field[] = [];

  /** kind: class of its element; last: what follows the fields */
  constructor(
    kind: string,
    label: string,
    private readonly make: () => Field[],
    last?: HTMLElement,
  ) {
    this.element = h("details", { class: kind }, h("summary", {}, label), last);
    this.element.addEventListener("toggle", () => this.update());
  }

  /** Shows what the file says now, if it is open. */
  update(): void {
    if (!this.element.open) return;
    if (!this.fields.length) {
      this.fields = this.make();
      this.element.firstElementChild!.after(...this.fields.map(({ element }) => element));
    }
    for (const field of this.fields) field.update();
  }
}
