// Reference pictures next to the look or over it: dropped, pasted or chosen; with an eyedropper for the hair's color.

import { h, iconButton } from "../dom";
import type { Model } from "../model";
import type { Reference } from "../protocol";
import { toPixels } from "../view/marks";
import type { Viewer } from "../view/viewer";
import { bindKey, typing } from "./keys";
import "./references.css";
import type { Notices } from "./status";
import type { Dock, DockTab } from "./dock";

const MODES = { off: "hidden", next: "next to it", over: "over" };
const LARGEST = 2048; // pixels on the long side of a picture that is kept
const PATCH = 5; // pixels of a picture whose mean the eyedropper takes, on each side

type Placement = Pick<Reference, "mode" | "opacity" | "x" | "y" | "scale">;

export class References {
  /** Over the picture. */
  readonly element = h("div", { class: "references" });
  private readonly list = h("ul", { class: "strip", "aria-label": "Reference pictures" });
  private readonly tab: DockTab;
  private readonly images = new Map<string, HTMLImageElement>();
  private picking = false;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly dock: Dock,
    private readonly notices: Notices,
  ) {
    const file = h("input", { type: "file", accept: "image/*", multiple: true, hidden: true });
    file.addEventListener("change", () => void this.addAll([...(file.files ?? [])]));
    const add = h("button", { type: "button", class: "primary", onclick: () => file.click() }, "Add pictures");
    const pick = iconButton("pipette", "Pick the hair's color from a reference picture", () => this.pick(!this.picking), { "aria-pressed": "false" });
    this.tab = { title: "References", element: this.list, kept: true, actions: [pick, file, add], count: () => model.references.length };
    dock.add(this.tab);
    for (const topic of ["references", "pictures", "role"] as const) model.on(topic, () => this.update());
    addEventListener("dragover", (event) => event.dataTransfer?.types.includes("Files") && event.preventDefault());
    addEventListener("drop", (event) => {
      if (!event.dataTransfer?.files.length) return;
      event.preventDefault();
      void this.addAll([...event.dataTransfer.files]);
    });
    addEventListener("paste", (event) => {
      const files = [...(event.clipboardData?.files ?? [])];
      if (files.length && !typing(event)) void this.addAll(files);
    });
    model.on("clear", () => this.placeAll());
    bindKey({ section: "Review", keys: "Escape", does: "put the eyedropper away", on: (event) => this.picking && event.key === "Escape", run: () => this.pick(false) });
    this.update();
  }

  /** Keeps pictures next to the recipe. */
  private async addAll(files: File[]): Promise<void> {
    for (const file of files) {
      try {
        const picture = await encoded(file);
        this.model.say({ kind: "add_reference", name: file.name, picture });
        this.dock.open(this.tab);
      } catch {
        this.notices.show(`${file.name} cannot be read; add a picture, such as PNG or JPEG`, "bad");
      }
    }
  }

  private update(): void {
    const { references } = this.model;
    this.dock.update();
    if (!this.list.contains(document.activeElement) || document.activeElement?.tagName === "BUTTON") {
      const empty = h("li", { class: "nothing" }, "No reference pictures yet. Drop one here, paste it, or add a file.");
      this.list.replaceChildren(...(references.length ? references.map((one) => this.card(one)) : [empty]));
    }
    for (const [id, image] of this.images)
      if (!references.some((one) => one.id === id)) {
        image.remove();
        this.images.delete(id);
      }
    for (const one of references) {
      const image = this.images.get(one.id) ?? this.image(one.id);
      const address = this.model.pictures.get(`references/${one.id}`) ?? "";
      if (address && image.src !== address) image.src = address;
      image.alt = one.name;
    }
    this.placeAll();
  }

  private placeAll(): void {
    for (const one of this.model.references) this.place(one.id, one);
  }

  /** Shows a picture where a placement says. */
  private place(id: string, { mode, opacity, x, y, scale }: Placement): void {
    const image = this.images.get(id);
    if (!image) return;
    const { clear } = this.viewer;
    image.hidden = mode === "off";
    image.dataset["mode"] = mode;
    image.style.opacity = String(mode === "over" ? opacity : 1);
    const middle = toPixels([x, y], clear);
    image.style.left = `${middle.x}px`;
    image.style.top = `${middle.y}px`;
    image.style.height = `${scale * clear.height}px`;
  }

  /** A picture that is moved by dragging it, and scaled by the wheel. */
  private image(id: string): HTMLImageElement {
    const image = h("img", { class: "reference", draggable: "false", "data-id": id });
    let from: { x: number; y: number } | null = null;
    let moved: Placement | null = null;
    let wheeled: Placement | null = null; // answers to earlier turns of the wheel may arrive meanwhile
    image.addEventListener("pointerdown", (event) => {
      if (this.picking) {
        this.take(image, event);
        return;
      }
      from = { x: event.clientX, y: event.clientY };
      image.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    image.addEventListener("pointermove", (event) => {
      if (!from) return;
      const { height } = this.viewer.clear;
      const { mode, opacity, x, y, scale } = this.entry(id);
      moved = { mode, opacity, scale, x: x + (event.clientX - from.x) / height, y: y - (event.clientY - from.y) / height };
      this.place(id, moved);
    });
    for (const name of ["pointerup", "pointercancel"] as const)
      image.addEventListener(name, () => {
        if (moved) this.keep(id, moved);
        from = moved = null;
      });
    let rest = 0;
    image.addEventListener("wheel", (event) => {
      event.preventDefault();
      wheeled ??= { ...this.entry(id) };
      wheeled.scale = Math.min(20, Math.max(0.02, wheeled.scale * Math.exp(-0.001 * event.deltaY)));
      this.place(id, wheeled);
      clearTimeout(rest);
      rest = window.setTimeout(() => {
        if (wheeled) this.keep(id, wheeled);
        wheeled = null;
      }, 250);
    }, { passive: false });
    this.images.set(id, image);
    this.element.append(image);
    return image;
  }

  /** A picture as it is stored now. */
  private entry(id: string): Reference {
    return this.model.references.find((one) => one.id === id)!;
  }

  private keep(id: string, { mode, opacity, x, y, scale }: Placement): void {
    this.model.say({ kind: "place_reference", id, mode, opacity, x, y, scale });
  }

  private card(one: Reference): HTMLElement {
    const mode = h("select", { "aria-label": `Where ‘${one.name}’ is` });
    for (const [name, label] of Object.entries(MODES)) mode.append(h("option", { value: name }, label));
    mode.value = one.mode;
    mode.addEventListener("change", () => this.keep(one.id, { ...this.entry(one.id), mode: mode.value as Reference["mode"] }));
    const range = (label: string, name: "opacity" | "scale", min: number, max: number) => {
      const input = h("input", { type: "range", min, max, step: 0.01, "aria-label": `${label} of ‘${one.name}’`, title: label });
      input.value = String(one[name]);
      input.addEventListener("input", () => this.place(one.id, { ...this.entry(one.id), [name]: Number(input.value) }));
      input.addEventListener("change", () => this.keep(one.id, { ...this.entry(one.id), [name]: Number(input.value) }));
      return h("label", { class: "placing" }, h("span", {}, label), input);
    };
    const picture = h("img", { src: this.model.pictures.get(`references/${one.id}`), alt: "" });
    const remove = iconButton("bin", `Delete ‘${one.name}’`, () => this.model.say({ kind: "delete_reference", id: one.id }));
    return h(
      "li",
      { class: "card of-reference", "data-id": one.id },
      h("div", { class: "thumbnail" }, picture),
      h("div", { class: "card-head" }, h("span", { class: "by", title: one.name }, one.name), remove),
      mode,
      range("opacity", "opacity", 0, 1),
      range("size", "scale", 0.1, 2),
    );
  }

  /** Turns the eyedropper on or off. */
  private pick(on: boolean): void {
    const shown = this.model.references.some(({ mode }) => mode !== "off");
    this.picking = on && shown && this.model.role.leads;
    this.element.classList.toggle("picking", this.picking);
    this.tab.actions[0].setAttribute("aria-pressed", String(this.picking));
    if (on) this.notices.show(shown ? "Click on the hair in a reference picture" : "Show a reference picture first");
    if (this.picking) this.dock.uncover();
  }

  /** Sets the color of the hair to that of a picture under the pointer. */
  private take(image: HTMLImageElement, event: PointerEvent): void {
    event.preventDefault();
    const box = image.getBoundingClientRect();
    const [x, y] = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    this.model.say({ kind: "pick_color", color: colorAt(image, x, y) });
    this.pick(false);
  }
}

/** Mean color of a small patch of a picture, as `#rrggbb`; x and y are parts of its width and height. */
function colorAt(image: HTMLImageElement, x: number, y: number): string {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [PATCH, PATCH];
  const context = canvas.getContext("2d")!;
  const from = (part: number, size: number) => Math.min(Math.max(0, Math.round(part * size - PATCH / 2)), Math.max(0, size - PATCH));
  const { naturalWidth, naturalHeight } = image;
  context.drawImage(image, from(x, naturalWidth), from(y, naturalHeight), PATCH, PATCH, 0, 0, PATCH, PATCH);
  const { data } = context.getImageData(0, 0, PATCH, PATCH);
  const mean = [0, 1, 2].map((channel) => {
    let sum = 0;
    for (let k = channel; k < data.length; k += 4) sum += data[k];
    return Math.round(sum / (PATCH * PATCH));
  });
  return `#${mean.map((value) => value.toString(16).padStart(2, "0")).join("")}`;
}

/** A picture file as JPEG or PNG in base64, no larger than the server keeps. */
async function encoded(file: File): Promise<string> {
  const bitmap = await createImageBitmap(file);
  const scale = Math.min(1, LARGEST / Math.max(bitmap.width, bitmap.height));
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [Math.max(1, Math.round(bitmap.width * scale)), Math.max(1, Math.round(bitmap.height * scale))];
  canvas.getContext("2d")!.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
  const clear = file.type === "image/png" && file.size < 3_000_000 && scale === 1;
  return canvas.toDataURL(clear ? "image/png" : "image/jpeg", 0.92).split(",")[1];
}
