// Finds settings of all stages by what stylists call them, by label, file name and description, and jumps to the one that
// is chosen.

import "./search.css";
import { h } from "../dom";
import { at, type File, type Model, type Place } from "../model";
import type { Json } from "../protocol";
import { meantBy } from "./aspects";
import { bindKey, plainKey } from "./keys";
import { Schemas, type Setting } from "./schema";

const MOST = 40; // results that are listed
const MEANT = -1; // rank of what stylists mean: a hair setting is called `shorter`, but who types that means the length
const SHOT_TABLES = ["strands", "motion", "variation", "solver", "forces", "contact"];

/** A setting of a stage; `inner` is one in its table. */
interface Found {
  file: File;
  place: Place;
  stage: string;
  setting: Setting;
  inner: Setting | null;
  /** What stylists call it, and what is to be done with it. */
  asked: string;
  rank: number;
}

export class SettingSearch {
  readonly input = h("input", {
    type: "search",
    class: "search",
    placeholder: "Search settings  ( / )",
    "aria-label": "Search settings",
    autocomplete: "off",
    role: "combobox",
    "aria-expanded": "false",
    "aria-controls": "search-results",
  });
  readonly results = h("ul", { class: "search-results", id: "search-results", role: "listbox", "aria-label": "Settings found", hidden: true });
  private found: Found[] = [];
  private active = 0;

  /** Shows the panel that it is in. */
  wanted = (): void => {};
  /** Takes the focus when the search is given up. */
  left = (): void => {};

  /** reveal: shows a setting of the stage that was chosen; searched: called when a search begins or ends */
  constructor(
    private readonly model: Model,
    private readonly reveal: (name: string) => void,
    private readonly searched: () => void,
  ) {
    this.input.addEventListener("input", () => this.look());
    this.input.addEventListener("keydown", (event) => this.key(event));
    bindKey({ section: "Groom", keys: "/", does: "search the settings of all stages", on: plainKey("/"), run: () => this.focus() });
  }

  /** Whether results are shown. */
  get on(): boolean {
    return this.input.value.trim() !== "";
  }

  private focus(): void {
    this.wanted();
    this.input.focus();
    this.input.select();
  }

  private end(): void {
    this.input.value = "";
    this.look();
  }

  private look(): void {
    const words = this.input.value.toLowerCase().split(/\s+/).filter(Boolean);
    const { meant, missing } = words.length ? this.meant() : { meant: [], missing: "" };
    const known = new Set(meant.map(keyOf));
    const others = words.length ? this.all(words).filter((one) => !known.has(keyOf(one))) : [];
    this.found = [...meant, ...others].sort((a, b) => a.rank - b.rank).slice(0, MOST);
    this.active = 0;
    const none = h("li", { class: "hint" }, missing || "No setting matches.");
    const rows = this.found.map((one, k) => {
      const label = one.inner ? `${one.setting.label} › ${one.inner.label}` : one.setting.label;
      const about = (one.inner ?? one.setting).description;
      return h(
        "li",
        { role: "option", id: `found-${k}`, title: about, onclick: () => this.go(k) },
        h("span", { class: "found-name" }, label),
        h("span", { class: "found-stage" }, one.stage),
        h("span", { class: "found-about" }, one.asked || about),
      );
    });
    this.results.replaceChildren(...rows, ...(rows.length && !missing ? [] : [none]));
    this.results.toggleAttribute("hidden", !this.on);
    this.input.setAttribute("aria-expanded", String(this.on));
    this.mark();
    this.searched();
  }

  private mark(): void {
    [...this.results.children].forEach((row, k) => row.setAttribute("aria-selected", String(k === this.active)));
    const row = this.results.children[this.active];
    if (this.found.length && row) {
      this.input.setAttribute("aria-activedescendant", row.id);
      row.scrollIntoView({ block: "nearest" });
    } else this.input.removeAttribute("aria-activedescendant");
  }

  private key(event: KeyboardEvent): void {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step && this.found.length) this.active = (this.active + step + this.found.length) % this.found.length;
    else if (event.key === "Enter") {
      event.preventDefault(); // the setting that gets the focus does not take the key
      this.go(this.active);
      return;
    } else if (event.key === "Escape") {
      this.end();
      this.left();
    } else return;
    event.preventDefault();
    this.mark();
  }

  private go(index: number): void {
    const one = this.found[index];
    if (!one) return;
    this.end();
    this.model.choose(one.file, one.place);
    this.reveal(one.setting.name);
  }

  /** Settings that stylists mean by what was typed, and where those are that no open file has. */
  private meant(): { meant: Found[]; missing: string } {
    const { meant, missing } = meantBy(this.model, this.input.value);
    const stages = new Map(this.stages().map(({ file, place, stage }) => [JSON.stringify([file, place]), stage]));
    return {
      meant: meant.map(({ file, stage: place, setting, inner, aspect, advice }) => {
        const stage = stages.get(JSON.stringify([file, place])) ?? "";
        return { file, place, stage, setting, inner, asked: [aspect.label, advice].filter(Boolean).join("; "), rank: MEANT };
      }),
      missing: missing.length ? `${missing.map(({ label }) => label).join(", ")}: in a shot; open one (Ctrl+O)` : "",
    };
  }

  /** Settings with all words in their names or descriptions; the names count before the descriptions. */
  private all(words: string[]): Found[] {
    const found: Found[] = [];
    for (const { file, place, stage } of this.stages()) {
      const schemas = new Schemas(this.model.welcome!.schemas[file] as ConstructorParameters<typeof Schemas>[0]);
      for (const setting of schemas.settings(place, this.model.value(file, place) ?? null)) {
        const inner = setting.varied ? [] : setting.inner;
        for (const one of [null, ...inner]) {
          const rank = rankOf(one ?? setting, words, stage);
          if (rank !== null) found.push({ file, place, stage, setting, inner: one, asked: "", rank: rank + (one ? 0.5 : 0) });
        }
      }
    }
    return found;
  }

  /** All stages of the open files, that which is chosen first. */
  private stages(): { file: File; place: Place; stage: string }[] {
    const { documents, chosen } = this.model;
    const all: { file: File; place: Place; stage: string }[] = [];
    if (documents.recipe) {
      all.push({ file: "recipe", place: [], stage: "essentials" });
      for (const { name, place } of documents.recipe.stages) all.push({ file: "recipe", place, stage: name.replaceAll("_", " ") });
    }
    const shot = documents.shot?.values;
    if (shot) {
      all.push({ file: "shot", place: [], stage: "shot" });
      for (const name of SHOT_TABLES.filter((one) => shot[one])) all.push({ file: "shot", place: [name], stage: name });
      for (const kind of ["cloth", "collider"])
        ((shot[kind] ?? []) as Json[]).forEach((_, k) => all.push({ file: "shot", place: [kind, k], stage: String(at(shot[kind], [k, "name"]) ?? kind) }));
    }
    const here = JSON.stringify(chosen);
    return all.sort((a, b) => Number(JSON.stringify({ file: b.file, place: b.place }) === here) - Number(JSON.stringify({ file: a.file, place: a.place }) === here));
  }
}

const keyOf = ({ file, place, setting, inner }: Found): string => JSON.stringify([file, place, setting.name, inner?.name]);

/** How well a setting fits, less is better: 0 its name, 1 the beginning of it, 2 a part of it, 3 its stage, 4 its description. */
function rankOf(setting: Setting, words: string[], stage: string): number | null {
  const [label, name, about] = [setting.label, setting.name, setting.description].map((text) => text.toLowerCase());
  const all = words.join(" ");
  const inAll = (text: string) => words.every((word) => text.includes(word));
  if (all === label || all === name) return 0;
  if (label.startsWith(all) || name.startsWith(all)) return 1;
  if (inAll(`${label} ${name}`)) return 2;
  if (inAll(`${stage.toLowerCase()} ${label} ${name}`)) return 3;
  return inAll(`${stage.toLowerCase()} ${label} ${name} ${about}`) ? 4 : null;
}
