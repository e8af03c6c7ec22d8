// Settings that one control of the browser edits: a switch, a choice, a text, a color; and what none edits.

import { h } from "../dom";
import type { File, Model, Place } from "../model";
import { Field } from "./field";
import type { Setting } from "./schema";

export class ToggleField extends Field {
  private readonly box = h("input", { type: "checkbox", id: this.id, role: "switch", class: "switch" });

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    this.element.append(this.head(this.box));
    this.box.addEventListener("change", () => this.send(this.box.checked, true));
  }

  protected show(): void {
    this.box.checked = Boolean(this.value);
  }
}

export class ChoiceField extends Field {
  private readonly list = h("select", { id: this.id });

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    if (setting.optional) this.list.append(h("option", { value: "" }, "none"));
    for (const choice of setting.choices) this.list.append(h("option", { value: choice }, choice.replaceAll("_", " ")));
    this.element.append(this.head(this.list));
    this.list.addEventListener("change", () => this.send(this.list.value || null, true));
  }

  protected show(): void {
    this.list.value = String(this.value ?? "");
  }
}

export class TextField extends Field {
  private readonly input = h("input", { type: "text", id: this.id, spellcheck: "false" });

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    this.element.append(this.head(), this.input);
    this.input.addEventListener("change", () =>
      this.send(this.input.value || (this.setting.optional ? null : ""), true),
    );
  }

  protected show(): void {
    if (document.activeElement !== this.input) this.input.value = String(this.value ?? "");
  }
}

/** A colour; while it is chosen, the hair shows it. */
export class ColorField extends Field {
  private readonly input = h("input", { type: "color", id: this.id });

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    this.element.append(this.head(this.input));
    this.input.addEventListener("input", () => this.send(this.input.value, false));
    this.input.addEventListener("change", () => this.send(this.input.value, true));
  }

  protected show(): void {
    this.input.value = String(this.value ?? this.setting.fallback ?? "#000000");
  }
}

export class OtherField extends Field {
  private readonly readout = h("code", { class: "hint" });

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    this.element.append(this.head(), this.readout);
  }

  protected show(): void {
    this.readout.textContent = this.value === undefined || this.value === null ? "–" : JSON.stringify(this.value);
  }
}

