// A ramp along the hair as a setting.

import type { File, Model, Place } from "../model";
import { Field } from "./field";
import type { Setting } from "./schema";
import { type Ramp, RampEditor } from "./ramp";

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

