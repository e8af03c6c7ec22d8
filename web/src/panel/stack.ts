// The stages of the groom from guides to hairs: choose, mute, solo, move, add and remove.

import "./stack.css";
import { h, ICONS, icon, iconButton } from "../dom";
import type { Model, Place } from "../model";
import type { Json, Stage } from "../protocol";
import { chooseNames } from "./choose";
import { Schemas } from "./schema";

/** A cloth or a collider of a shot. */
type Entry = Record<"name" | "mesh" | "file", string | null>;

const KEPT = ["guides", "locks", "hairs", "color", "fiber"]; // what has no effect to be muted

export class Stack {
  readonly element = h("nav", { class: "panel stack", "aria-label": "Stages of the groom" });

  constructor(
    private readonly model: Model,
    private readonly openPresets: () => void,
  ) {
    model.on("document", () => this.update());
    model.on("chosen", () => this.update());
    model.on("role", () => this.update());
    new ResizeObserver(() => this.element.querySelector(".chosen")?.scrollIntoView({ block: "nearest" })).observe(this.element); // a tool takes its room
  }

  update(): void {
    const document = this.model.documents.recipe;
    const shot = this.model.documents.shot;
    this.element.toggleAttribute("hidden", !document && !shot);
    const parts: HTMLElement[] = [];
    if (document) {
      if (document.grooms.length) parts.push(this.grooms(document.grooms, document.groom));
      else if (this.model.role.leads) parts.push(h("button", { type: "button", class: "quiet looks-open", "data-stage": "looks", onclick: this.openPresets }, "Looks and presets…"));
      parts.push(h("h2", {}, "groom"), this.row({ name: "essentials", op: "", place: [], muted: false, solo: false }, document.stages));
      parts.push(...document.stages.map((stage) => this.row(stage, document.stages)), this.adding());
    }
    if (shot) {
      parts.push(h("h2", {}, "shot"), this.shotRow("shot", []));
      for (const name of ["strands", "motion", "variation", "solver", "forces", "contact"])
        if (shot.values[name]) parts.push(this.shotRow(name, [name]));
      for (const kind of ["cloth", "collider"])
        for (const [k, entry] of ((shot.values[kind] ?? []) as Json[] as Entry[]).entries())
          parts.push(this.shotRow(entryName(entry) || kind, [kind, k]));
    }
    this.element.replaceChildren(...parts);
    this.element.classList.toggle("follows", !this.model.role.leads);
  }

  private row(stage: Stage, all: Stage[]): HTMLElement {
    const key = stage.place.join("/");
    const { chosen, role } = this.model;
    const isShape = stage.place[0] === "shape";
    const index = Number(stage.place[1]);
    const last = all.filter((one) => one.place[0] === "shape").length - 1;
    const current = chosen.file === "recipe" && chosen.place.join("/") === key;
    const choose = h(
      "button",
      {
        type: "button",
        class: "stage-name",
        "data-stage": key || "recipe",
        "aria-current": current ? "true" : undefined,
        onclick: () => this.model.choose("recipe", stage.place),
      },
      stage.name.replaceAll("_", " "),
    );
    const canMute = key && !KEPT.includes(key) && role.leads;
    return h(
      "div",
      { class: `stage${current ? " chosen" : ""}${stage.muted || this.silenced(stage, all) ? " muted" : ""}` },
      choose,
      isShape && role.leads && index > 0
        ? iconButton("up", `Move ${stage.name} up`, () => this.move(index, index - 1))
        : null,
      isShape && role.leads && index < last
        ? iconButton("down", `Move ${stage.name} down`, () => this.move(index, index + 1))
        : null,
      canMute ? iconButton("solo", `Solo ${stage.name}`, () => this.solo(stage, all), {
            class: "icon-button solo",
            "aria-pressed": String(stage.solo),
          }) : null,
      isShape && role.leads ? iconButton("bin", `Remove ${stage.name}`, () => this.remove(index)) : null,
      canMute
        ? h(
            "button",
            {
              type: "button",
              class: "icon-button mute",
              "aria-pressed": String(stage.muted),
              "aria-label": `Mute ${stage.name}`,
              title: stage.muted ? "Unmute" : "Mute: show the groom without it",
              onclick: () => this.mute(key, all),
            },
            icon(stage.muted ? ICONS.hidden : ICONS.eye),
          )
        : null,
    );
  }

  /** Chooses the one of several grooms whose stages are shown. */
  private grooms(names: string[], chosen: string): HTMLElement {
    const options = names.map((name) =>
      h("option", { value: name, selected: name === chosen || undefined }, name.replaceAll("_", " ")),
    );
    const select = h("select", { "aria-label": "Groom", "data-stage": "grooms" }, ...options);
    select.disabled = !this.model.role.leads;
    select.onchange = () => {
      this.model.choose("recipe", []);
      this.model.say({ kind: "choose", groom: select.value });
    };
    return select;
  }

  private shotRow(name: string, place: Place): HTMLElement {
    const { chosen } = this.model;
    const current = chosen.file === "shot" && chosen.place.join("/") === place.join("/");
    return h(
      "div",
      { class: `stage${current ? " chosen" : ""}` },
      h(
        "button",
        {
          type: "button",
          class: "stage-name",
          "data-stage": `shot:${place.join("/") || name}`,
          "aria-current": current ? "true" : undefined,
          onclick: () => this.model.choose("shot", place),
        },
        name === "strands" ? "hair material" : name,
      ),
    );
  }

  private adding(): HTMLElement {
    const list = h("select", { class: "add", "aria-label": "Add an operator", disabled: !this.model.role.leads });
    list.append(h("option", { value: "" }, "+ add an operator"));
    for (const op of this.model.welcome?.operators ?? [])
      list.append(h("option", { value: op }, op.replaceAll("_", " ")));
    list.addEventListener("change", () => {
      if (list.value) this.add(list.value);
      list.value = "";
    });
    return list;
  }

  /** Whether the solo of another operator silences a stage. */
  private silenced(stage: Stage, all: Stage[]): boolean {
    const operates = stage.place[0] === "shape" || stage.place[0] === "curl";
    return operates && !stage.solo && all.some((one) => one.solo);
  }

  /** Adds an operator after the others; asks first for its settings without a default. */
  private add(op: string): void {
    const { model } = this;
    const at = (model.documents.recipe?.stages ?? []).filter((stage) => stage.place[0] === "shape").length;
    const give = (values: Record<string, string>) => {
      model.say({ kind: "arrange", action: "add", at, op, values });
      model.choose("recipe", ["shape", at]);
    };
    const schemas = new Schemas(model.welcome!.schemas["recipe"] as ConstructorParameters<typeof Schemas>[0]);
    const required = schemas.required(op);
    if (required.length) chooseNames(model, op, required, give);
    else give({});
  }

  private muted(all: Stage[]): string[] {
    return all.filter((stage) => stage.muted).map((stage) => stage.place.join("/"));
  }

  private mute(key: string, all: Stage[]): void {
    const muted = this.muted(all);
    this.model.say({
      kind: "mute",
      stages: muted.includes(key) ? muted.filter((one) => one !== key) : [...muted, key],
      solo: all.find((one) => one.solo)?.place.join("/") ?? "",
    });
  }

  /** Solos an operator, or ends its solo; mutes stay. */
  private solo(stage: Stage, all: Stage[]): void {
    this.model.say({ kind: "mute", stages: this.muted(all), solo: stage.solo ? "" : stage.place.join("/") });
  }

  private move(from: number, to: number): void {
    this.model.say({ kind: "arrange", action: "move", at: from, to });
    this.model.choose("recipe", ["shape", to]);
  }

  private remove(index: number): void {
    this.model.say({ kind: "arrange", action: "remove", at: index });
    this.model.choose("recipe", ["curl"]);
  }
}

/** What an entry is called: by its name, or else by its prim, or its file. */
function entryName({ name, mesh, file }: Entry): string {
  const last = (mesh ?? file ?? "").split(/[\\/]/).pop() ?? "";
  return name || last.split(".")[0];
}
