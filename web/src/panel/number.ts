// A number with its unit: text that takes arithmetic and units. The label scrubs it.

import "./number.css";
import { h } from "../dom";
import { parseQuantity, Refusal, type Kind, type Typed } from "./quantity";
import { rounded } from "./range";

const PIXELS = 3; // that a pointer moves for one step while it scrubs
const STILL = 3; // a pointer that moves less has clicked [pixels]

export interface NumberOptions {
  label: string;
  id?: string;
  /** A number was typed or scrubbed; null where the field was emptied. */
  put: (typed: Typed | null, resting: boolean) => void;
  /** Whether it may be empty. */
  optional?: boolean;
}

export class NumberInput {
  readonly element: HTMLElement;
  readonly input: HTMLInputElement;
  private readonly unit = h("span", { class: "unit" });
  private readonly refusal = h("p", { class: "refusal", role: "alert", hidden: true });
  private kind: Kind = { unit: "", whole: false, part: false };
  private bounds: [number, number] = [Number.NEGATIVE_INFINITY, Number.POSITIVE_INFINITY];
  private step = 0.01;
  private value: number | null = null;

  constructor(private readonly options: NumberOptions) {
    const { id, label } = options;
    this.input = h("input", { type: "text", inputmode: "decimal", class: "number", autocomplete: "off", spellcheck: "false", id });
    if (!id) this.input.setAttribute("aria-label", label);
    this.element = h("span", { class: "number-box" }, this.input, this.unit, this.refusal);
    this.input.addEventListener("change", () => this.read());
    this.input.addEventListener("blur", () => this.refusal.hidden && this.write());
    this.input.addEventListener("focus", () => this.input.select());
    this.input.addEventListener("keydown", (event) => this.key(event));
  }

  /** What the field holds. bounds and step are in the unit that is shown. */
  describe(kind: Kind, bounds: [number, number], step: number): void {
    this.kind = kind;
    this.bounds = bounds;
    this.step = step;
    this.unit.textContent = kind.unit;
  }

  /** Shows a value; what is being typed or was refused stays. */
  set(value: number | null, placeholder = "–"): void {
    const changed = value !== this.value;
    this.value = value;
    this.input.placeholder = placeholder;
    if (document.activeElement === this.input && !changed) return;
    if (!this.refusal.hidden && !changed) return;
    this.write();
  }

  /** Drags on an element change the value: a step every few pixels, a tenth of it with Shift. */
  scrubbedBy(handle: HTMLElement): void {
    handle.classList.add("scrubs");
    let [x, start, scrubbed] = [0, 0, 0];
    let [held, moved] = [false, false];
    handle.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || this.value === null) return;
      [x, start, scrubbed] = [event.clientX, this.value, this.value];
      [held, moved] = [true, false];
      handle.setPointerCapture(event.pointerId);
    });
    handle.addEventListener("pointermove", (event) => {
      if (!held) return;
      const by = event.clientX - x;
      if (!moved && Math.abs(by) < STILL) return;
      moved = true;
      scrubbed = this.stepped(start, Math.round(by / PIXELS), event.shiftKey);
      this.scrub(scrubbed, false);
    });
    // Answers to earlier moves arrive during the drag and set the value: what was scrubbed last counts.
    const release = () => {
      if (held && moved) this.scrub(scrubbed, true);
      held = false;
    };
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"] as const) handle.addEventListener(name, release);
    handle.addEventListener("click", (event) => moved && event.preventDefault());
  }

  /** A value that many steps further, within the bounds. */
  private stepped(from: number, steps: number, fine: boolean): number {
    const step = this.kind.whole ? 1 : fine ? this.step / 10 : this.step;
    const [least, most] = this.bounds;
    return Math.min(most, Math.max(least, rounded(from + steps * step, step)));
  }

  private scrub(value: number, resting: boolean): void {
    this.value = value;
    this.write();
    this.options.put({ value, unit: "" }, resting);
  }

  private read(): void {
    const text = this.input.value;
    try {
      if (!text.trim()) {
        if (!this.options.optional) throw new Refusal("a number is missing");
        this.refuse("");
        this.options.put(null, true);
        return;
      }
      const typed = parseQuantity(text, this.kind, this.value);
      const [least, most] = this.bounds;
      const { unit } = this.kind;
      if (typed.value < least) throw new Refusal(`at least ${shown(least)}${unit && ` ${unit}`}`);
      if (typed.value > most) throw new Refusal(`at most ${shown(most)}${unit && ` ${unit}`}`);
      this.refuse("");
      this.value = typed.value;
      this.write();
      this.options.put(typed, true);
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      this.refuse(error.message);
    }
  }

  private refuse(why: string): void {
    this.refusal.textContent = why;
    this.refusal.hidden = !why;
    if (why) this.input.setAttribute("aria-invalid", "true");
    else this.input.removeAttribute("aria-invalid");
  }

  private write(): void {
    this.refuse("");
    this.input.value = this.value === null ? "" : shown(this.value);
  }

  private key(event: KeyboardEvent): void {
    if (event.key === "Escape") {
      this.write();
      this.input.select();
      event.stopPropagation();
    } else if ((event.key === "ArrowUp" || event.key === "ArrowDown") && this.value !== null) {
      this.scrub(this.stepped(this.value, event.key === "ArrowUp" ? 1 : -1, event.shiftKey), true);
      event.preventDefault();
    }
  }
}

/** A number as it is shown: seven digits, and powers of ten where it would be longer than its field. */
export function shown(x: number): string {
  const tidy = Number(x.toPrecision(7));
  return Math.abs(tidy) < 1e9 && (tidy === 0 || Math.abs(tidy) >= 1e-6) ? String(tidy) : tidy.toExponential();
}
