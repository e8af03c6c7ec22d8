// A tool in the hand: its panel, and its strokes over the picture while it is on. Sculpting, painting and drawing are such.

import "./hand_tool.css";
import { MOUSE } from "three";
import { h } from "../dom";
import type { Model } from "../model";
import type { Viewer } from "../view/viewer";
import { bindKey } from "./keys";

export abstract class HandTool {
  readonly element: HTMLElement;
  on = false;
  /** Whether it is also for the open look among others that it is compared with. */
  protected readonly amongLooks: boolean = false;
  /** Whom to tell that the tool was taken up or laid down. */
  readonly changed: ((on: boolean) => void)[] = [];
  protected readonly title: HTMLElement;
  protected readonly hair: HTMLInputElement;

  /** name: of its class and ids; ends: what Escape does */
  constructor(
    protected readonly model: Model,
    protected readonly viewer: Viewer,
    name: string,
    label: string,
    ends: string,
  ) {
    this.title = h("h2", {}, label);
    this.element = h("section", { class: `panel brush ${name}`, hidden: true, "aria-label": label }, this.title);
    this.hair = toggle(`${name}-hair`);
    this.hair.addEventListener("change", () => viewer.showHair(this.hair.checked));
    const { element } = viewer;
    element.addEventListener("pointerdown", (event) => this.takes(event) && this.press(event), { capture: true });
    element.addEventListener("pointermove", (event) => this.on && this.move(event), { capture: true });
    for (const end of ["pointerup", "pointercancel"] as const)
      element.addEventListener(end, () => this.lift(), { capture: true });
    bindKey({ section: "Groom", keys: "Escape", does: ends, on: (event) => this.on && event.key === "Escape", run: () => this.show(false) });
    model.on("role", () => this.element.toggleAttribute("inert", !model.role.leads));
  }

  protected abstract press(event: PointerEvent): void;
  protected abstract move(event: PointerEvent): void;
  protected abstract lift(): void;
  /** The tool was taken up or laid down. */
  protected abstract turned(): void;

  /** Takes up the tool, or lays it down. */
  show(on: boolean): void {
    if (!on && !this.on) return;
    this.on = on;
    for (const listener of this.changed) listener(on); // other tools are laid down before this one sets the view
    const { viewer } = this;
    this.element.toggleAttribute("hidden", !on);
    viewer.controls.mouseButtons.RIGHT = on ? MOUSE.ROTATE : MOUSE.PAN;
    viewer.showHair(!on || this.hair.checked);
    viewer.element.classList.toggle("sculpts", on);
    this.turned();
    viewer.invalidate();
  }

  /** Whether a pointer is for the tool; with Alt it turns the head. */
  private takes(event: PointerEvent): boolean {
    return this.on && event.button === 0 && !event.altKey && !onButton(event) && (this.amongLooks || !this.viewer.compared) && this.model.role.leads;
  }

  /** The pointer is the tool's alone until it is lifted. */
  protected hold(event: PointerEvent): void {
    event.stopPropagation();
    event.preventDefault();
    this.viewer.element.setPointerCapture(event.pointerId);
  }

  protected get done(): HTMLElement {
    return h("button", { type: "button", class: "quiet", onclick: () => this.show(false) }, "Done");
  }
}

/** Whether a pointer is on a button over the picture. */
export function onButton(event: PointerEvent): boolean {
  return (event.target as Element).closest("button") !== null;
}

export function row(label: string, input: HTMLElement, more?: HTMLElement): HTMLElement {
  return h("div", { class: "field-head" }, h("label", { for: input.id }, label), input, more);
}

export function toggle(id: string): HTMLInputElement {
  return h("input", { type: "checkbox", role: "switch", class: "switch", id });
}

/** Buttons of which one is chosen. names: each with what it does */
export function choice<Name extends string>(group: string, names: Record<Name, string>, first: Name, chosen: (name: Name) => void): HTMLElement {
  const buttons = (Object.entries(names) as [Name, string][]).map(([name, title]) => {
    const input = h("input", { type: "radio", name: group, value: name, checked: name === first });
    input.addEventListener("change", () => chosen(name));
    return h("label", { class: "choice", title, "data-tool": name }, input, h("span", {}, name));
  });
  return h("div", { class: "choices", role: "radiogroup", "aria-label": "Brush" }, ...buttons);
}
