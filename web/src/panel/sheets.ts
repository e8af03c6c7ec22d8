// On a narrow screen one panel at a time is open below the picture, chosen here; wide screens show all.

import "./sheets.css";
import { h } from "../dom";
import type { Model } from "../model";

const SHEETS = { "": "Picture", stages: "Stages", settings: "Settings", view: "View" };
type Sheet = keyof typeof SHEETS;

export class Sheets {
  /** Whom to tell that the settings are wanted. */
  settings = (): void => {};
  readonly element = h("nav", { class: "sheets", "aria-label": "Panels" });
  private readonly buttons: Record<string, HTMLElement> = {};

  constructor(model: Model) {
    for (const [name, label] of Object.entries(SHEETS)) {
      this.buttons[name] = h("button", { type: "button", class: "quiet", onclick: () => this.choose(name as Sheet) }, label);
      this.element.append(this.buttons[name]);
    }
    this.open("");
    let stage = "";
    model.on("chosen", () => {
      const now = JSON.stringify(model.chosen);
      if (stage && now !== stage) this.choose("settings");
      stage = now;
    });
  }

  private choose(sheet: Sheet): void {
    if (sheet === "settings") this.settings();
    this.open(sheet);
  }

  open(sheet: Sheet): void {
    document.documentElement.dataset["sheet"] = sheet;
    for (const [name, button] of Object.entries(this.buttons)) button.setAttribute("aria-pressed", String(name === sheet));
  }
}
