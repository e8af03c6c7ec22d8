// One setting as a control. What the file does not say shows its default, more quietly.

import { h, iconButton } from "../dom";
import type { File, Model, Place } from "../model";
import { at } from "../model";
import type { Json } from "../protocol";
import { type Ramp, RampEditor } from "./ramp";
import { type Range, rounded, sliderRange } from "./range";
import type { Setting } from "./schema";
import { shownAs } from "./units";

let named = 0;

export abstract class Field {
  readonly element: HTMLElement;
  protected readonly id = `setting-${named++}`;
  private readonly reset: HTMLElement;
  private gesture = 0;
  private sending = 0;
  private waiting: Json | undefined;

  constructor(
    protected readonly model: Model,
    protected readonly file: File,
    protected readonly place: Place,
    protected readonly setting: Setting,
  ) {
    this.reset = iconButton(
      "reset",
      `Back to the default of ${setting.label}`,
      () => this.send(null, true, this.target),
      { class: "icon-button reset" },
    );
    this.element = h("div", { class: `field field-${setting.kind}`, "data-setting": place.join(".") });
  }

  protected head(extra?: Node): HTMLElement {
    const label = h("label", { for: this.id, title: this.setting.description }, this.setting.label);
    return h("div", { class: "field-head" }, label, this.reset, extra);
  }

  protected get said(): Json | undefined {
    return this.model.said(this.file, this.place);
  }

  protected get value(): Json | undefined {
    return this.model.value(this.file, this.place);
  }

  /** What is edited, and may be taken out. */
  protected get target(): Place {
    return this.place;
  }

  /** Shows what the file says now. */
  update(): void {
    const said = this.model.said(this.file, this.target) !== undefined;
    this.element.classList.toggle("said", said);
    this.reset.toggleAttribute("hidden", !said);
    this.show();
  }

  protected abstract show(): void;

  /** Tells the server; while a hand moves only as fast as it can take it. */
  protected send(value: Json, resting: boolean, place: Place = this.place): void {
    if (!this.gesture) this.gesture = this.model.newGesture();
    this.waiting = value;
    const message = () => {
      this.sending = 0;
      if (this.waiting === undefined) return;
      const changes: [Place, Json][] = [[place, this.waiting]];
      this.waiting = undefined;
      this.model.say({ kind: "set", file: this.file, changes, gesture: this.gesture, resting });
    };
    if (resting) {
      cancelAnimationFrame(this.sending);
      message();
      this.gesture = 0;
    } else if (!this.sending) this.sending = requestAnimationFrame(message);
  }
}

export class NumberField extends Field {
  private readonly slider: HTMLInputElement;
  private readonly number: HTMLInputElement;
  private readonly unit = h("span", { class: "unit" });
  private range: Range = { least: 0, most: 1, step: 0.01 };
  private held = false;
  private more: HTMLElement[] = [];
  private readonly inner: Field[];

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    const describe = setting.description;
    this.slider = h("input", { type: "range", "aria-label": setting.label, title: describe });
    this.number = h("input", { type: "number", id: this.id, class: "number" });
    const more = this.number.parentElement;
    const box = h("span", { class: "number-box" }, this.number, this.unit);
    if (setting.name === "seed")
      box.append(iconButton("dice", "Another seed", () => this.send(Math.floor(Math.random() * 1e6), true)));
    this.element.append(this.head(box), this.slider);
    if (more) this.element.append(more);
    this.slider.addEventListener("input", () => this.drag(false));
    this.slider.addEventListener("change", () => this.drag(true));
    this.number.addEventListener("change", () => {
      if (this.number.value !== "") this.put(Number(this.number.value), true);
      else if (setting.optional) this.send(null, true);
    });
    this.inner = setting.inner.map((one) => makeField(model, file, [...place, one.name], one));
    if (this.inner.length) {
      const details = h("details", { class: "varies" }, h("summary", {}, "varies"));
      for (const field of this.inner) details.append(field.element);
      const ramp = this.inner.find((field) => field instanceof RampField);
      this.more = ramp ? [ramp.element, details] : [details];
      this.element.append(...this.more);
    }
  }

  /** The lock whose own value this is, if one is chosen. */
  private get lock(): string | null {
    return this.setting.perLock && this.model.lock !== null ? String(this.model.lock) : null;
  }

  protected override get target(): Place {
    return this.lock === null ? this.place : [...this.place, "lock", this.lock];
  }

  private get valuePlace(): Place {
    if (this.lock !== null) return this.target;
    const said = this.said;
    return said !== null && typeof said === "object" ? [...this.place, "value"] : this.place;
  }

  private get shown() {
    const said = this.model.said(this.file, this.valuePlace);
    return shownAs(this.setting.unit, said, String(this.model.value(this.file, ["unit"]) ?? "m"));
  }

  private drag(resting: boolean): void {
    this.held = !resting;
    this.number.value = String(rounded(Number(this.slider.value), this.range.step));
    this.slider.style.setProperty("--part", `${this.part(Number(this.slider.value))}%`);
    this.put(rounded(Number(this.slider.value), this.range.step), resting);
  }

  private put(value: number, resting: boolean): void {
    this.send(this.shown.write(value), resting, this.valuePlace);
  }

  private part(value: number): number {
    return (100 * (value - this.range.least)) / (this.range.most - this.range.least);
  }

  protected show(): void {
    for (const field of this.inner) field.update();
    for (const element of this.more) element.toggleAttribute("hidden", this.lock !== null);
    if (this.held) return;
    const { factor, unit } = this.shown;
    const own = this.lock === null ? undefined : at(this.value, ["lock", this.lock]);
    const given = this.setting.varied ? at(this.setting.fallback, ["value"]) : this.setting.fallback;
    const absent = this.setting.optional ? undefined : given; // where the file has not even its table
    const value = own ?? (this.setting.varied ? at(this.value, ["value"]) : this.value) ?? absent;
    const fallback = typeof given === "number" ? given * factor : 0;
    this.unit.textContent = unit;
    this.element.classList.toggle("absent", typeof value !== "number");
    if (typeof value !== "number") {
      this.number.value = "";
      this.number.placeholder = "–";
      this.setRange(sliderRange(this.setting, fallback || 1, fallback, factor));
      this.slider.value = String(this.range.least);
      this.slider.style.setProperty("--part", "0%");
      return;
    }
    const shown = value * factor;
    if (shown > this.range.most || shown < this.range.least || !this.element.dataset["ranged"])
      this.setRange(sliderRange(this.setting, shown, fallback, factor));
    this.element.dataset["ranged"] = "yes";
    this.slider.value = String(shown);
    const exact = rounded(shown, this.range.step / 10);
    this.number.value = Math.abs(exact) < 1e6 ? String(exact) : exact.toExponential();
    this.slider.style.setProperty("--part", `${this.part(shown)}%`);
  }

  private setRange(range: Range): void {
    this.range = range;
    for (const input of [this.slider, this.number]) input.step = input === this.number ? "any" : String(range.step);
    this.slider.min = String(range.least);
    this.slider.max = String(range.most);
  }
}

export class RampField extends Field {
  private readonly editor: RampEditor;

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    this.editor = new RampEditor(setting.label, (ramp, resting) =>
      this.send(
        ramp.map(([x, y]) => [x, y]),
        resting,
      ),
    );
    this.editor.element.id = this.id;
    this.element.append(this.head(), this.editor.element);
  }

  protected show(): void {
    this.editor.set(
      (this.value ??
        this.setting.fallback ?? [
          [0, 1],
          [1, 1],
        ]) as Ramp,
    );
  }
}

class ToggleField extends Field {
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

class ChoiceField extends Field {
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

class TextField extends Field {
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
class ColorField extends Field {
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

/** The name of something that there is: a region or a map of the scalp, or a helper curve. */
class NameField extends Field {
  private readonly list = h("select", { id: this.id });

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    this.element.append(this.head(this.list));
    this.list.addEventListener("change", () => this.send(this.list.value || null, true));
  }

  protected show(): void {
    const value = String(this.value ?? "");
    offer(this.list, this.model.names[this.setting.named], value, this.setting.optional ? "none" : "choose …");
  }
}

/** The value in named regions of the scalp. */
class RegionsField extends Field {
  private readonly rows = h("div", { class: "regions" });
  private readonly add = h("select", { "aria-label": "Another value in a region" });

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    this.element.append(h("div", { class: "field-head" }, h("span", { class: "label" }, "in a region"), this.add), this.rows);
    this.add.addEventListener("change", () => {
      const value = at(this.model.value(file, place.slice(0, -1)), ["value"]);
      if (this.add.value) this.put(this.add.value, (typeof value === "number" ? value : 1) * this.shown(undefined).factor);
    });
  }

  private shown(said: Json | undefined) {
    return shownAs(this.setting.unit, said, String(this.model.value(this.file, ["unit"]) ?? "m"));
  }

  private put(region: string, value: number | null): void {
    const said = at(this.said, [region]);
    this.send(value === null ? null : this.shown(said).write(rounded(value, 1e-4)), true, [...this.place, region]);
  }

  protected show(): void {
    const values = (this.value ?? {}) as Record<string, number>;
    this.element.toggleAttribute("hidden", !this.model.names.regions.length && !Object.keys(values).length);
    const free = this.model.names.regions.filter((name) => !(name in values));
    offer(this.add, free, "", "add …");
    if (this.rows.contains(document.activeElement)) return;
    this.rows.replaceChildren(
      ...Object.entries(values).map(([region, value]) => {
        const { factor, unit } = this.shown(at(this.said, [region]));
        const input = h("input", { type: "number", step: "any", class: "number", "aria-label": `In ${region}` });
        input.value = String(rounded(value * factor, 1e-4));
        input.addEventListener("change", () => this.put(region, Number(input.value)));
        const box = h("span", { class: "number-box" }, input, h("span", { class: "unit" }, unit));
        const remove = iconButton("bin", `Not another value in ${region}`, () => this.put(region, null));
        return h("div", { class: "field-head" }, h("span", { class: "label" }, region), box, remove);
      }),
    );
  }
}

/** Fills a list with names; what is chosen stays, also where there is nothing of that name. */
function offer(list: HTMLSelectElement, names: string[], chosen: string, none: string): void {
  const all = names.includes(chosen) || !chosen ? names : [...names, chosen];
  list.replaceChildren(h("option", { value: "" }, none), ...all.map((name) => h("option", { value: name }, name)));
  list.value = chosen;
}

class VectorField extends Field {
  private readonly inputs = ["x", "y", "z"].map((axis) =>
    h("input", { type: "number", step: "any", "aria-label": `${this.setting.label} ${axis}` }),
  );

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    this.inputs[0].id = this.id;
    this.element.append(this.head(), h("div", { class: "vector" }, ...this.inputs));
    for (const input of this.inputs)
      input.addEventListener("change", () =>
        this.send(
          this.inputs.map((one) => Number(one.value)),
          true,
        ),
      );
  }

  protected show(): void {
    const values = (this.value ?? []) as number[];
    this.inputs.forEach((input, k) => {
      input.value = values[k] === undefined ? "" : String(rounded(values[k], 1e-6));
    });
  }
}

/** A table of settings, or a list of such tables, each of which opens. */
class TableField extends Field {
  private readonly box = h("div", { class: "tables" });
  private entries: Field[][] = [];

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    const add =
      setting.kind === "list"
        ? iconButton("plus", `Add to ${setting.label}`, () =>
            this.send([...(((this.said as Json[]) ?? []) as Json[]), this.fresh()], true),
          )
        : undefined;
    this.element.append(this.head(add), this.box);
  }

  private fresh(): Json {
    const vector = this.setting.inner.find((one) => one.kind === "vector");
    return vector ? { [vector.name]: [0, 0.4, 1] } : {};
  }

  protected show(): void {
    const count = this.setting.kind === "list" ? ((this.value as Json[] | undefined) ?? []).length : 1;
    if (count !== this.entries.length) {
      this.entries = Array.from({ length: count }, (_, k) =>
        this.setting.inner.map((one) => {
          const place = this.setting.kind === "list" ? [...this.place, k, one.name] : [...this.place, one.name];
          return makeField(this.model, this.file, place, one);
        }),
      );
      this.box.replaceChildren(
        ...this.entries.map((fields, k) => {
          const title = this.setting.kind === "list" ? `${this.setting.label} ${k + 1}` : this.setting.label;
          const details = h("details", { class: "table" }, h("summary", {}, title));
          details.append(...fields.map((field) => field.element));
          if (this.setting.kind === "list")
            details.append(
              h("button", { type: "button", class: "quiet", onclick: () => this.take(k) }, `Remove ${title}`),
            );
          return details;
        }),
      );
    }
    for (const field of this.entries.flat()) field.update();
  }

  private take(index: number): void {
    this.send(
      ((this.said as Json[]) ?? []).filter((_, k) => k !== index),
      true,
    );
  }
}

class OtherField extends Field {
  private readonly readout = h("code", { class: "told" });

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    this.element.append(this.head(), this.readout);
  }

  protected show(): void {
    this.readout.textContent = this.value === undefined || this.value === null ? "–" : JSON.stringify(this.value);
  }
}

export function makeField(model: Model, file: File, place: Place, setting: Setting): Field {
  const Kind = {
    number: NumberField,
    integer: NumberField,
    ramp: RampField,
    toggle: ToggleField,
    choice: ChoiceField,
    text: TextField,
    color: ColorField,
    name: NameField,
    regions: RegionsField,
    vector: VectorField,
    table: TableField,
    list: TableField,
    other: OtherField,
  }[setting.kind];
  return new Kind(model, file, place, setting);
}
