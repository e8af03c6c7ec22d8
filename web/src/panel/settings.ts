// The settings of the stage that is chosen: what its file says, the most used and the pinned ones; the others on demand.
// The first stage has the few of all stages that most meetings need.

import "./settings.css";
import { h } from "../dom";
import type { File, Model, Place } from "../model";
import { fewSettings } from "./aspects";
import type { DockTab } from "./dock";
import type { Field } from "./field";
import { makeField } from "./make_field";
import { FieldTools, isPinned, pin } from "./pins";
import { Schemas, type Setting } from "./schema";
import { SettingSearch } from "./search";

const FEW = 5; // settings that are shown of a stage in any case; its schema begins with the most used
const FULL = 6; // settings that are shown with their sliders below their names; more get one line each

export class Settings {
  readonly element = h("div", { class: "settings" });
  private readonly controls = h("fieldset", { class: "fields", "aria-label": "Settings of the stage" });
  private readonly readOnly = h("p", { class: "hint", hidden: true }, "You can read and search the settings. To change them, ask to edit.");
  readonly tab: DockTab = { title: "Settings", element: this.element, actions: [], offered: () => Object.keys(this.model.documents).length > 0 };
  private readonly more = h("button", { type: "button", class: "quiet more" });
  readonly search: SettingSearch;
  private fields: Field[] = [];
  private few = FEW; // of the fields, those that are shown in any case
  private readonly tools = new Map<Field, FieldTools>();
  private readonly kinds = new Map<Field, string>(); // their tables and operators
  private built = "";
  /** Stages whose settings are all shown. */
  private readonly opened = new Set<string>();
  /** Settings that stay in view, although the file no longer says them, while their stage is. */
  private readonly kept = new Set<string>();
  /** Settings that were opened from one line. */
  private readonly unfolded = new Set<string>();

  constructor(private readonly model: Model) {
    this.search = new SettingSearch(model, (name) => this.reveal(name), () => this.sift());
    for (const topic of ["document", "chosen", "names"] as const) model.on(topic, () => this.update());
    model.on("role", () => this.sift());
    this.more.addEventListener("click", () => {
      if (!this.opened.delete(this.stage)) this.opened.add(this.stage);
      this.sift();
    });
  }

  /** Whether the few settings of all stages are shown. */
  private get first(): boolean {
    const { file, place } = this.model.chosen;
    return file === "recipe" && !place.length;
  }

  private get stage(): string {
    const { file, place } = this.model.chosen;
    return `${file}:${place.join("/")}`;
  }

  /** The operator or the table of a setting, by its name in the file. */
  private kindOf(file: File, place: Place): string {
    const table = place.slice(0, -1);
    return String(this.model.value(file, [...table, "op"]) ?? (table[0] || file));
  }

  /** The settings to show, and how many of them in any case. */
  private listed(): { all: { file: File; place: Place; setting: Setting }[]; few: number } {
    const { welcome, chosen } = this.model;
    const { file, place } = chosen;
    const locks = file === "recipe" ? this.model.locks : [];
    const schemas = new Schemas(welcome!.schemas[file] as ConstructorParameters<typeof Schemas>[0]);
    const own = schemas
      .settings(place, this.model.value(file, place) ?? null)
      .filter((setting) => !locks.length || setting.perLock)
      .map((setting) => ({ file, place: [...place, setting.name], setting }));
    if (!this.first) return { all: own, few: FEW };
    const few = fewSettings(this.model).filter(({ setting }) => !locks.length || setting.perLock);
    return { all: [...few, ...own], few: few.length };
  }

  update(): void {
    const { welcome, chosen, documents } = this.model;
    const document = documents[chosen.file];
    this.element.toggleAttribute("hidden", !document);
    if (!welcome || !document) return;
    const locks = chosen.file === "recipe" ? this.model.locks : [];
    const { all, few } = this.listed();
    this.few = few;
    const built = JSON.stringify([chosen, locks, all.map(({ place, setting }) => [place, setting.kind])]);
    if (built !== this.built) {
      if (this.built) this.element.scrollTop = 0; // which lays the page out
      this.built = built;
      this.kept.clear();
      this.unfolded.clear();
      this.fields = all.map(({ file, place, setting }) => makeField(this.model, file, place, setting));
      this.tools.clear();
      this.kinds.clear();
      this.fields.forEach((field, k) => this.tools.set(field, this.makeTools(field, this.kindOf(all[k].file, all[k].place))));
      this.controls.replaceChildren(...this.fields.map((field) => field.element));
      const nothing = locks.length > 0 && !all.length;
      const of = locks.length === 1 ? "the selected lock" : `${locks.length} locks`;
      this.element.replaceChildren(
        this.search.input,
        this.search.results,
        h("h2", {}, stageTitle(this.model)),
        locks.length ? h("p", { class: "alone" }, `of ${of} alone`) : "",
        nothing ? h("p", { class: "hint" }, "This stage has no setting that can vary by lock.") : "",
        this.readOnly,
        this.controls,
        this.more,
      );
    }
    this.sift();
  }

  private makeTools(field: Field, kind: string): FieldTools {
    const { name } = field.setting;
    this.kinds.set(field, kind);
    return new FieldTools(
      field,
      () => {
        pin(kind, name, !isPinned(kind, name));
        this.sift();
      },
      () => {
        if (!this.unfolded.delete(name)) this.unfolded.add(name);
        this.sift();
      },
    );
  }

  /** Shows the fields of first sight, or all, with what the file says now. */
  private sift(): void {
    this.element.classList.toggle("searching", this.search.on);
    this.element.classList.toggle("few", this.first);
    const all = this.opened.has(this.stage) || this.fields.length <= this.few + 1;
    let shown = 0;
    this.fields.forEach((field, k) => {
      const { name } = field.setting;
      const listed = !this.first || k < this.few; // a file has a name and a unit in any case
      if ((field.isSaid && listed) || field.isWrong) this.kept.add(name);
      const pinned = isPinned(this.kinds.get(field)!, name);
      this.tools.get(field)!.showPinned(pinned);
      const visible = all || k < this.few || pinned || this.kept.has(name);
      field.element.toggleAttribute("hidden", this.search.on || !visible);
      if (!visible) return;
      field.update();
      shown++;
    });
    const { leads } = this.model.role;
    this.controls.disabled = !leads;
    this.readOnly.hidden = leads;
    const lines = leads && shown > Math.max(FULL, this.few); // who cannot press what opens a line sees all of it
    this.fields.forEach((field, k) => this.tools.get(field)!.showFold(lines && !(this.first && k < this.few), this.unfolded.has(field.setting.name)));
    const hidden = this.fields.length - shown;
    this.more.toggleAttribute("hidden", this.search.on || this.fields.length <= this.few + 1 || (!hidden && !all));
    this.more.textContent = all ? "Fewer settings" : `All settings (${hidden} more)`;
    this.more.setAttribute("aria-expanded", String(all));
  }

  /** Shows a setting of the stage that is chosen, opened and in the middle of the panel. */
  private reveal(name: string): void {
    const field = this.fields.find(({ setting }) => setting.name === name);
    if (!field) return;
    this.kept.add(name);
    this.unfolded.add(name);
    this.sift();
    field.element.scrollIntoView({ block: "center" });
    field.element.classList.remove("found");
    void field.element.offsetWidth; // begins the animation again
    field.element.classList.add("found");
    field.element.querySelector<HTMLElement>("input, select, button:not(.pin, .reset)")?.focus();
  }
}

function stageTitle(model: Model): string {
  const { file, place } = model.chosen;
  if (!place.length) return file === "recipe" ? "essentials" : "shot";
  if (file === "shot" && place[0] === "strands") return "Hair material";
  const op = model.said(file, [...place, "op"]);
  return String(op ?? place[0]).replaceAll("_", " ");
}
