// Up to four looks: next to one another, with a wipe, one in place of the other, or their difference. Each has its
// label, and the settings in which they differ are listed.

import { h, iconButton } from "../dom";
import type { Model } from "../model";
import { type Arrangement, MOST_LOOKS, type Side } from "../view/looks";
import type { Viewer } from "../view/viewer";
import "./compare.css";
import { bindKey } from "./keys";
import { WipeLine } from "./wipe_line";

const MODES: Record<Arrangement, string> = {
  split: "side by side",
  wipe: "wipe",
  flip: "flip (Tab)",
  difference: "difference",
};
const LEGEND = "orange: brighter in the first; blue: brighter in the second";

/** What a look can be compared with, as options; their values are for `compareWith`. */
export function choices(model: Model): HTMLElement[] {
  const option = (value: string, label: string) => h("option", { value }, label);
  const recipe = model.documents.recipe?.name;
  const files = model.files.filter((name) => name.endsWith(".recipe.toml") && name !== recipe);
  const snapshots = [...model.snapshots].reverse().map((one) => option(`snapshot:${one.id}`, snapshotLabel(one)));
  return [
    option("now", "the current look"),
    option("saved", "as saved"),
    ...(snapshots.length ? [h("optgroup", { label: "Snapshots" }, ...snapshots)] : []),
    ...(files.length ? [h("optgroup", { label: "Recipes" }, ...files.map((name) => option(`file:${name}`, name)))] : []),
  ];
}

/** First line of the note, the author and the time of a snapshot. */
export function snapshotLabel({ note, author, time }: { note: string; author: string; time: string }): string {
  return [note.trim().split("\n")[0], author, time.replace("T", " ").slice(0, 16)].filter(Boolean).join(" · ");
}

/** Compares with another look, next to those that are there. */
export function compareWith(model: Model, choice: string): void {
  const [to, ...name] = choice.split(":");
  const sides = (["b", "c", "d"] as const).slice(0, MOST_LOOKS - 1);
  const side = sides.find((one) => !model.compared[one]) ?? sides[sides.length - 1];
  model.say({ kind: "compare", to: to as "now" | "saved" | "snapshot" | "file", name: name.join(":"), side });
}

export class CompareBar {
  readonly element = h("section", { class: "compare", hidden: true, "aria-label": "Comparison" });
  private readonly mode = h("select", { "aria-label": "Arrangement of the looks" });
  private readonly more = h("select", { class: "more-looks", "aria-label": "Compare with one more look" });
  private readonly swapped = iconButton("swap", "Swap the two sides", () => this.swap());
  private readonly changes = h("button", { type: "button", class: "quiet", "aria-expanded": "false" }, "Changes");
  private readonly list = h("div", { class: "compare-changes scrolls", hidden: true, tabindex: 0, role: "region", "aria-label": "Settings that differ" });
  private readonly legend = h("p", { class: "compare-legend", hidden: true }, LEGEND);
  readonly bar: HTMLElement;
  private readonly labels = h("div", { class: "look-labels" });
  private readonly line = new WipeLine("Place of the wipe", (at) => this.wipe(at));
  private readonly stretch = h("div", { class: "compare-wipe" }, this.line.element);

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly end: () => void,
  ) {
    model.hear("compared", (message) => {
      if (message.name) model.compared[message.side] = message;
      else delete model.compared[message.side];
      if (message.side !== "a") viewer.compare(message.side, message.name !== "");
      model.tell("compared");
    });
    for (const [name, label] of Object.entries(MODES)) this.mode.append(h("option", { value: name }, label));
    this.mode.addEventListener("change", () => this.arrange(this.mode.value as Arrangement));
    this.more.addEventListener("change", () => {
      if (this.more.value === "a") this.viewer.compare("a", true);
      else compareWith(model, this.more.value);
      this.update();
    });
    this.changes.addEventListener("click", () => {
      this.list.hidden = !this.list.hidden;
      this.changes.setAttribute("aria-expanded", String(!this.list.hidden));
    });
    this.bar = h(
      "div",
      { class: "compare-bar" },
      this.mode,
      this.more,
      this.swapped,
      this.changes,
      h("button", { type: "button", class: "quiet", onclick: () => this.end() }, "End"),
    );
    this.element.append(this.stretch, this.labels, this.bar, this.legend, this.list);
    for (const topic of ["compared", "snapshots", "files", "role"] as const) model.on(topic, () => this.update());
    for (const topic of ["clear", "arranged"] as const) model.on(topic, () => this.update());
    bindKey({ section: "Review", keys: "Tab", does: "flip between the compared looks", on: (event) => this.flips(event), run: () => this.flip() });
  }

  private flips(event: KeyboardEvent): boolean {
    const { looks } = this.viewer;
    return event.key === "Tab" && looks.several && looks.arrangement === "flip" && !event.shiftKey;
  }

  private flip(): void {
    this.viewer.looks.flip();
    this.redraw();
  }

  private swap(): void {
    this.viewer.looks.swap();
    if (this.viewer.looks.arrangement === "flip") this.viewer.looks.flip();
    this.redraw();
  }

  private arrange(mode: Arrangement): void {
    const { looks } = this.viewer;
    looks.arrangement = mode;
    if (!looks.order.includes(looks.front)) looks.front = looks.order[0];
    this.redraw();
  }

  private wipe(at: number): void {
    this.viewer.looks.wipe = at;
    this.redraw();
  }

  /** Takes a look out of the comparison. */
  private remove(side: Side): void {
    if (side === "a") this.viewer.compare("a", false);
    else if (this.model.timeline?.against) this.end();
    else this.model.say({ kind: "compare", to: "none", side });
    this.update();
  }

  private redraw(): void {
    this.viewer.invalidate();
    this.update();
    this.model.tell("look"); // followers see the same arrangement
  }

  private update(): void {
    const { model, viewer } = this;
    const { looks } = viewer;
    const several = looks.several && model.others.length > 0;
    this.element.hidden = !several;
    if (!several) return;
    const { leads } = model.role;
    const add = looks.order.includes("a") ? [] : [h("option", { value: "a" }, "the open recipe")];
    this.more.replaceChildren(h("option", { value: "", selected: true }, "Add …"), ...add, ...choices(model));
    this.more.value = "";
    this.more.disabled = !leads || (looks.order.length >= MOST_LOOKS && !add.length);
    this.mode.value = looks.arrangement;
    this.element.dataset["mode"] = looks.arrangement;
    this.legend.hidden = !looks.difference;
    this.stretch.hidden = looks.arrangement !== "wipe";
    this.line.place(looks.wipe);
    this.labels.replaceChildren(...this.placed().map((place) => this.label(...place)));
    this.list.replaceChildren(this.differences());
  }

  /** Where the labels of the looks are: their left and top [pixels], their shift as a part of their width, and their room. */
  private placed(): [Side, number, number, number, number][] {
    const { looks, size, clear } = this.viewer;
    const bar = this.element.offsetTop;
    const under = this.bar.offsetTop + this.bar.offsetHeight + 8;
    this.element.style.setProperty("--under", `${under}px`);
    if (looks.split)
      return looks
        .cells(size, clear)
        .map(({ side, clear }) => [side, clear.x + clear.width / 2, Math.max(under, clear.y + 8 - bar), -50, clear.width - 8]);
    const at = clear.x + clear.width * (looks.arrangement === "wipe" ? looks.wipe : 0.5);
    if (looks.arrangement === "flip") return [[looks.front, at, under, -50, clear.width]];
    const [first, second] = looks.order;
    return [
      [first, at - 16, under, -100, clear.width / 2 - 24],
      [second, at + 16, under, 0, clear.width / 2 - 24],
    ];
  }

  private label(side: Side, left: number, top: number, shift: number, room: number): HTMLElement {
    const { name, detail } = this.named(side);
    const remove = iconButton("close", `Remove ‘${name}’ from the comparison`, () => this.remove(side), {
      disabled: this.viewer.looks.order.length < 3 || (side !== "a" && !this.model.role.leads),
      hidden: this.viewer.looks.order.length < 3,
    });
    const style = `left: ${left}px; top: ${top}px; transform: translateX(${shift}%); max-width: min(320px, ${room}px)`;
    const shown = detail ? h("span", { title: detail }, detail) : null;
    return h("div", { class: "look-label", style, "data-side": side }, h("b", {}, name), shown, remove);
  }

  private named(side: Side): { name: string; detail: string } {
    const look = this.model.compared[side];
    return { name: side === "a" ? "now" : (look?.name ?? ""), detail: side === "a" ? "" : (look?.detail ?? "") };
  }

  /** A table of the settings in which the looks differ, with each value in full. */
  private differences(): HTMLElement {
    const sides = this.viewer.looks.order;
    const settings = sides.map((side) => this.model.compared[side]?.settings ?? {});
    const names = [...new Set(settings.flatMap((one) => Object.keys(one)))];
    const rows = names.filter((name) => settings.some((one) => one[name] !== settings[0][name]));
    this.changes.textContent = `Changes (${rows.length})`;
    if (!rows.length) return h("p", {}, "The looks have the same settings.");
    const head = sides.map((side) => h("th", { scope: "col" }, this.named(side).name));
    const cell = (value: string | undefined) => h("td", {}, value ?? "–");
    return h(
      "table",
      {},
      h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "setting"), ...head)),
      h(
        "tbody",
        {},
        ...rows.map((name) => h("tr", {}, h("th", { scope: "row" }, name), ...settings.map((one) => cell(one[name])))),
      ),
    );
  }
}
