// The tray below the picture: what is kept next to the recipe, one kind at a time.

import { h, iconButton } from "../dom";
import { authorField, ownName } from "./author";
import { bindKey, plainKey } from "./keys";
import "./tray.css";

export interface TrayTab {
  title: string;
  /** What it shows. */
  element: HTMLElement;
  /** Buttons at the right of the tabs. */
  actions: HTMLElement[];
  count: () => number;
}

export class Tray {
  readonly element = h("section", { class: "tray", hidden: true, "aria-label": "Snapshots, notes and references" });
  readonly button = iconButton("tray", "Snapshots, notes and references (T)", () => this.show(this.element.hidden === true));
  /** Whom to tell that it is opened. */
  opened = (): void => {};
  private readonly tabs: { tab: TrayTab; button: HTMLElement }[] = [];
  private readonly list = h("div", { class: "group", role: "tablist", "aria-label": "Tray" });
  private readonly actions = h("div", { class: "group tray-actions" });
  private readonly body = h("div", { class: "tray-body" });
  private readonly author: HTMLInputElement;
  private chosen: TrayTab | null = null;

  constructor(renamed: () => void) {
    this.button.setAttribute("aria-pressed", "false");
    this.author = authorField(renamed);
    const close = iconButton("close", "Close the tray", () => this.show(false));
    this.element.append(h("header", { class: "tray-head" }, this.list, this.actions, this.author, close), this.body);
    bindKey({ section: "Review", keys: "T", does: "open or close the tray of snapshots, notes and references", on: plainKey("t"), run: () => this.show(this.element.hidden === true) });
  }

  add(tab: TrayTab): void {
    const button = h("button", { type: "button", class: "quiet", role: "tab", onclick: () => this.open(tab) }, tab.title);
    this.tabs.push({ tab, button });
    this.list.append(button);
    this.chosen ??= tab;
    this.update();
  }

  /** Shows one kind. */
  open(tab: TrayTab): void {
    this.chosen = tab;
    this.show(true);
  }

  show(on: boolean): void {
    this.element.hidden = !on;
    this.button.setAttribute("aria-pressed", String(on));
    document.documentElement.classList.toggle("with-tray", on);
    if (on) this.opened();
    this.update();
  }

  /** Numbers of entries have changed, or another kind is shown. */
  update(): void {
    for (const { tab, button } of this.tabs) {
      const count = tab.count();
      button.textContent = count ? `${tab.title} ${count}` : tab.title;
      button.setAttribute("aria-selected", String(tab === this.chosen));
    }
    if (this.element.hidden || !this.chosen) return;
    if (document.activeElement !== this.author) this.author.value = ownName(); // it may have been given elsewhere
    this.actions.replaceChildren(...this.chosen.actions);
    if (this.body.firstChild !== this.chosen.element) this.body.replaceChildren(this.chosen.element);
  }
}
