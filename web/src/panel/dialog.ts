// A dialog over the page; Escape closes it.

import { h } from "../dom";

export function openDialog(title: string, ...content: Node[]): HTMLDialogElement {
  const close = h("button", { type: "button", class: "quiet", onclick: () => dialog.close() }, "Close");
  const dialog = h("dialog", { "aria-label": title }, h("h2", {}, title), ...content, h("footer", {}, close));
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  return dialog;
}
