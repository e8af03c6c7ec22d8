// A picture to keep: how large, and before what.

import { h } from "../dom";
import { keep } from "../view/capture";
import type { Viewer } from "../view/viewer";
import { openDialog } from "./dialog";

const SIZES: Record<string, [number, number]> = {
  "1920 × 1080": [1920, 1080],
  "3840 × 2160": [3840, 2160],
  "2048 × 2048": [2048, 2048],
  "1080 × 1920": [1080, 1920],
};

export function savePicture(viewer: Viewer, name: string): void {
  const { clientWidth, clientHeight } = viewer.element;
  const size = h("select", { id: "picture-size" }, h("option", { value: "" }, `as displayed: ${clientWidth} × ${clientHeight}`));
  for (const label of Object.keys(SIZES)) size.append(h("option", { value: label }, label));
  const clear = h("input", { type: "checkbox", id: "picture-clear", class: "switch", role: "switch" });
  const form = h(
    "form",
    { class: "save-form" },
    h("label", { for: size.id }, "Size in pixels"),
    size,
    h("div", { class: "field-head" }, h("label", { for: clear.id }, "Transparent background"), clear),
    h("button", { class: "primary" }, "Save"),
  );
  const dialog = openDialog("Save picture", form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const [width, height] = SIZES[size.value] ?? [clientWidth, clientHeight];
    viewer.drawAt(width, height, clear.checked).toBlob((blob) => blob && keep(blob, `${name}.png`));
    dialog.close();
  });
}
