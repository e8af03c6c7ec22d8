// The bar at the top: the file, what was done to it, who leads, and how the page looks.

import "./bar.css";
import { h, iconButton } from "../dom";
import { endTyping } from "../focus";
import type { Model } from "../model";
import { choices, compareWith } from "./compare";
import { openFile, saveAs, showChanges } from "./files";
import { bindKey, command, showKeys } from "./keys";

export class Bar {
  readonly element = h("header", { class: "bar" });
  private readonly name = h("button", {
    type: "button",
    class: "file-name",
  });
  private readonly undo = iconButton("undo", "Undo (Ctrl+Z)", () => this.model.say({ kind: "undo" }));
  private readonly redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", () => this.model.say({ kind: "redo" }));
  private readonly save = h("button", { type: "button", class: "primary", title: "Save (Ctrl+S)" }, "Save");
  private readonly as = h("button", { type: "button", class: "quiet" }, "Save as…");
  private readonly open = iconButton("folder", "Open another file (Ctrl+O)", () => openFile(this.model));
  private readonly other = h("select", { "aria-label": "Compare looks", class: "other-look" });

  constructor(
    private readonly model: Model,
    setTheme: () => void,
    people: HTMLElement,
    private readonly endComparison: () => void,
  ) {
    this.name.addEventListener("click", () => showChanges(model));
    this.save.addEventListener("click", () => this.saveAll());
    this.as.addEventListener("click", () => saveAs(model));
    this.other.addEventListener("change", () => this.compare());
    this.element.append(
      h("span", { class: "brand" }, "Ringlet"),
      this.open,
      this.name,
      h("span", { class: "group" }, this.undo, this.redo),
      h("span", { class: "group" }, this.save, this.as),
      this.other,
      h("span", { class: "space" }),
      people,
      iconButton("keys", "Keyboard shortcuts (?)", showKeys, { class: "icon-button keys-list" }),
      iconButton("sun", "Dark or light theme", setTheme),
    );
    const tellHeight = () => document.documentElement.style.setProperty("--bar", `${this.element.offsetHeight}px`);
    new ResizeObserver(tellHeight).observe(this.element);
    for (const topic of ["document", "role", "welcome", "files", "compared", "snapshots"] as const) model.on(topic, () => this.update());
    bindKey({ section: "File", keys: "Ctrl+Z", does: "undo", on: command("z"), run: () => model.say({ kind: "undo" }) });
    const redo = (event: KeyboardEvent) => command("z", true)(event) || command("y")(event);
    bindKey({ section: "File", keys: "Ctrl+Shift+Z", does: "redo", on: redo, run: () => model.say({ kind: "redo" }) });
    bindKey({ section: "File", keys: "Ctrl+S", does: "save", on: command("s"), run: () => this.saveAll(), anywhere: true });
    bindKey({ section: "File", keys: "Ctrl+O", does: "open another file", on: command("o"), run: () => openFile(model), anywhere: true });
  }

  saveAll(): void {
    endTyping();
    for (const file of ["recipe", "shot"] as const)
      if (this.model.documents[file]?.dirty) this.model.say({ kind: "save", file });
  }

  private compare(): void {
    const { value } = this.other;
    this.other.value = "";
    if (value === "end") this.endComparison();
    else if (value) compareWith(this.model, value);
  }

  private update(): void {
    const { documents, role, welcome } = this.model;
    const open = [documents.recipe, documents.shot].filter((document) => document !== undefined);
    const dirty = open.some((document) => document.dirty);
    const changed = open.filter((document) => document.dirty).map(({ name }) => name);
    const shown = dirty ? `${changed.join(", ")} ·` : (documents.recipe?.name ?? welcome?.name ?? "");
    this.name.textContent = shown;
    this.name.title = `${shown}: show what has changed since the last save`;
    this.save.title = dirty ? `Save ${changed.join(" and ")} (Ctrl+S)` : "Save (Ctrl+S)";
    this.name.classList.toggle("dirty", dirty);
    document.title = `${dirty ? "• " : ""}${documents.recipe?.name ?? welcome?.name ?? "Ringlet"}`;
    this.element.classList.toggle("follows", !role.leads);
    this.undo.toggleAttribute("disabled", !role.leads || !open.some((document) => document.undo));
    this.redo.toggleAttribute("disabled", !role.leads || !open.some((document) => document.redo));
    this.save.toggleAttribute("disabled", !role.leads || !dirty);
    for (const part of [this.undo, this.redo, this.save, this.as, this.other])
      part.toggleAttribute("hidden", !open.length);
    this.as.toggleAttribute("disabled", !role.leads);
    this.open.toggleAttribute("disabled", !role.leads);
    this.other.replaceChildren(
      h("option", { value: "" }, "Compare looks …"),
      ...(this.model.others.length ? [h("option", { value: "end" }, "End the comparison")] : []),
      ...choices(this.model),
    );
    this.other.toggleAttribute("disabled", !role.leads);
  }
}
