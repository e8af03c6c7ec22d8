// A direction or a place as a setting: three numbers.

import { h } from "../dom";
import type { File, Model, Place } from "../model";
import { Field } from "./field";
import { NumberInput } from "./number";
import type { Setting } from "./schema";

export class VectorField extends Field {
  private readonly inputs: NumberInput[];

  constructor(model: Model, file: File, place: Place, setting: Setting) {
    super(model, file, place, setting);
    this.inputs = ["x", "y", "z"].map(
      (axis, k) =>
        new NumberInput({
          label: `${setting.label} ${axis}`,
          put: (typed, resting) => typed && this.send(this.numbers.with(k, typed.value), resting),
        }),
    );
    for (const input of this.inputs)
      input.describe({ unit: "", whole: false, part: false }, [Number.NEGATIVE_INFINITY, Number.POSITIVE_INFINITY], 0.05);
    this.inputs[0].input.id = this.id;
    this.element.append(this.head(), h("div", { class: "vector" }, ...this.inputs.map((input) => input.element)));
  }

  private get numbers(): number[] {
    const values = (this.value ?? []) as number[];
    return [0, 1, 2].map((k) => values[k] ?? 0);
  }

  protected show(): void {
    const values = (this.value ?? []) as number[];
    this.inputs.forEach((input, k) => input.set(values[k] ?? null));
  }
}
