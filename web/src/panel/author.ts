// The name under which this page takes snapshots and writes notes, which is that of its person; and times.

import { h } from "../dom";

export const NAME = "ringlet-person"; // where this browser remembers it

/** The name of this browser's person; empty where it was not given yet. */
export const ownName = (): string => localStorage.getItem(NAME) ?? "";

/** A field for the name; changed: called after it was given. */
export function authorField(changed: () => void): HTMLInputElement {
  const input = h("input", { type: "text", class: "author", placeholder: "Your name", "aria-label": "Your name", maxlength: 40, autocomplete: "nickname" });
  input.value = ownName();
  input.addEventListener("focus", () => (input.value = ownName()));
  input.addEventListener("change", () => {
    localStorage.setItem(NAME, input.value.trim());
    changed();
  });
  return input;
}

/** A time in ISO 8601 as it is read: the day only where it is not today. */
export function shortTime(time: string): string {
  const when = new Date(time);
  if (Number.isNaN(when.getTime())) return time;
  const clock = when.toLocaleTimeString([], { hour: "2-digit", minute: "2-digit" });
  return when.toDateString() === new Date().toDateString() ? clock : `${when.toLocaleDateString()} ${clock}`;
}
