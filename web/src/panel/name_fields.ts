// Settings that name what there is: a region or a map of the scalp, or a helper curve; and values in named regions.

import { h, iconButton } from "../dom";
import { at, type File, type Model, type Place } from "../model";
import type { Json } from "../protocol";
import { Field } from "./field";
import type { Setting } from "./schema";
import { NumberInput } from "./number";
import { rounded } from "./range";
import { shownAs } from "./units";

/** The name of something that there is: a region or a map of the scalp, or a helper curve. */
export class NameField extends Field {
  private readonly list = h("select", { id: this.id });

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    const label = place.filter((part) => part !== "map").join(" ").replaceAll("_", " ");
    const makes = {
      maps: () => iconButton("brush", `Paint ${label} on the scalp`, () => model.paint(place, label)),
      curves: () => iconButton("pen", `Draw ${label} on the scalp`, () => model.draw(place, label)),
      regions: () => null,
      vectors: () => iconButton("brush", `Comb ${label} on the scalp`, () => model.paint(place, label)),
    }[setting.named];
    const tool = file === "recipe" ? makes() : null;
    this.element.append(this.head(h("span", { class: "number-box" }, this.list, tool)));
    this.list.addEventListener("change", () => this.send(this.list.value || null, true));
  }

  protected show(): void {
    const value = String(this.value ?? "");
    offer(this.list, this.model.names[this.setting.named], value, this.setting.optional ? "none" : "choose …");
  }
}

/** A list of helper curves, each drawn on the head; one that is taken out leaves its curve in the recipe. */
export class DrawnField extends Field {
  private readonly rows = h("div", { class: "regions" });

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    const draw = h("button", { type: "button", class: "quiet", onclick: () => model.draw(place, "a guide") }, "Draw a guide");
    this.element.append(this.head(draw), this.rows);
  }

  protected show(): void {
    const names = (this.value ?? []) as string[];
    this.rows.replaceChildren(
      ...names.map((name) => {
        const without = names.filter((one) => one !== name);
        const remove = iconButton("bin", `Remove ${name}`, () => this.send(without.length ? without : null, true));
        return h("div", { class: "field-head" }, h("span", { class: "label" }, name.replaceAll("_", " ")), remove);
      }),
    );
  }
}

/** The value in named regions of the scalp. */
export class RegionsField extends Field {
  private readonly rows = h("div", { class: "regions" });
  private readonly add = h("select", { "aria-label": "Add a value for a region" });

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    this.element.append(h("div", { class: "field-head" }, h("span", { class: "label" }, "in a region"), this.add), this.rows);
    this.add.addEventListener("change", () => {
      const value = at(this.model.value(file, place.slice(0, -1)), ["value"]);
      const { factor, write } = this.shown(undefined);
      if (this.add.value) this.give(this.add.value, write(rounded((typeof value === "number" ? value : 1) * factor, 1e-4)));
    });
  }

  private shown(said: Json | undefined) {
    return shownAs(this.setting.unit, said, String(this.model.value(this.file, ["unit"]) ?? "m"), this.setting.si);
  }

  private give(region: string, value: Json, resting = true): void {
    this.send(value, resting, [...this.place, region]);
  }

  protected show(): void {
    const values = (this.value ?? {}) as Record<string, number>;
    this.element.toggleAttribute("hidden", !this.model.names.regions.length && !Object.keys(values).length);
    const free = this.model.names.regions.filter((name) => !(name in values));
    offer(this.add, free, "", "add …");
    if (this.rows.contains(document.activeElement)) return;
    this.rows.replaceChildren(
      ...Object.entries(values).map(([region, value]) => {
        const { factor, unit, write } = this.shown(at(this.said, [region]));
        const number = new NumberInput({
          label: `In ${region}`,
          put: (typed, resting) => typed && this.give(region, write(typed.value, typed.unit), resting),
        });
        const { least, most } = this.setting;
        number.describe({ unit, whole: false, part: !unit && most <= 1 }, [least * factor, most * factor], 0.01);
        number.set(value * factor);
        const label = h("span", { class: "label" }, region);
        number.scrubbedBy(label);
        const remove = iconButton("bin", `Remove the value for ${region}`, () => this.give(region, null));
        return h("div", { class: "field-head" }, label, number.element, remove);
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

