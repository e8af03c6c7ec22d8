// A table of settings, or a list of such tables, each of which opens.

import { h, iconButton } from "../dom";
import type { File, Model, Place } from "../model";
import type { Json } from "../protocol";
import { Field, type MakeInner } from "./field";
import { Fold } from "./fold";
import type { Setting } from "./schema";

export class TableField extends Field {
  private readonly box = h("div", { class: "tables" });
  private entries: Fold[] = [];

  constructor(model: Model, file: File, place: Place, setting: Setting, private readonly inner: MakeInner) {
    super(model, file, place, setting);
    const add = this.isList
      ? iconButton("plus", `Add to ${setting.label}`, () => this.send([...this.tables, this.fresh()], true))
      : undefined;
    this.element.append(this.head(add), this.box);
  }

  private get isList(): boolean {
    return this.setting.kind === "list";
  }

  /** The tables that the file has. */
  private get tables(): Json[] {
    return (this.said as Json[] | undefined) ?? [];
  }

  private fresh(): Json {
    const vector = this.setting.inner.find((one) => one.kind === "vector");
    return vector ? { [vector.name]: [0, 0.4, 1] } : {};
  }

  protected show(): void {
    const count = this.isList ? ((this.value as Json[] | undefined) ?? []).length : 1;
    if (count !== this.entries.length) {
      this.entries = Array.from({ length: count }, (_, k) => this.entry(k));
      this.box.replaceChildren(...this.entries.map(({ element }) => element));
    }
    for (const fold of this.entries) fold.update();
  }

  private entry(k: number): Fold {
    const title = this.isList ? `${this.setting.label} ${k + 1}` : this.setting.label;
    const place = this.isList ? [...this.place, k] : this.place;
    const fields = () => this.setting.inner.map((one) => this.inner([...place, one.name], one));
    const remove = h("button", { type: "button", class: "quiet", onclick: () => this.take(k) }, `Remove ${title}`);
    return new Fold("table", title, fields, this.isList ? remove : undefined);
  }

  private take(index: number): void {
    this.send(
      this.tables.filter((_, k) => k !== index),
      true,
    );
  }
}

