// Which control edits a setting.

import type { File, Model, Place } from "../model";
import type { Field } from "./field";
import { DrawnField, NameField, RegionsField } from "./name_fields";
import { NumberField } from "./number_field";
import { ChoiceField, ColorField, OtherField, TextField, ToggleField } from "./plain_fields";
import { RampField } from "./ramp_field";
import type { Setting } from "./schema";
import { TableField } from "./table_field";
import { VectorField } from "./vector_field";

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
    drawn: DrawnField,
    regions: RegionsField,
    vector: VectorField,
    table: TableField,
    list: TableField,
    other: OtherField,
  }[setting.kind];
  return new Kind(model, file, place, setting);
}
