// What has changed since the file was saved, and saving it under another name.

import { h } from "../dom";
import type { File, Model } from "../model";
import { openDialog } from "./dialog";

export function showChanges(model: Model): void {
  const lists = Object.values(model.documents).map((document) => {
    const lines = document.changes.map(({ sign, line }) => {
      const kind = sign === "+" ? "ins" : sign === "-" ? "del" : "span";
      return h(kind, { class: "change" }, `${sign} ${line}`);
    });
    const none = h("p", {}, "Nothing has changed since it was saved.");
    return h("section", {}, h("h3", {}, document.name), lines.length ? h("pre", { class: "changes" }, ...lines) : none);
  });
  const revert = h("button", { type: "button", class: "quiet" }, "Back to what was saved");
  const dialog = openDialog("Changes", ...lists, h("p", {}, revert));
  revert.addEventListener("click", () => {
    model.say({ kind: "revert" });
    dialog.close();
  });
}

export function saveAs(model: Model, file: File): void {
  const name = h("input", {
    type: "text",
    id: "save-name",
    required: true,
    placeholder: "hair-down",
    autocomplete: "off",
  });
  const variant = h("input", { type: "checkbox", id: "save-variant", class: "switch", role: "switch" });
  const form = h(
    "form",
    { class: "save-form" },
    h("p", {}, `Beside ${model.documents[file]?.name ?? "the file"}, as a new file.`),
    h("label", { for: "save-name" }, "Name"),
    name,
    file === "recipe"
      ? h(
          "div",
          { class: "field-head" },
          h("label", { for: "save-variant" }, "As a variant: a small file with the changes alone"),
          variant,
        )
      : null,
    h("button", { class: "primary" }, "Save"),
  );
  const dialog = openDialog("Save as", form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    model.say({ kind: "save", file, name: name.value.trim(), variant: variant.checked });
    dialog.close();
  });
  name.focus();
}
