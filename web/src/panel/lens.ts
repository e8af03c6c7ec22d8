// The camera and the light in detail: focal length, bookmarks, cameras of the scene, the turn of the lights, and a sheet.

import { h, iconButton } from "../dom";
import type { Model } from "../model";
import { keep } from "../view/capture";
import { sheet } from "../view/sheet";
import { FOCAL_LENGTH } from "../view/framing";
import type { Viewer } from "../view/viewer";
import "./lens.css";
import type { Look } from "./look";

const ID = "lens-panel";

export class Lens {
  readonly button = iconButton("lens", "Camera, light and sheet", () => {}, { popovertarget: ID });
  readonly element = h("div", { id: ID, class: "lens", popover: "auto", role: "dialog", "aria-label": "Camera, light and sheet" });
  private readonly length = slider("Focal length", 24, 200, 1, "mm");
  private readonly turn = slider("Light rotation", -180, 180, 5, "°");
  private readonly cameras = h("select", { "aria-label": "Camera of the scene" });
  private readonly marks = h("div", { class: "bookmarks", role: "group", "aria-label": "Bookmarks" });

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly look: Look,
    private readonly name: () => string,
  ) {
    this.length.input.addEventListener("input", () => {
      viewer.setFocalLength(Number(this.length.input.value));
    });
    this.turn.input.addEventListener("input", () => {
      viewer.stage.setLightTurn(Number(this.turn.input.value));
      model.tell("look");
    });
    this.cameras.addEventListener("change", () => this.take(Number(this.cameras.value)));
    const save = h("button", { type: "button", class: "quiet", onclick: () => this.saveSheet() }, "Save a sheet of five angles");
    save.title = "Front, three-quarter view, both sides and back in one picture, with the open notes below";
    this.element.append(
      h("h2", {}, "Camera"),
      this.length.element,
      this.cameras,
      this.marks,
      h("h2", {}, "Light"),
      this.turn.element,
      h("h2", {}, "Sheet"),
      save,
    );
    for (const topic of ["look", "cameras", "views", "role"] as const) model.on(topic, () => this.update());
    this.update();
  }

  /** Looks through a camera of the scene. */
  private take(index: number): void {
    const camera = this.model.cameras[index];
    if (camera) this.viewer.lookFrom(camera.camera, camera.focal_length);
  }

  private saveSheet(): void {
    this.element.hidePopover();
    sheet(this.viewer, this.model.notes, this.name(), this.model.welcome?.name ?? "").toBlob(
      (blob) => blob && keep(blob, `${this.name()}-sheet.png`),
    );
  }

  private update(): void {
    const { model, viewer } = this;
    this.length.show(viewer.view.focalLength || FOCAL_LENGTH);
    this.turn.show(viewer.stage.lights.turn);
    const options = model.cameras.map(({ name }, k) => h("option", { value: k }, name));
    if (this.cameras.options.length !== options.length + 1) {
      this.cameras.replaceChildren(h("option", { value: "" }, "Camera of the scene …"), ...options);
      this.cameras.hidden = !options.length;
    }
    const marks = Array.from({ length: 9 }, (_, k) => {
      const slot = String(k + 1);
      const kept = slot in model.views;
      const label = kept ? `Recall bookmark ${slot}; with Shift, replace it` : `Store bookmark ${slot}`;
      const press = (event: MouseEvent) => this.look.bookmark(slot, event.shiftKey || !kept);
      return h("button", { type: "button", class: `quiet${kept ? " kept" : ""}`, title: label, "aria-label": label, onclick: press }, slot);
    });
    if (!this.marks.contains(document.activeElement)) this.marks.replaceChildren(h("span", {}, "Bookmarks"), ...marks);
  }
}

/** A slider with its value. */
function slider(label: string, min: number, max: number, step: number, unit: string) {
  const id = `lens-${label.replaceAll(" ", "-").toLowerCase()}`;
  const input = h("input", { type: "range", id, min, max, step });
  const output = h("output", { for: id });
  const show = (value: number) => {
    if (document.activeElement !== input) input.value = String(value);
    output.textContent = `${Math.round(value)} ${unit}`;
  };
  return { input, show, element: h("div", { class: "lens-row" }, h("label", { for: id }, label), input, output) };
}
