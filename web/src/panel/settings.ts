// The settings of the stage that is chosen.

import { h } from "../dom";
import type { Model } from "../model";
import { type Field, makeField } from "./field";
import { Schemas } from "./schema";

export class Settings {
  readonly element = h("aside", { class: "panel settings", "aria-label": "Settings" });
  private fields: Field[] = [];
  private built = "";

  constructor(private readonly model: Model) {
    model.on("document", () => this.update());
    model.on("chosen", () => this.update());
    model.on("role", () => this.update());
    model.on("names", () => this.update());
  }

  update(): void {
    const { welcome, chosen, documents, role } = this.model;
    const document = documents[chosen.file];
    this.element.toggleAttribute("hidden", !document);
    if (!welcome || !document) return;
    const values = this.model.value(chosen.file, chosen.place) ?? null;
    const schemas = new Schemas(welcome.schemas[chosen.file] as ConstructorParameters<typeof Schemas>[0]);
    const alone = chosen.file === "recipe" ? this.model.lock : null;
    const settings = schemas.settings(chosen.place, values).filter((setting) => alone === null || setting.perLock);
    const built = JSON.stringify([chosen, alone, settings.map((setting) => [setting.name, setting.kind])]);
    if (built !== this.built) {
      this.built = built;
      this.fields = settings.map((setting) =>
        makeField(this.model, chosen.file, [...chosen.place, setting.name], setting),
      );
      const title = stageTitle(this.model);
      const nothing = alone !== null && !settings.length;
      this.element.replaceChildren(
        h("h2", {}, title),
        alone === null ? "" : h("p", { class: "alone" }, `of lock ${alone} alone`),
        nothing ? h("p", { class: "told" }, "Nothing here can be another for a single lock.") : "",
        h("div", { class: "fields" }, ...this.fields.map((field) => field.element)),
      );
    }
    for (const field of this.fields) field.update();
    this.element.toggleAttribute("inert", !role.leads);
  }
}

function stageTitle(model: Model): string {
  const { file, place } = model.chosen;
  if (!place.length) return file === "recipe" ? "recipe" : "shot";
  const op = model.said(file, [...place, "op"]);
  return String(op ?? place[0]).replaceAll("_", " ");
}
