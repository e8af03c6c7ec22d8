// Render in place: the path-traced picture of what is seen, over the live one, with a wipe between them.

import "./render.css";
import { h, iconButton } from "../dom";
import type { Model } from "../model";
import type { Render, Rendered } from "../protocol";
import { keep } from "../view/capture";
import type { Size } from "../view/box";
import type { Viewer } from "../view/viewer";
import { bindKey, plainKey } from "./keys";
import type { Viewbar } from "./viewbar";
import { WipeLine } from "./wipe_line";

const SAMPLES = [16, 64, 256];
const MOST_PIXELS = 2048; // along a side

/** A rendered picture and what it is of, so that it can be kept. */
export interface RenderedPicture {
  png: Blob;
  samples: number;
  request: Render;
}

export class RenderPanel {
  readonly element: HTMLElement;
  /** The picture as it is so far. */
  picture: RenderedPicture | null = null;
  private request: Render | null = null;
  private number = 0;
  private readonly image = h("img", { alt: "Path-traced picture", draggable: "false" });
  private readonly frame = h("div", { class: "rendered" }, this.image);
  private readonly state = h("output", { class: "render-state", role: "status" });
  /** Since when the picture is awaited. */
  private began = 0;
  private ticking = 0;
  private readonly samples = h("select", { "aria-label": "Samples per pixel" });
  private readonly stopping = h("button", { type: "button", class: "quiet", onclick: () => this.stop() }, "Stop");
  private readonly saving = h("button", { type: "button", class: "quiet", onclick: () => this.save() }, "Save PNG");
  private readonly line = new WipeLine("Wipe between render and live picture", (at) => this.wipe(at));

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly viewbar: Viewbar,
    private readonly name: () => string,
  ) {
    for (const count of SAMPLES) this.samples.append(h("option", { value: String(count) }, `${count} samples`));
    this.samples.value = "64";
    this.samples.addEventListener("change", () => this.start());
    const close = h("button", { type: "button", class: "quiet", onclick: () => this.close() }, "Close");
    const bar = h("div", { class: "render-bar" }, this.state, this.samples, this.stopping, this.saving, close);
    this.element = h("section", { class: "render", hidden: true, "aria-label": "Render" }, this.frame, this.line.element, bar);
    viewbar.element.append(iconButton("render", "Render (R)", () => this.start()));
    bindKey({ section: "View", keys: "R", does: "render the picture, path-traced", on: plainKey("r"), run: () => this.start() });
    model.hear("rendered", (message) => this.show(message));
    model.hear("trouble", ({ message }) => {
      if (message.startsWith("render:") || message.startsWith("picture:")) this.fail();
    });
    model.on("look", () => this.followLook());
    model.on("compared", () => viewer.compared && this.close());
    model.on("numbers", () => this.tell());
  }

  /** Renders what is seen, in place of the last render. */
  start(size: Size = this.viewer.clear): void {
    if (this.viewer.compared) return;
    const request = this.seen(size);
    if (!request.width || !request.height) return;
    this.number += 1;
    this.viewer.stay();
    this.request = { ...request, number: this.number };
    this.picture = null;
    this.revision = this.model.numbers?.revision ?? 0;
    this.element.hidden = false;
    this.image.hidden = true;
    this.wipe(1);
    this.began = performance.now();
    clearInterval(this.ticking);
    this.ticking = window.setInterval(() => this.tell(), 1000);
    this.model.say(this.request);
    this.tell();
  }

  /** A step of a render has arrived. */
  private show(message: Rendered): void {
    if (!this.request || message.number !== this.request.number) return;
    const png = new Blob([message.png as Uint8Array<ArrayBuffer>], { type: "image/png" });
    this.picture = { png, samples: message.samples, request: this.request };
    URL.revokeObjectURL(this.image.src);
    this.image.src = URL.createObjectURL(png);
    this.image.hidden = false;
    this.tell();
  }

  /** The render cannot be made. */
  private fail(): void {
    if (this.request && !this.done && !this.picture) this.close();
  }

  close(): void {
    if (!this.request) return;
    this.stop();
    this.request = this.picture = null;
    this.tell();
    this.element.hidden = true;
  }

  private revision = 0;

  private get done(): boolean {
    return !this.request || (this.picture?.samples ?? 0) >= (this.request.samples ?? 0);
  }

  /** What is seen now, as a request. */
  private seen(size: Size): Render {
    const part = Math.min(1, MOST_PIXELS / Math.max(size.width, size.height, 1));
    return {
      kind: "render",
      number: 0,
      ...this.viewer.cameraState,
      width: Math.round(size.width * part),
      height: Math.round(size.height * part),
      samples: Number(this.samples.value),
      light: this.viewbar.light.value,
      color: this.viewbar.color.value,
    };
  }

  /** A picture of another view, light or color is not that of what is seen. */
  private followLook(): void {
    if (!this.request) return;
    const now = this.seen(this.viewer.clear);
    const then = this.request;
    const kept = ["camera", "focal_length", "light", "light_turn", "color"] as const;
    if (kept.some((name) => JSON.stringify(now[name]) !== JSON.stringify(then[name]))) this.close();
  }

  private stop(): void {
    if (!this.done) this.model.say({ kind: "stop_render" });
    if (this.request && this.picture) this.request.samples = this.picture.samples;
    this.tell();
  }

  private save(): void {
    if (this.picture) keep(this.picture.png, `${this.name()}_render.png`);
  }

  private tell(): void {
    const { request, picture, model } = this;
    if (!request || picture) clearInterval(this.ticking);
    if (!request) return;
    const earlier = (model.numbers?.revision ?? 0) !== this.revision ? ", of an earlier groom" : "";
    const count = picture ? `${picture.samples} of ${request.samples} samples` : `Starting, ${Math.floor((performance.now() - this.began) / 1000)} s`;
    this.state.textContent = `${this.done ? `Rendered, ${picture?.samples} samples` : count}${earlier}`;
    this.state.setAttribute("aria-live", picture ? "polite" : "off"); // seconds are seen, not said
    this.stopping.hidden = this.done;
    this.saving.hidden = !picture;
    this.line.element.hidden = !picture;
  }

  private wipe(at: number): void {
    this.frame.style.clipPath = `inset(0 ${100 * (1 - at)}% 0 0)`;
    this.line.place(at);
  }
}
