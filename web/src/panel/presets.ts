// Looks and presets with pictures: pointed at, one is shown; clicked, it is taken; a slider takes a part of it.

import "./presets.css";
import { h } from "../dom";
import type { Model } from "../model";
import type { Preset } from "../protocol";
import type { Viewer } from "../view/viewer";
import { openDialog } from "./dialog";
import { bindKey } from "./keys";
import { Slider } from "./slider";

const AFTER = 160; // time that a pointer rests on a preset before it is shown [ms]
const PICTURE = [160, 178] as const; // of a preset that is kept [pixels]
const TABLES = ["guides", "locks", "shape", "curl", "hairs", "color", "fiber", "pin", "collide"];

export class PresetTool {
  /** Whom to tell that it is opened. */
  opened = (): void => {};
  readonly element = h("section", { class: "panel presets", hidden: true, "aria-label": "Looks and presets" });
  private readonly cards = h("div", { class: "preset-groups" });
  private readonly mixing = h("div", { class: "field mixing", hidden: true });
  private readonly part = new Slider({ id: "preset-part" }, (part, resting) => this.mix(part, resting));
  private readonly readout = h("output", { class: "unit", for: "preset-part" });
  private readonly label = h("label", { for: "preset-part" });
  private timer = 0;
  private tried = "";
  private taken = "";
  private gesture = 0;
  private sending = 0;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
  ) {
    this.mixing.append(h("div", { class: "field-head" }, this.label, this.readout), this.part.element);
    this.element.append(
      h("h2", {}, "Looks and presets"),
      this.cards,
      this.mixing,
      h(
        "div",
        { class: "group" },
        h("button", { type: "button", class: "quiet", onclick: () => this.keep() }, "Keep a preset…"),
        h("button", { type: "button", class: "quiet", onclick: () => this.show(false) }, "Done"),
      ),
    );
    const closes = (event: KeyboardEvent) => !this.element.hidden && event.key === "Escape";
    bindKey({ section: "Groom", keys: "Escape", does: "close looks and presets", on: closes, run: () => this.show(false) });
    model.on("presets", () => this.fill());
    model.on("role", () => this.element.toggleAttribute("inert", !model.role.leads));
    model.on("document", () => this.update());
  }

  /** Opens the panel, or closes it. */
  show(on: boolean): void {
    if (on) this.opened();
    this.element.toggleAttribute("hidden", !on);
    if (on) this.model.say({ kind: "list_presets" });
    else this.leave(0);
  }

  private update(): void {
    if (!this.model.documents.recipe) this.show(false);
  }

  private fill(): void {
    const groups = new Map<string, Preset[]>();
    for (const preset of this.model.presets) {
      const group = !preset.whole ? "Of this project" : preset.name.startsWith("types/") ? "Curl types" : "Looks";
      groups.set(group, [...(groups.get(group) ?? []), preset]);
    }
    this.cards.replaceChildren(
      ...[...groups].flatMap(([title, presets]) => [h("h3", {}, title), h("div", { class: "preset-cards" }, ...presets.map((one) => this.card(one)))]),
    );
    this.mark();
  }

  private card(preset: Preset): HTMLElement {
    const picture = preset.picture
      ? h("img", { src: preset.picture, alt: "", loading: "lazy" })
      : h("span", { class: "no-picture", "aria-hidden": "true" }, preset.title.slice(0, 2));
    const card = h("button", { type: "button", class: "preset", title: preset.about, "data-preset": preset.name }, picture, h("span", {}, preset.title));
    card.addEventListener("pointerenter", (event) => event.pointerType !== "touch" && this.point(preset.name));
    card.addEventListener("pointerleave", () => this.leave(AFTER));
    card.addEventListener("focus", () => card.matches(":focus-visible") && this.point(preset.name));
    card.addEventListener("blur", () => this.leave(AFTER));
    card.addEventListener("click", () => this.take(preset));
    return card;
  }

  /** Shows a preset once the pointer has rested on it. */
  private point(name: string): void {
    clearTimeout(this.timer);
    if (name === this.taken) return;
    this.timer = window.setTimeout(() => {
      this.tried = name;
      this.model.say({ kind: "try", name });
    }, AFTER);
  }

  /** Shows the groom as it was, unless another preset is pointed at. */
  private leave(after: number): void {
    clearTimeout(this.timer);
    if (!this.tried) return;
    this.timer = window.setTimeout(() => {
      this.tried = "";
      this.model.say({ kind: "try", name: "" });
    }, after);
  }

  private take(preset: Preset): void {
    clearTimeout(this.timer);
    this.tried = "";
    this.taken = preset.name;
    this.gesture = this.model.newGesture();
    this.part.set(1, { least: 0, most: 1, step: 0.01 });
    this.label.textContent = `amount of ‘${preset.title}’`;
    this.say(1, true);
    this.mark();
  }

  private mix(part: number, resting: boolean): void {
    cancelAnimationFrame(this.sending);
    if (resting) this.say(part, true);
    else this.sending = requestAnimationFrame(() => this.say(part, false));
  }

  private say(part: number, resting: boolean): void {
    this.readout.textContent = `${Math.round(100 * part)} %`;
    this.model.say({ kind: "take", name: this.taken, part, gesture: this.gesture, resting });
  }

  private mark(): void {
    this.mixing.toggleAttribute("hidden", !this.taken);
    for (const card of this.cards.querySelectorAll<HTMLElement>(".preset"))
      card.setAttribute("aria-pressed", String(card.dataset["preset"] === this.taken));
  }

  /** Asks for a name and for what is kept of the recipe, and keeps it with a picture of what is seen. */
  private keep(): void {
    const values = this.model.documents.recipe?.values ?? {};
    const name = h("input", { id: "preset-name", required: true, autocomplete: "off", spellcheck: "false" });
    const boxes = TABLES.filter((table) => values[table] && String(values[table]) !== "").map((table) => {
      const box = h("input", { type: "checkbox", class: "switch", role: "switch", id: `preset-${table}`, name: table, checked: table === this.model.chosen.place[0] });
      return h("div", { class: "field-head" }, h("label", { for: box.id }, table), box);
    });
    const form = h("form", { class: "save-form" }, h("label", { for: name.id }, "Name"), name, h("p", {}, "Tables in the preset"), ...boxes, h("button", { class: "primary" }, "Keep"));
    const dialog = openDialog("Keep a preset", form);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const tables = [...form.querySelectorAll<HTMLInputElement>("input:checked")].map((box) => box.name);
      const picture = this.viewer.drawAt(...PICTURE, false).toDataURL("image/jpeg", 0.82);
      this.model.say({ kind: "keep", name: name.value.trim(), tables, picture });
      dialog.close();
    });
  }
}
