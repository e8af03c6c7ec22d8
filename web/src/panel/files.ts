// What has changed since the file was saved, and saving it under another name.

import "./files.css";
import { h } from "../dom";
import type { File, Model } from "../model";
import { openDialog } from "./dialog";

export function showChanges(model: Model): void {
  const lists = Object.values(model.documents).map((document) => {
    const lines = document.changes.map(({ sign, line }) => {
      const kind = sign === "+" ? "ins" : sign === "-" ? "del" : "span";
      return h(kind, { class: "change" }, `${sign} ${line}`);
    });
    const none = h("p", {}, "No unsaved changes.");
    return h("section", {}, h("h3", {}, document.name), lines.length ? h("pre", { class: "changes", tabindex: 0 }, ...lines) : none);
  });
  const revert = h("button", { type: "button", class: "quiet" }, "Revert to the saved file");
  const dialog = openDialog("Changes", ...lists, h("p", {}, revert));
  revert.addEventListener("click", () => {
    model.say({ kind: "revert" });
    dialog.close();
  });
}

/** Opens another file of the project; asks what becomes of unsaved changes. */
export function openFile(model: Model): void {
  const files = model.files.filter((name) => name !== model.welcome?.name);
  const dirty = Object.values(model.documents).some((one) => one.dirty);
  const open = (name: string, discard: boolean) => model.say({ kind: "open", name, discard });
  const buttons = files.map((name) =>
    h(
      "button",
      {
        type: "button",
        class: "quiet file",
        onclick: () => {
          dialog.close();
          if (dirty) askUnsaved(model, name, open);
          else open(name, false);
        },
      },
      name,
    ),
  );
  const none = h("p", {}, "There is no other recipe, shot or cache in this folder.");
  const dialog = openDialog("Open", buttons.length ? h("div", { class: "files scrolls" }, ...buttons) : none);
}

function askUnsaved(model: Model, name: string, open: (name: string, discard: boolean) => void): void {
  const button = (label: string, press: () => void, kind = "quiet") =>
    h(
      "button",
      {
        type: "button",
        class: kind,
        onclick: () => {
          press();
          dialog.close();
        },
      },
      label,
    );
  const save = () => {
    for (const file of ["recipe", "shot"] as const)
      if (model.documents[file]?.dirty) model.say({ kind: "save", file });
    open(name, false);
  };
  const dialog = openDialog(
    "Unsaved changes",
    h("p", {}, `${model.welcome?.name} has unsaved changes.`),
    h("div", { class: "group" }, button("Save and open", save, "primary"), button("Discard and open", () => open(name, true))),
  );
}

/** Files that a copy is for: those that have changed; the first one where none has. */
function toCopy(model: Model): File[] {
  const open = (["recipe", "shot"] as const).filter((file) => model.documents[file]);
  const changed = open.filter((file) => model.documents[file]!.dirty);
  return changed.length ? changed : open.slice(0, 1);
}

/** Saves the files that have changed under other names; a shot then names the copy of its recipe. */
export function saveAs(model: Model): void {
  const files = toCopy(model);
  const names = files.map((file, k) =>
    h("input", { type: "text", id: `save-name${k || ""}`, name: file, required: true, placeholder: "hair-down", autocomplete: "off" }),
  );
  const variant = h("input", { type: "checkbox", id: "save-variant", class: "switch", role: "switch" });
  const folder = files.map((file) => model.documents[file]!.name).join(" and ");
  const form = h(
    "form",
    { class: "save-form" },
    h("p", {}, `${files.length > 1 ? "New files" : "A new file"} in the folder of ${folder}; the review continues with ${files.length > 1 ? "them" : "it"}.`),
    ...files.flatMap((file, k) => [
      h("label", { for: names[k].id }, files.length > 1 ? `Name of the ${file}` : `Name of the ${file}, a copy of ${model.documents[file]!.name}`),
      names[k],
    ]),
    files.includes("recipe")
      ? h(
          "div",
          { class: "field-head" },
          h("label", { for: "save-variant" }, "As a variant: a small file with only the changes"),
          variant,
        )
      : null,
    h("button", { class: "primary" }, "Save"),
  );
  const dialog = openDialog("Save as", form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    files.forEach((file, k) =>
      model.say({
        kind: "save",
        file,
        name: names[k].value.trim(),
        variant: file === "recipe" && variant.checked,
        with_copy: file === "shot" && files.length > 1,
      }),
    );
    dialog.close();
  });
  names[0].focus();
}
