// A conflict with the version of a file that another program wrote: each setting is seen, and chosen.

import "./lined_table.css";
import "./merge.css";
import { h } from "../dom";
import type { Model } from "../model";
import type { Difference, Problem } from "../protocol";
import { openDialog } from "./dialog";

export function openMerge(model: Model, { file, differences }: Problem): void {
  const name = model.documents[file]?.name ?? file;
  if (!differences.length) {
    openDialog(`Versions of ${name}`, h("p", {}, "The version on disk cannot be compared setting by setting."));
    return;
  }
  const rows = differences.map((difference, k) => new Row(difference, k));
  const merge = h("button", { type: "button", class: "primary" }, "Merge");
  const update = () => merge.toggleAttribute("disabled", !model.role.leads || rows.some((row) => !row.choice));
  const table = h(
    "table",
    { class: "merge" },
    h("thead", {}, h("tr", {}, ...["setting", "before", "mine", "theirs"].map((one) => h("th", {}, one)))),
    h("tbody", {}, ...rows.map((row) => row.element)),
  );
  const about = "Mine are the settings of this review, theirs those on disk. What only one side changed is already chosen.";
  const dialog = openDialog(`Versions of ${name}`, h("p", {}, about), h("div", { class: "scrolls", tabindex: 0, role: "region", "aria-label": "Settings that differ" }, table), merge);
  dialog.addEventListener("change", update);
  merge.addEventListener("click", () => {
    const of = (side: string) => rows.filter((row) => row.choice === side).map((row) => row.difference.name);
    model.say({ kind: "resolve", file, choice: "merge", mine: of("mine"), theirs: of("theirs") });
    dialog.close();
  });
  update();
}

class Row {
  readonly element: HTMLElement;
  private readonly inputs: Record<"mine" | "theirs", HTMLInputElement>;

  constructor(
    readonly difference: Difference,
    k: number,
  ) {
    const { name, base, mine, theirs, both } = difference;
    const changed = mine !== base ? "mine" : "theirs";
    const input = (side: "mine" | "theirs") =>
      h("input", { type: "radio", name: `merge-${k}`, "aria-label": `${name}: ${side}`, checked: !both && side === changed });
    this.inputs = { mine: input("mine"), theirs: input("theirs") };
    const cell = (side: "mine" | "theirs", value: string) =>
      h("td", {}, h("label", {}, this.inputs[side], h("code", {}, value)));
    this.element = h(
      "tr",
      { class: both ? "both" : "" },
      h("th", { scope: "row" }, name),
      h("td", {}, h("code", {}, base)),
      cell("mine", mine),
      cell("theirs", theirs),
    );
  }

  get choice(): "mine" | "theirs" | "" {
    return this.inputs.mine.checked ? "mine" : this.inputs.theirs.checked ? "theirs" : "";
  }
}
