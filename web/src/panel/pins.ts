// Settings that are pinned: they are at first sight of their stage, whatever the file says. And the buttons of a setting
// in its panel: to pin it, and to open the one line that it has among many.

import { iconButton } from "../dom";
import type { Field } from "./field";

const STORE = "ringlet-pins";

function stored(): string[] {
  try {
    return JSON.parse(localStorage.getItem(STORE) ?? "[]") as string[];
  } catch {
    return [];
  }
}

/** stage: name of the operator or table, not its place in the file */
export function isPinned(stage: string, setting: string): boolean {
  return stored().includes(`${stage}.${setting}`);
}

export function pin(stage: string, setting: string, on: boolean): void {
  const name = `${stage}.${setting}`;
  const others = stored().filter((one) => one !== name);
  localStorage.setItem(STORE, JSON.stringify(on ? [...others, name] : others));
}

export class FieldTools {
  private readonly pin: HTMLElement;
  private readonly unfold: HTMLElement;

  constructor(
    private readonly field: Field,
    onPin: () => void,
    onUnfold: () => void,
  ) {
    const head = field.element.querySelector<HTMLElement>(".field-head")!;
    this.pin = iconButton("pin", "Pin", onPin, { class: "icon-button pin" });
    this.unfold = iconButton("down", `All of ${field.setting.label}`, onUnfold, { class: "icon-button unfold" });
    head.firstElementChild!.after(this.pin);
    head.append(this.unfold);
  }

  showPinned(on: boolean): void {
    const { label } = this.field.setting;
    this.pin.title = on ? `Unpin ${label}` : `Pin ${label}: always show it`;
    this.pin.setAttribute("aria-label", this.pin.title);
    this.pin.setAttribute("aria-pressed", String(on));
  }

  /** Shows the setting in full, or in one line that opens. */
  showFold(line: boolean, open: boolean): void {
    this.field.element.classList.toggle("line", line && !open);
    this.field.element.classList.toggle("unfolded", line && open);
    this.unfold.setAttribute("aria-expanded", String(open));
  }
}
