// The name under which this page takes snapshots and writes notes; this browser remembers it.

import { h } from "../dom";

const STORE = "ringlet-author";

export function author(): string {
  return localStorage.getItem(STORE) ?? "";
}

export function authorField(): HTMLElement {
  const input = h("input", { type: "text", class: "author", placeholder: "Your name", "aria-label": "Your name", maxlength: 80, autocomplete: "name" });
  input.value = author();
  input.addEventListener("change", () => localStorage.setItem(STORE, input.value.trim()));
  return input;
}

/** A time in ISO 8601 as it is read: the day only where it is not today. */
export function shortTime(time: string): string {
  const when = new Date(time);
  if (Number.isNaN(when.getTime())) return time;
  const clock = when.toLocaleTimeString([], { hour: "2-digit", minute: "2-digit" });
  return when.toDateString() === new Date().toDateString() ? clock : `${when.toLocaleDateString()} ${clock}`;
}
