// The frames of a shot or a cache: run, hold, go on, run again from a frame, scrub, and compare with another cache.

import { h, iconButton } from "../dom";
import type { Model } from "../model";
import type { Frame } from "../protocol";
import { OVERLAYS, overlayValues } from "../view/overlays";
import type { Viewer } from "../view/viewer";

type Layer = "shot" | "against";

export class TimelineBar {
  readonly element = h("section", { class: "timeline", hidden: true, "aria-label": "Frames" });
  private readonly frames: Record<Layer, Map<number, Frame>> = { shot: new Map(), against: new Map() };
  private readonly slider = h("input", { type: "range", step: 1, "aria-label": "Frame" });
  private readonly told = h("output", { class: "frame-told" });
  private readonly run = h("button", { type: "button", class: "primary" }, "Run");
  private readonly again = iconButton("again", "Run again from this frame, with the settings as they are", () =>
    this.model.say({ kind: "play", action: "again_from", frame: this.frame }),
  );
  private readonly watch = iconButton("play", "Play what is there (space)", () => this.toggle());
  private readonly against = h("select", { "aria-label": "Compare with a cache" });
  private frame = 1;
  private key = -1;
  private playing = 0;
  private follows = true;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly seen: (frame: Frame) => void,
  ) {
    model.on("overlay", () => this.overlay());
    this.against.addEventListener("change", () => model.say({ kind: "against", name: this.against.value }));
    this.slider.addEventListener("input", () => {
      this.follows = false;
      this.show(Number(this.slider.value));
    });
    this.run.addEventListener("click", () => this.press());
    this.element.append(this.run, this.again, this.watch, this.slider, this.told, this.against);
    model.on("timeline", () => this.update());
    model.on("role", () => this.update());
    addEventListener("keydown", (event) => {
      if (event.key !== " " || (event.target as HTMLElement).closest("button, input, select, textarea, dialog")) return;
      if (!model.timeline) return;
      event.preventDefault();
      this.toggle();
    });
  }

  /** A frame has come. The latest is shown as long as nobody has gone elsewhere. */
  add(frame: Frame): void {
    this.frames[frame.layer].set(frame.frame, frame);
    if (frame.layer === "against") this.show(this.frame);
    else if (this.follows) this.show(frame.frame);
  }

  /** How many frames there are. */
  get count(): number {
    return this.frames.shot.size;
  }

  private press(): void {
    const state = this.model.timeline?.state;
    this.follows = true;
    if (state === "running" || state === "rolling") this.model.say({ kind: "play", action: "pause" });
    else if (state === "paused") this.model.say({ kind: "play", action: "go_on" });
    else this.model.say({ kind: "play", action: "start" });
  }

  private update(): void {
    const { timeline, role, welcome } = this.model;
    this.element.toggleAttribute("hidden", !timeline);
    document.documentElement.classList.toggle("with-timeline", timeline !== null);
    if (!timeline) return;
    if (timeline.key !== this.key) {
      this.key = timeline.key;
      for (const frame of this.frames.shot.keys())
        if (timeline.ready === null || frame > timeline.ready) this.frames.shot.delete(frame);
    }
    if (!timeline.against) this.frames.against.clear();
    this.slider.min = String(timeline.first);
    this.slider.max = String(timeline.last);
    const there =
      timeline.ready === null ? 0 : (timeline.ready - timeline.first) / Math.max(1, timeline.last - timeline.first);
    this.slider.style.setProperty("--part", `${100 * there}%`);
    const label = { none: "", still: "Run", rolling: "Pause", running: "Pause", paused: "Continue", done: "Run again" }[
      timeline.state
    ];
    this.run.textContent = label;
    this.run.toggleAttribute("hidden", timeline.state === "none");
    this.run.toggleAttribute("disabled", !role.leads);
    this.again.toggleAttribute("hidden", timeline.state === "none");
    this.again.toggleAttribute("disabled", !role.leads || timeline.ready === null || timeline.state === "rolling");
    const caches = (welcome?.files ?? []).filter((name) => /\.usd[ac]?$/.test(name));
    const value = timeline.against;
    this.against.replaceChildren(
      h("option", { value: "" }, value ? "end the comparison" : "compare with a cache …"),
      ...caches.map((name) => h("option", { value: name }, name)),
    );
    this.against.value = value;
    this.against.toggleAttribute("hidden", timeline.state === "none");
    this.against.toggleAttribute("disabled", !role.leads);
    this.tell();
  }

  private toggle(): void {
    if (this.playing) {
      clearInterval(this.playing);
      this.playing = 0;
    } else {
      this.follows = false;
      const fps = this.model.timeline?.fps ?? 24;
      this.playing = window.setInterval(() => this.next(), 1000 / fps);
    }
    this.watch.setAttribute("aria-pressed", String(this.playing !== 0));
  }

  private next(): void {
    const numbers = [...this.frames.shot.keys()].sort((a, b) => a - b);
    if (numbers.length) this.show(numbers.find((frame) => frame > this.frame) ?? numbers[0]);
  }

  /** Shows a frame, or the nearest that is there. */
  show(frame: number): void {
    this.frame = frame;
    this.slider.value = String(frame);
    for (const [layer, hair] of [
      ["shot", this.viewer.hair.a],
      ["against", this.viewer.hair.b],
    ] as const) {
      const known = this.frames[layer].get(nearest(this.frames[layer], frame));
      if (!known) continue;
      this.tint(layer);
      hair.place(known.points, known.axis, known.root);
      if (layer === "shot") this.viewer.placeBodies(known.bodies);
    }
    this.viewer.move();
    this.tell();
  }

  /** Another overlay is wanted, or what it shows has come. */
  overlay(): void {
    this.tint("shot");
    this.tint("against");
    this.viewer.invalidate();
  }

  private tint(layer: Layer): void {
    const { overlay, measured } = this.model;
    const frame = this.frames[layer].get(nearest(this.frames[layer], this.frame));
    const hair = layer === "shot" ? this.viewer.hair.a : this.viewer.hair.b;
    hair.setOverlay(overlayValues(overlay, frame, measured), overlay !== "" && OVERLAYS[overlay].diverging);
  }

  private tell(): void {
    const { timeline } = this.model;
    if (!timeline) return;
    const known = this.frames.shot.get(this.frame);
    const stretch = known?.statistics["max_stretch"];
    if (known) this.seen(known);
    const parts = [`frame ${this.frame}`];
    if (timeline.state === "rolling") parts[0] = `before the first frame: ${timeline.rolled} of ${timeline.preroll}`;
    else if (!known && timeline.ready === null) parts[0] = "not run yet";
    else if (typeof stretch === "number") parts.push(`stretched ${(100 * stretch).toFixed(1)} % at most`);
    this.told.textContent = parts.join(" · ");
  }
}

function nearest(frames: Map<number, Frame>, frame: number): number {
  let best = Number.NaN;
  for (const one of frames.keys()) if (!(Math.abs(best - frame) <= Math.abs(one - frame))) best = one;
  return best;
}
