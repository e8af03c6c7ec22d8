// The settings of the stage that is chosen: what its file says, the most used and the pinned ones; the others on demand.

import "./settings.css";
import { h } from "../dom";
import type { Model } from "../model";
import type { Field } from "./field";
import { makeField } from "./make_field";
import { FieldTools, isPinned, pin } from "./pins";
import { Schemas } from "./schema";
import { SettingSearch } from "./search";

const FEW = 5; // settings that are shown of a stage in any case; its schema begins with the most used
const FULL = 6; // settings that are shown with their sliders below their names; more get one line each

export class Settings {
  readonly element = h("aside", { class: "panel settings", "aria-label": "Settings" });
  private readonly more = h("button", { type: "button", class: "quiet more" });
  private readonly search: SettingSearch;
  private fields: Field[] = [];
  private readonly tools = new Map<Field, FieldTools>();
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
    model.on("role", () => this.element.toggleAttribute("inert", !model.role.leads));
    this.more.addEventListener("click", () => {
      if (!this.opened.delete(this.stage)) this.opened.add(this.stage);
      this.sift();
    });
  }

  private get stage(): string {
    const { file, place } = this.model.chosen;
    return `${file}:${place.join("/")}`;
  }

  /** The operator or the table, by its name in the file. */
  private get kind(): string {
    const { file, place } = this.model.chosen;
    return String(this.model.value(file, [...place, "op"]) ?? (place[0] || file));
  }

  update(): void {
    const { welcome, chosen, documents } = this.model;
    const document = documents[chosen.file];
    this.element.toggleAttribute("hidden", !document);
    if (!welcome || !document) return;
    const values = this.model.value(chosen.file, chosen.place) ?? null;
    const schemas = new Schemas(welcome.schemas[chosen.file] as ConstructorParameters<typeof Schemas>[0]);
    const locks = chosen.file === "recipe" ? this.model.locks : [];
    const settings = schemas.settings(chosen.place, values).filter((setting) => !locks.length || setting.perLock);
    const built = JSON.stringify([chosen, locks, settings.map((setting) => [setting.name, setting.kind])]);
    if (built !== this.built) {
      if (this.built) this.element.scrollTop = 0; // which lays the page out
      this.built = built;
      this.kept.clear();
      this.unfolded.clear();
      this.fields = settings.map((setting) =>
        makeField(this.model, chosen.file, [...chosen.place, setting.name], setting),
      );
      this.tools.clear();
      for (const field of this.fields) this.tools.set(field, this.makeTools(field));
      const nothing = locks.length > 0 && !settings.length;
      const of = locks.length === 1 ? "the selected lock" : `${locks.length} locks`;
      this.element.replaceChildren(
        this.search.input,
        this.search.results,
        h("h2", {}, stageTitle(this.model)),
        locks.length ? h("p", { class: "alone" }, `of ${of} alone`) : "",
        nothing ? h("p", { class: "hint" }, "This stage has no setting that can vary by lock.") : "",
        h("div", { class: "fields" }, ...this.fields.map((field) => field.element)),
        this.more,
      );
    }
    this.sift();
  }

  private makeTools(field: Field): FieldTools {
    const { name } = field.setting;
    return new FieldTools(
      field,
      () => {
        pin(this.kind, name, !isPinned(this.kind, name));
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
    const all = this.opened.has(this.stage) || this.fields.length <= FEW + 1;
    let shown = 0;
    this.fields.forEach((field, k) => {
      const { name } = field.setting;
      if (field.isSaid || field.isWrong) this.kept.add(name);
      const pinned = isPinned(this.kind, name);
      this.tools.get(field)!.showPinned(pinned);
      const visible = all || k < FEW || pinned || this.kept.has(name);
      field.element.toggleAttribute("hidden", this.search.on || !visible);
      if (!visible) return;
      field.update();
      shown++;
    });
    for (const [field, tools] of this.tools) tools.showFold(shown > FULL, this.unfolded.has(field.setting.name));
    const hidden = this.fields.length - shown;
    this.more.toggleAttribute("hidden", this.search.on || this.fields.length <= FEW + 1 || (!hidden && !all));
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
  if (!place.length) return file === "recipe" ? "recipe" : "shot";
  if (file === "shot" && place[0] === "strands") return "Hair material";
  const op = model.said(file, [...place, "op"]);
  return String(op ?? place[0]).replaceAll("_", " ");
}
