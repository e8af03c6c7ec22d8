// The dock on the right: settings, the chart of a shot, and what is kept next to the recipe, one of them at a time. The
// stages on the left are there with the settings.

import { h, iconButton } from "../dom";
import { authorField, ownName } from "./author";
import { bindKey, plainKey } from "./keys";
import "./dock.css";

export interface DockTab {
  title: string;
  /** What it shows. */
  element: HTMLElement;
  /** Buttons above it. */
  actions: HTMLElement[];
  /** Number of its entries; none: it has none. */
  count?: () => number;
  /** Whether there is anything to show; none: always. */
  offered?: () => boolean;
  /** Whether it is kept next to the recipe. */
  kept?: boolean;
  /** Whether what it shows has the name of its author. */
  signed?: boolean;
  /** Called when it is shown. */
  shown?: () => void;
}

interface Entry {
  tab: DockTab;
  button: HTMLElement;
  panel: HTMLElement;
}

export class Dock {
  /** Between the kept and the settings. */
  readonly button = iconButton("tray", "Snapshots, notes and references (T)", () => this.toggle());
  /** Whom to tell that it was opened. */
  opened = (): void => {};
  /** On a phone, shows the picture in its place. */
  uncover = (): void => {};
  private readonly tabs: Entry[] = [];
  private readonly list = h("div", { class: "dock-tabs", role: "tablist", "aria-label": "Dock" });
  private readonly author: HTMLInputElement;
  private readonly actions = h("div", { class: "dock-actions" });
  readonly element = h("aside", { class: "panel dock", "aria-label": "Settings, chart, snapshots, notes and references" }, this.list, this.actions);
  private chosen: DockTab | null = null; // shown as soon as it is offered
  private kept: DockTab | null = null; // the tab of what is kept that was seen last

  constructor(renamed: () => void) {
    this.button.setAttribute("aria-pressed", "false");
    this.author = authorField(renamed);
    this.list.addEventListener("keydown", (event) => this.key(event));
    bindKey({ section: "Review", keys: "T", does: "show snapshots, notes and references, or the settings again", on: plainKey("t"), run: () => this.toggle() });
  }

  /** Adds a tab; the first that is offered is shown until another is opened. */
  add(tab: DockTab): void {
    const button = h("button", { type: "button", role: "tab", onclick: () => this.open(tab) }, tab.title);
    const panel = h("div", { class: "dock-panel", role: "tabpanel", "aria-label": tab.title }, tab.element);
    this.tabs.push({ tab, button, panel });
    this.list.append(button);
    this.element.append(panel);
    this.update();
  }

  /** Shows a tab. */
  open(tab: DockTab): void {
    this.chosen = tab;
    if (tab.kept) this.kept = tab;
    this.opened();
    this.update();
  }

  isShown(tab: DockTab): boolean {
    return this.current === tab;
  }

  /** Shows the first tab, from which one comes. */
  goBack(): void {
    const first = this.offered()[0];
    if (first) this.open(first.tab);
  }

  /** Numbers of entries have changed, or other tabs are offered. */
  update(): void {
    const offered = this.offered();
    const { current } = this;
    for (const { tab, button, panel } of this.tabs) {
      const count = tab.count?.();
      button.textContent = count ? `${tab.title} ${count}` : tab.title;
      button.hidden = !offered.some((one) => one.tab === tab);
      button.setAttribute("aria-selected", String(tab === current));
      button.tabIndex = tab === current ? 0 : -1;
      const appears = panel.hidden && tab === current;
      panel.hidden = tab !== current;
      if (appears) tab.shown?.();
    }
    document.documentElement.dataset["dock"] = current?.title.toLowerCase() ?? "";
    this.button.setAttribute("aria-pressed", String(Boolean(current?.kept)));
    if (document.activeElement !== this.author) this.author.value = ownName(); // it may have been given elsewhere
    this.author.hidden = !current?.signed;
    this.actions.hidden = !current?.actions.length;
    this.actions.replaceChildren(...(current?.actions ?? []), this.author);
  }

  private get current(): DockTab | null {
    const offered = this.offered().map(({ tab }) => tab);
    return offered.find((tab) => tab === this.chosen) ?? offered[0] ?? null;
  }

  private offered(): Entry[] {
    return this.tabs.filter(({ tab }) => tab.offered?.() ?? true);
  }

  private toggle(): void {
    const kept = this.kept ?? this.tabs.find(({ tab }) => tab.kept)?.tab;
    if (this.current?.kept) this.goBack();
    else if (kept) this.open(kept);
  }

  /** Arrows go from tab to tab. */
  private key(event: KeyboardEvent): void {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    const offered = this.offered();
    if (!step) return;
    const at = offered.findIndex(({ tab }) => tab === this.current);
    const next = offered[(at + step + offered.length) % offered.length];
    this.open(next.tab);
    next.button.focus();
    event.preventDefault();
    event.stopPropagation();
  }
}
