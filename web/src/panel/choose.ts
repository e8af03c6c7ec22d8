// What an operator cannot be without, chosen before it is added: the name of a curve, for most.

import { h } from "../dom";
import type { Model } from "../model";
import { openDialog } from "./dialog";
import type { Setting } from "./schema";

/** Asks for the names that settings hold, and gives them. */
export function chooseNames(
  model: Model,
  op: string,
  settings: Setting[],
  give: (values: Record<string, string>) => void,
): void {
  const missing = settings.find((setting) => !model.names[setting.named].length);
  if (missing) {
    openDialog(
      `‘${op}’ needs a ${missing.label}`,
      h("p", {}, `This recipe has no ${KINDS[missing.named]}. ${missing.description}.`),
    );
    return;
  }
  const lists = settings.map((setting) => {
    const options = model.names[setting.named].map((name) => h("option", { value: name }, name));
    return h("select", { id: `choose-${setting.name}` }, ...options);
  });
  const form = h(
    "form",
    { class: "save-form" },
    ...settings.flatMap((setting, k) => [
      h("label", { for: lists[k].id }, `${setting.label}: ${setting.description}`),
      lists[k],
    ]),
    h("button", { class: "primary" }, "Add"),
  );
  const dialog = openDialog(`Choose a ${settings[0].label} for ‘${op}’`, form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    give(Object.fromEntries(settings.map((setting, k) => [setting.name, lists[k].value])));
    dialog.close();
  });
}

const KINDS = {
  regions: "named regions",
  maps: "maps",
  vectors: "directions",
  curves: "helper curves; add a table [curves.NAME] to it",
};
