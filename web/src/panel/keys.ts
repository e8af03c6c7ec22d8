// All keys in one place: what they do, where they act, and the list of them.

import "./lined_table.css";
import "./keys.css";
import { h } from "../dom";
import { TYPED } from "../focus";
import { openDialog } from "./dialog";

/** Sections of the list, in their order. */
const SECTIONS = ["File", "View", "Groom", "Review", "Frames"] as const;

interface Key {
  section: (typeof SECTIONS)[number];
  keys: string; // as the list shows them
  does: string;
  /** Whether an event is this key; Ctrl or Command is in `with`. */
  on: (event: KeyboardEvent) => boolean;
  run: (event: KeyboardEvent) => void;
  /** Whether it also acts while text is typed. */
  anywhere?: boolean;
}

const bound: Key[] = [];

/** Keys that a control which has the focus takes itself. */
const OWN: [Key["section"], string, string][] = [
  ["File", "Escape", "discard typed text, or close a dialog"],
  ["Groom", "Arrows, Shift with arrows", "change the number that has the focus; finer"],
  ["Groom", "Arrows, Enter, Delete", "move a point of a ramp, add one, remove it"],
  ["Groom", "Arrows", "move a handle of an isolated lock"],
  ["Frames", "Arrows", "previous frame, next frame, where the timeline has the focus"],
];

export function bindKey(key: Key): void {
  bound.push(key);
}

/** Whether an event belongs to a text that is typed. */
export function typing(event: Event): boolean {
  const target = event.target as HTMLElement | null;
  return Boolean(target?.closest?.(TYPED));
}

/** The button that a pointer has pressed, and that has the focus by this alone: keys are meant for the page. */
let clicked: Element | null = null;
addEventListener("pointerdown", ({ target }) => (clicked = target instanceof Element ? target.closest("button, summary, a") : null), true);
addEventListener(
  "focusout",
  ({ target }) => {
    if (target === clicked) clicked = null;
  },
  true,
);

/** Whether a control with the focus, or a dialog, has a use of its own for plain keys. */
function taken(event: KeyboardEvent): boolean {
  const target = event.target as HTMLElement | null;
  if (document.querySelector("dialog[open]")) return true;
  if (!target?.closest) return false;
  if (event.key === " " || event.key === "Enter") {
    const control = target.closest("button, summary, input, select, a");
    return control !== null && control !== clicked;
  }
  if (/^(Arrow|Home|End)/.test(event.key)) return Boolean(target.closest("input, select, svg, [role=slider]"));
  return Boolean(target.closest("select"));
}

addEventListener("keydown", (event) => {
  if (event.defaultPrevented || event.altKey) return;
  const command = event.ctrlKey || event.metaKey;
  for (const key of bound) {
    if (!key.on(event)) continue;
    if (!key.anywhere && (typing(event) || (!command && taken(event)))) continue;
    event.preventDefault();
    key.run(event);
    return;
  }
});

/** Ctrl or Command with a letter. */
export const command =
  (letter: string, shift = false) =>
  (event: KeyboardEvent): boolean =>
    (event.ctrlKey || event.metaKey) && event.shiftKey === shift && event.key.toLowerCase() === letter;

/** One of some plain keys. */
export const plainKey =
  (...keys: string[]) =>
  (event: KeyboardEvent): boolean =>
    !event.ctrlKey && !event.metaKey && keys.includes(event.key.length === 1 ? event.key.toLowerCase() : event.key);

export function showKeys(): void {
  const all = [...bound.map(({ section, keys, does }) => [section, keys, does]), ...OWN];
  const tables = SECTIONS.map((title) => {
    const uses = new Map<string, Set<string>>(); // tools share keys: one row lists them
    for (const [section, keys, does] of all) if (section === title) uses.set(keys, (uses.get(keys) ?? new Set()).add(does));
    const rows = [...uses].map(([keys, does]) => h("tr", {}, h("th", { scope: "row" }, keys), h("td", {}, [...does].join("; "))));
    return h("section", {}, h("h3", {}, title), h("table", { class: "keys" }, h("tbody", {}, ...rows)));
  });
  const list = h("div", { class: "scrolls", tabindex: 0, role: "region", "aria-label": "Keyboard shortcuts" }, h("div", { class: "key-sections" }, ...tables));
  openDialog("Keyboard shortcuts", list).querySelector<HTMLElement>("footer button")!.focus();
}

bindKey({ section: "File", keys: "?", does: "show this list", on: plainKey("?"), run: showKeys });
