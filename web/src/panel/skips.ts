// The first buttons of the page for a keyboard: to a panel, past all that comes before it. They are seen while they have the
// focus.

import "./skips.css";
import { h } from "../dom";

export function skips(panels: [name: string, panel: HTMLElement, show?: () => void][]): HTMLElement {
  const go = (panel: HTMLElement, show?: () => void) => {
    show?.();
    const all = panel.querySelectorAll<HTMLElement>("button, input, select, summary, [tabindex]");
    [...all].find((one) => one.checkVisibility())?.focus();
  };
  const buttons = panels.map(([name, panel, show]) => h("button", { type: "button", onclick: () => go(panel, show) }, `To the ${name}`));
  return h("nav", { class: "skips", "aria-label": "Skip to" }, ...buttons);
}
