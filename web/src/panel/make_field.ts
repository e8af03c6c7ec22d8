// Which control edits a setting.

import type { File, Model, Place } from "../model";
import type { Field, MakeInner } from "./field";
import { DrawnField, NameField, RegionsField } from "./name_fields";
import { NumberField } from "./number_field";
import { ChoiceField, ColorField, OtherField, TextField, ToggleField } from "./plain_fields";
import { RampField } from "./ramp_field";
import type { Setting } from "./schema";
import { TableField } from "./table_field";
import { VectorField } from "./vector_field";

export function makeField(model: Model, file: File, place: Place, setting: Setting): Field {
  const { kind } = setting;
  const inner: MakeInner = (at, one) => makeField(model, file, at, one);
  if (kind === "number" || kind === "integer") return new NumberField(model, file, place, setting, inner);
  if (kind === "table" || kind === "list") return new TableField(model, file, place, setting, inner);
  const Kind = {
    ramp: RampField,
    toggle: ToggleField,
    choice: ChoiceField,
    text: TextField,
    color: ColorField,
    name: NameField,
    drawn: DrawnField,
    regions: RegionsField,
    vector: VectorField,
    other: OtherField,
  }[kind];
  return new Kind(model, file, place, setting);
}
