// One setting as a control. What the file does not say shows its default, more quietly.

import "./field.css";
import { h, iconButton } from "../dom";
import type { File, Model, Place } from "../model";
import type { Json } from "../protocol";
import type { Setting } from "./schema";

/** Makes the control of a setting inside another. */
export type MakeInner = (place: Place, setting: Setting) => Field;

let named = 0;

export abstract class Field {
  readonly element: HTMLElement;
  protected readonly id = `setting-${named++}`;
  protected readonly label: HTMLElement;
  private readonly reset: HTMLElement;
  private gesture = 0;
  private sending = 0;
  private waiting: [Place, Json][] | null = null;

  constructor(
    protected readonly model: Model,
    protected readonly file: File,
    protected readonly place: Place,
    readonly setting: Setting,
  ) {
    const about = setting.description ? `${setting.name}: ${setting.description}` : setting.name;
    this.label = h("label", { for: this.id, title: about }, setting.label);
    this.reset = iconButton(
      "reset",
      `Reset ${setting.label} to its default`,
      () => this.put(this.targets.map((target) => [target, null])),
      { class: "icon-button reset" },
    );
    this.element = h("div", { class: `field field-${setting.kind}`, "data-setting": place.join(".") });
  }

  protected head(extra?: Node): HTMLElement {
    return h("div", { class: "field-head" }, this.label, this.reset, extra);
  }

  protected get said(): Json | undefined {
    return this.model.said(this.file, this.place);
  }

  protected get value(): Json | undefined {
    return this.model.value(this.file, this.place);
  }

  /** What is edited, and may be taken out; several where locks have values of their own. */
  protected get targets(): Place[] {
    return [this.place];
  }

  /** Whether the file says it, or something in it. */
  get isSaid(): boolean {
    return this.targets.some((target) => this.model.said(this.file, target) !== undefined);
  }

  /** Whether a problem names it. */
  get isWrong(): boolean {
    return this.model.isWrong(this.file, this.place);
  }

  /** Shows what the file says now. */
  update(): void {
    this.element.classList.toggle("said", this.isSaid);
    this.element.classList.toggle("wrong", this.isWrong);
    this.reset.toggleAttribute("hidden", !this.isSaid);
    this.show();
  }

  protected abstract show(): void;

  /** Tells the server a value; while a hand moves only as fast as it can take it. */
  protected send(value: Json, resting: boolean, place: Place = this.place): void {
    this.put([[place, value]], resting);
  }

  /** Tells the server several values as one step of undo. */
  protected put(changes: [Place, Json][], resting = true): void {
    if (!this.model.role.leads) {
      this.update(); // shows again what holds
      return;
    }
    if (!this.gesture) this.gesture = this.model.newGesture();
    this.waiting = changes;
    const message = () => {
      this.sending = 0;
      if (!this.waiting) return;
      this.model.say({ kind: "set", file: this.file, changes: this.waiting, gesture: this.gesture, resting });
      this.waiting = null;
    };
    if (resting) {
      cancelAnimationFrame(this.sending);
      message();
      this.gesture = 0;
    } else if (!this.sending) this.sending = requestAnimationFrame(message);
  }
}
