// A number, or a value that varies, as a setting: a slider, and text with its unit.

import { h, iconButton } from "../dom";
import { at, type File, type Model, type Place } from "../model";
import type { Json } from "../protocol";
import { Field, type MakeInner } from "./field";
import { Fold } from "./fold";
import { NumberInput } from "./number";
import type { Typed } from "./quantity";
import { type Range, rounded, sliderRange } from "./range";
import type { Setting } from "./schema";
import { Slider } from "./slider";
import { shownAs } from "./units";

export class NumberField extends Field {
  private readonly slider: Slider;
  private readonly number: NumberInput;
  /** The range of usual values; another serves only while the value is outside of it. */
  private usual: Range | null = null;
  private range: Range = { least: 0, most: 1, step: 0.01 };
  private more: HTMLElement | null = null;
  private readonly folds: { fold: Fold; settings: Setting[] }[] = [];

  constructor(model: Model, file: File, place: Place, setting: Setting, inner: MakeInner) {
    super(model, file, place, setting);
    this.slider = new Slider({ "aria-label": setting.label, title: setting.description }, (value, resting) =>
      this.give({ value: rounded(value, this.range.step / 10), unit: "" }, resting),
    );
    this.number = new NumberInput({
      label: setting.label,
      id: this.id,
      optional: setting.optional,
      put: (typed, resting) => this.give(typed, resting),
    });
    this.number.scrubbedBy(this.label);
    if (setting.name === "seed")
      this.number.element.append(
        iconButton("dice", "New seed", () => this.send(Math.floor(Math.random() * 1e6), true)),
      );
    this.element.append(this.head(this.number.element), this.slider.element);
    if (!setting.inner.length) return;
    for (const [label, ramps] of [
      ["along the hair", true],
      ["varies", false],
    ] as const) {
      const settings = setting.inner.filter(({ kind }) => (kind === "ramp") === ramps);
      const fields = () => settings.map((one) => inner([...place, one.name], one));
      if (settings.length) this.folds.push({ fold: new Fold("varies", label, fields), settings });
    }
    this.more = h("div", { class: "folds" }, ...this.folds.map(({ fold }) => fold.element));
    this.element.append(this.more);
  }

  /** The locks whose own value this is; empty: it is that of all. */
  private get locks(): string[] {
    return this.setting.perLock ? this.model.locks.map(String) : [];
  }

  protected override get targets(): Place[] {
    const { locks } = this;
    return locks.length ? locks.map((lock) => [...this.place, "lock", lock]) : [this.place];
  }

  private get valuePlaces(): Place[] {
    if (this.locks.length) return this.targets;
    const said = this.said;
    return [said !== null && typeof said === "object" ? [...this.place, "value"] : this.place];
  }

  private get shown() {
    const said = this.model.said(this.file, this.valuePlaces[0]);
    return shownAs(this.setting.unit, said, String(this.model.value(this.file, ["unit"]) ?? "m"), this.setting.si);
  }

  private give(typed: Typed | null, resting: boolean): void {
    if (typed && !resting) this.number.set(typed.value);
    const value = typed === null ? null : this.shown.write(typed.value, typed.unit);
    this.put(
      this.valuePlaces.map((place): [Place, Json] => [place, value]),
      resting,
    );
  }

  /** The value in SI; absent where neither the file nor a default has one. */
  private get number_(): number | undefined {
    const own = this.locks.length ? at(this.value, ["lock", this.locks[0]]) : undefined;
    const absent = this.setting.optional ? undefined : this.fallback; // where the file has not even its table
    const value = own ?? (this.setting.varied ? at(this.value, ["value"]) : this.value) ?? absent;
    return typeof value === "number" ? value : undefined;
  }

  private get fallback(): Json | undefined {
    return this.setting.varied ? at(this.setting.fallback, ["value"]) : this.setting.fallback;
  }

  protected show(): void {
    for (const { fold, settings } of this.folds) {
      const said = settings.some(({ name }) => this.model.said(this.file, [...this.place, name]) !== undefined);
      fold.element.classList.toggle("said", said);
      fold.update();
    }
    this.more?.toggleAttribute("hidden", this.locks.length > 0);
    if (this.slider.held) return;
    const { factor, unit } = this.shown;
    const value = this.number_;
    const fallback = typeof this.fallback === "number" ? this.fallback * factor : 0;
    const shown = value === undefined ? (fallback || 1) : value * factor;
    this.element.classList.toggle("absent", value === undefined);
    this.fit(shown, fallback, factor, unit);
    this.slider.set(value === undefined ? this.range.least : shown, this.range);
    this.number.set(value === undefined ? null : rounded(shown, this.range.step / 10));
  }

  private fit(shown: number, fallback: number, factor: number, unit: string): void {
    if (!this.usual || this.element.dataset["unit"] !== unit) this.usual = sliderRange(this.setting, shown, fallback, factor);
    this.element.dataset["unit"] = unit;
    const { usual, setting } = this;
    const within = shown >= usual.least && shown <= usual.most;
    this.range = within ? usual : sliderRange(setting, shown, fallback, factor);
    const part = !setting.unit && setting.most <= 1;
    this.number.describe(
      { unit, whole: setting.kind === "integer", part },
      [setting.least * factor, setting.most * factor],
      this.range.step,
    );
  }
}
