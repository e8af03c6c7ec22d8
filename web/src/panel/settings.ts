// The settings of the stage that is chosen: what its file says and the first few, the others on demand or by search.

import { h } from "../dom";
import type { Model } from "../model";
import type { Field } from "./field";
import { makeField } from "./make_field";
import { Schemas } from "./schema";

const FEW = 5; // settings that are shown of a stage in any case; its schema begins with the most used

export class Settings {
  readonly element = h("aside", { class: "panel settings", "aria-label": "Settings" });
  private readonly search = h("input", {
    type: "search",
    class: "search",
    placeholder: "Search settings",
    "aria-label": "Search settings",
    autocomplete: "off",
  });
  private readonly more = h("button", { type: "button", class: "quiet more" });
  private fields: Field[] = [];
  private built = "";
  /** Stages whose settings are all shown. */
  private readonly opened = new Set<string>();
  /** Settings that stay in view, although the file no longer says them, while their stage is. */
  private readonly kept = new Set<string>();

  constructor(private readonly model: Model) {
    for (const topic of ["document", "chosen", "role", "names"] as const) model.on(topic, () => this.update());
    this.search.addEventListener("input", () => this.sift());
    this.more.addEventListener("click", () => {
      if (!this.opened.delete(this.stage)) this.opened.add(this.stage);
      this.sift();
    });
  }

  private get stage(): string {
    const { file, place } = this.model.chosen;
    return `${file}:${place.join("/")}`;
  }

  update(): void {
    const { welcome, chosen, documents, role } = this.model;
    const document = documents[chosen.file];
    this.element.toggleAttribute("hidden", !document);
    if (!welcome || !document) return;
    const values = this.model.value(chosen.file, chosen.place) ?? null;
    const schemas = new Schemas(welcome.schemas[chosen.file] as ConstructorParameters<typeof Schemas>[0]);
    const locks = chosen.file === "recipe" ? this.model.locks : [];
    const settings = schemas.settings(chosen.place, values).filter((setting) => !locks.length || setting.perLock);
    const built = JSON.stringify([chosen, locks, settings.map((setting) => [setting.name, setting.kind])]);
    if (built !== this.built) {
      this.built = built;
      this.kept.clear();
      this.search.value = "";
      this.fields = settings.map((setting) =>
        makeField(this.model, chosen.file, [...chosen.place, setting.name], setting),
      );
      const nothing = locks.length > 0 && !settings.length;
      const of = locks.length === 1 ? `lock ${locks[0]}` : `${locks.length} locks`;
      this.element.replaceChildren(
        h("h2", {}, stageTitle(this.model)),
        locks.length ? h("p", { class: "alone" }, `of ${of} alone`) : "",
        nothing ? h("p", { class: "told" }, "No setting of this stage can differ for a single lock.") : "",
        settings.length > FEW ? this.search : "",
        h("div", { class: "fields" }, ...this.fields.map((field) => field.element)),
        this.more,
      );
      this.element.scrollTop = 0;
    }
    for (const field of this.fields) field.update();
    this.element.toggleAttribute("inert", !role.leads);
    this.sift();
  }

  /** Shows the fields that are looked for, or those of first sight. */
  private sift(): void {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const all = this.opened.has(this.stage) || this.fields.length <= FEW + 2;
    let hidden = 0;
    this.fields.forEach((field, k) => {
      const { name, label, description } = field.setting;
      if (field.isSaid || field.element.classList.contains("wrong")) this.kept.add(name);
      const text = `${name} ${label} ${description}`.toLowerCase();
      const shown = words.length ? words.every((word) => text.includes(word)) : all || k < FEW || this.kept.has(name);
      field.element.toggleAttribute("hidden", !shown);
      if (!shown) hidden++;
    });
    this.more.toggleAttribute("hidden", words.length > 0 || this.fields.length <= FEW + 2 || (!hidden && !all));
    this.more.textContent = all ? "Show fewer settings" : `Show all settings (${hidden} more)`;
    this.more.setAttribute("aria-expanded", String(all));
  }
}

function stageTitle(model: Model): string {
  const { file, place } = model.chosen;
  if (!place.length) return file === "recipe" ? "recipe" : "shot";
  if (file === "shot" && place[0] === "strands") return "Hair material";
  const op = model.said(file, [...place, "op"]);
  return String(op ?? place[0]).replaceAll("_", " ");
}
