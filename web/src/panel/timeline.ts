// The frames of a shot or a cache: run, hold, go on, run again from a frame, scrub, and compare with another cache.
// They are with the server: here are those about the one that is seen, as many as fit. A chart in the dock shows their swing.

import "./floating_bar.css";
import "./timeline.css";
import { h, iconButton } from "../dom";
import type { Model } from "../model";
import type { DockTab } from "./dock";
import { bindKey, plainKey } from "./keys";
import { keptLabel, runHue, SwingChart } from "./swing";
import type { Frame, Timeline } from "../protocol";
import { OVERLAYS, overlayValues } from "../view/overlays";
import type { Side } from "../view/looks";
import type { Viewer } from "../view/viewer";

type Layer = "shot" | "against";
const LAYERS: Layer[] = ["shot", "against"];
const AHEAD = 16; // frames after the one that is seen that are asked for
const RATES = [6, 12, 24, 25, 30, 48, 60]; // of playback [frames a second]
const MOST = 256e6; // bytes of frames of a layer that are kept

export class TimelineBar {
  readonly element = h("section", { class: "timeline", hidden: true, "aria-label": "Frames" });
  private readonly frames: Record<Layer, Map<number, Frame>> = { shot: new Map(), against: new Map() };
  private readonly slider = h("input", { type: "range", step: 1, "aria-label": "Frame" });
  private readonly runs = h("div", { class: "runs", "aria-hidden": "true" });
  private readonly readout = h("output", { class: "frame-readout" });
  private readonly run = h("button", { type: "button", class: "primary" }, "Run");
  private readonly again = iconButton("again", "Run again from this frame, with the current settings", () =>
    this.model.say({ kind: "play", action: "again_from", frame: this.frame }),
  );
  private readonly watch = iconButton("play", "Play the simulated frames (space)", () => this.toggle());
  private readonly rate = h("select", { class: "rate", "aria-label": "Playback rate (frames per second)" });
  private readonly against = h("select", { "aria-label": "Compare runs and caches" });
  private readonly swing: SwingChart;
  private readonly chart = iconButton("chart", "Chart of the swing, and earlier runs", () => this.openChart());
  /** The chart, in the dock. */
  readonly tab: DockTab;
  /** Shows the chart, or no longer. */
  openChart = (_?: "shown"): void => {};
  /** What was asked for and has not come. */
  private readonly asked: Record<Layer, Set<number>> = { shot: new Set(), against: new Set() };
  private frame = 1;
  private key = -1;
  private compared = "";
  private drawn: Partial<Record<Layer, Frame>> = {};
  private playing = 0;
  /** First and last frame of what is played; none: that of the shot. */
  private range: { in: number | null; out: number | null } = { in: null, out: null };
  private follows = true;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly seen: (frame: Frame) => void,
  ) {
    this.swing = new SwingChart(model, (frame) => this.goTo(frame));
    this.tab = { title: "Chart", element: this.swing.element, actions: [], offered: () => model.timeline !== null, shown: () => this.swing.show(this.frame) };
    model.hear("frame", (frame) => this.add(frame));
    model.hear("hairs", ({ side }) => this.displaced(side));
    model.hear("locks", ({ side }) => this.displaced(side));
    model.on("measured", () => model.overlay && this.overlay());
    model.on("overlay", () => this.overlay());
    model.on("live", () => {
      this.displaced("a");
      this.draw();
    });
    this.against.addEventListener("change", () => this.compare(this.against.value));
    this.slider.addEventListener("input", () => this.goTo(Number(this.slider.value)));
    this.run.addEventListener("click", () => this.press());
    const frames = h("div", { class: "frames" }, this.slider, this.runs);
    this.element.append(this.run, this.again, this.watch, this.rate, frames, this.readout, this.against, this.chart);
    this.rate.addEventListener("change", () => {
      if (!this.playing) return;
      this.toggle(); // and again, at the new rate
      this.toggle();
    });
    for (const topic of ["timeline", "role", "files"] as const) model.on(topic, () => this.update());
    bindKey({ section: "Frames", keys: "Space", does: "play the simulated frames, or stop", on: (event) => model.timeline !== null && plainKey(" ")(event), run: () => this.toggle() });
    const mark = (event: KeyboardEvent) => model.timeline && this.mark(event.key.toLowerCase() === "i" ? "in" : "out");
    bindKey({ section: "Frames", keys: "I and O", does: "set the in or the out point of playback to this frame; press again to remove it", on: plainKey("i", "o"), run: mark });
    const jump = (event: KeyboardEvent) => this.jump(event.key === "Home" ? "first" : "last");
    bindKey({ section: "Frames", keys: "Home and End", does: "first frame, last frame of playback", on: plainKey("Home", "End"), run: jump });
    bindKey({ section: "Frames", keys: ", and .", does: "previous frame, next frame", on: plainKey(",", "."), run: (event) => this.by(event.key === "," ? -1 : 1) });
  }

  /** Compares with an earlier run, `run 2`, or a cache; with nothing for an empty name. */
  private compare(name: string): void {
    const run = this.model.timeline?.kept.find(({ number }) => name === `run ${number}`);
    this.model.say(run ? { kind: "against", run: run.number } : { kind: "against", name });
    if (run) this.openChart("shown");
  }

  /** Shows the frame that many frames on. */
  private by(frames: number): void {
    const { timeline } = this.model;
    if (!timeline) return;
    this.goTo(Math.min(timeline.last, Math.max(timeline.first, this.frame + frames)));
  }

  /** First and last frame of what is played. */
  private get span(): { first: number; last: number } {
    const { first, last } = this.model.timeline!;
    return { first: this.range.in ?? first, last: this.range.out ?? last };
  }

  private jump(to: "first" | "last"): void {
    if (!this.model.timeline) return;
    this.follows = false;
    this.show(this.span[to]);
  }

  /** Sets an end of what is played to this frame, or removes it; an end on the other side of it goes. */
  private mark(end: "in" | "out"): void {
    const { range, frame } = this;
    range[end] = range[end] === frame ? null : frame;
    if (range.in !== null && range.out !== null && range.in >= range.out) range[end === "in" ? "out" : "in"] = null;
    this.update();
    this.tell();
  }

  /** A frame has come. */
  private add(frame: Frame): void {
    const { layer } = frame;
    this.frames[layer].set(frame.frame, frame);
    this.asked[layer].delete(frame.frame);
    this.forget(layer);
    if (frame.frame === this.nearest(layer)) this.draw();
    else this.ask();
  }

  /** The frame that is seen; none without a timeline. */
  get current(): number | null {
    return this.model.timeline ? this.frame : null;
  }

  /** How many frames there are. */
  get count(): number {
    return this.model.timeline?.frames.length ?? 0;
  }

  /** Whether what is to be seen is here. */
  get settled(): boolean {
    return LAYERS.every((layer) => !this.there(layer).length || this.known(layer));
  }

  private there(layer: Layer): ArrayLike<number> {
    const { timeline } = this.model;
    return (layer === "shot" ? timeline?.frames : timeline?.against_frames) ?? [];
  }

  /** The frame of a layer that is seen: the nearest that there is. */
  private nearest(layer: Layer): number {
    const there = this.there(layer);
    return there[closest(there, this.frame)];
  }

  private known(layer: Layer): Frame | undefined {
    return this.frames[layer].get(this.nearest(layer));
  }

  /** Asks for the frames that are seen, and those after them, that are not here. */
  private ask(): void {
    const wanted = { shot: this.missing("shot"), against: this.missing("against") };
    if (!wanted.shot.length && !wanted.against.length) return;
    const onTheirWay = LAYERS.every((layer) => this.known(layer) || this.asked[layer].has(this.nearest(layer)));
    if (onTheirWay && LAYERS.some((layer) => this.asked[layer].size)) return;
    for (const layer of LAYERS) this.asked[layer] = new Set(wanted[layer]);
    this.model.say({ kind: "watch", ...wanted });
  }

  private missing(layer: Layer): number[] {
    const there = this.there(layer);
    const first = closest(there, this.frame);
    const some = this.frames[layer].values().next().value;
    const fit = some ? Math.max(1, Math.floor(MOST / 2 / some.points.buffer.byteLength)) : 1;
    return Array.from({ length: Math.min(AHEAD, fit, there.length) }, (_, k) => there[(first + k) % there.length]).filter(
      (frame) => !this.frames[layer].has(frame),
    );
  }

  /** Lets go of the frames farthest from the one that is seen, where there are too many. */
  private forget(layer: Layer): void {
    const held = this.frames[layer];
    let size = 0;
    for (const frame of held.values()) size += frame.points.buffer.byteLength;
    const seen = this.nearest(layer);
    for (const [number, frame] of [...held].sort(([a], [b]) => Math.abs(b - seen) - Math.abs(a - seen))) {
      if (size <= MOST || number === seen) return;
      held.delete(number);
      size -= frame.points.buffer.byteLength;
    }
  }

  private press(): void {
    const state = this.model.timeline?.state;
    this.follows = true;
    if (state === "running" || state === "rolling") this.model.say({ kind: "play", action: "pause" });
    else if (state === "paused") this.model.say({ kind: "play", action: "go_on" });
    else this.model.say({ kind: "play", action: "start" });
  }

  private update(): void {
    const { timeline, role } = this.model;
    this.element.toggleAttribute("hidden", !timeline);
    if (!timeline) return;
    if (timeline.key !== this.key) {
      this.key = timeline.key;
      for (const layer of LAYERS) this.drop(layer);
    }
    if (timeline.against !== this.compared) {
      this.compared = timeline.against;
      this.drop("against");
    }
    const ready = timeline.frames.at(-1);
    this.runs.replaceChildren(...runMarks(timeline), ...this.rangeMarks(timeline));
    this.offerRates(timeline.fps);
    this.slider.min = String(timeline.first);
    this.slider.max = String(timeline.last);
    const there =
      ready === undefined ? 0 : (ready - timeline.first) / Math.max(1, timeline.last - timeline.first);
    this.slider.style.setProperty("--part", `${100 * there}%`);
    const label = { none: "", still: "Run", rolling: "Pause", running: "Pause", paused: "Continue", done: "Run again" }[
      timeline.state
    ];
    this.run.textContent = label;
    this.run.toggleAttribute("hidden", timeline.state === "none");
    this.run.toggleAttribute("disabled", !role.leads);
    this.again.toggleAttribute("hidden", timeline.state === "none");
    this.again.toggleAttribute("disabled", !role.leads || ready === undefined || timeline.state === "rolling");
    const caches = this.model.files.filter((name) => /\.usd[ac]?$/.test(name));
    const value = timeline.against;
    this.against.replaceChildren(
      h("option", { value: "" }, value ? "End the comparison" : "Compare runs …"),
      ...group("Earlier runs", timeline.kept.map((kept): [string, string] => [`run ${kept.number}`, keptLabel(kept)])),
      ...group("Caches", caches.map((name): [string, string] => [name, name])),
    );
    this.against.value = value;
    this.against.toggleAttribute("hidden", timeline.state === "none");
    this.against.toggleAttribute("disabled", !role.leads);
    if (this.follows && ready !== undefined) this.show(ready);
    else this.draw();
  }

  private offerRates(fps: number): void {
    const chosen = this.rate.value;
    const others = RATES.filter((rate) => rate !== fps);
    this.rate.replaceChildren(h("option", { value: "" }, `${fps} fps`), ...others.map((rate) => h("option", { value: String(rate) }, `${rate} fps`)));
    this.rate.value = others.includes(Number(chosen)) ? chosen : "";
  }

  /** What is left out of playback, shaded. */
  private rangeMarks({ first, last }: Timeline): HTMLElement[] {
    const length = Math.max(1, last - first);
    const parts: [number, number][] = [[first, this.span.first], [this.span.last, last]];
    return parts
      .filter(([from, to]) => to > from)
      .map(([from, to]) => h("i", { class: "left-out", style: `left: ${(100 * (from - first)) / length}%; width: ${(100 * (to - from)) / length}%` }));
  }

  /** What is here of a layer is no longer true. */
  private drop(layer: Layer): void {
    this.frames[layer].clear();
    this.asked[layer].clear();
  }

  /** Hair has gone from where a frame had put it. */
  private displaced(side: Side): void {
    if (side === "c" || side === "d") return;
    delete this.drawn[side === "a" ? "shot" : "against"];
  }

  /** A server that knows nothing of what was asked for has been found. */
  found(): void {
    for (const layer of LAYERS) this.asked[layer].clear();
    this.ask();
  }

  private toggle(): void {
    if (this.playing) {
      clearInterval(this.playing);
      this.playing = 0;
    } else {
      this.follows = false;
      const fps = Number(this.rate.value) || (this.model.timeline?.fps ?? 24);
      this.playing = window.setInterval(() => this.next(), 1000 / fps);
    }
    this.watch.setAttribute("aria-pressed", String(this.playing !== 0));
  }

  /** The next frame, once this one is here. */
  private next(): void {
    if (!this.model.timeline || !this.settled) return;
    const { first, last } = this.span;
    const played = this.model.timeline.frames.filter((frame) => frame >= first && frame <= last);
    if (played.length) this.show(played.find((frame) => frame > this.frame) ?? played[0]);
  }

  /** Shows a frame from now on, whichever come. */
  goTo(frame: number): void {
    this.follows = false;
    this.show(frame);
  }

  /** Shows a frame, or the nearest that is there, as soon as it has come. */
  show(frame: number): void {
    if (frame !== this.frame) this.model.tell("look");
    this.frame = frame;
    this.slider.value = String(frame);
    this.draw();
  }

  private draw(): void {
    for (const [layer, side] of [
      ["shot", "a"],
      ["against", "b"],
    ] as const) {
      if (side === "a" && this.model.live.on) continue; // it moves live
      const known = this.known(layer);
      if (!known || known === this.drawn[layer]) continue;
      this.drawn[layer] = known;
      this.tint(layer);
      this.viewer.hair[side].place(known);
      this.viewer.placeBodies(side, known.bodies);
      this.viewer.move();
    }
    this.tell();
    this.ask();
  }

  /** Another overlay is wanted, or what it shows has come. */
  private overlay(): void {
    this.tint("shot");
    this.tint("against");
    this.viewer.invalidate();
  }

  private tint(layer: Layer): void {
    const { overlay, measured } = this.model;
    const frame = this.known(layer);
    const hair = layer === "shot" ? this.viewer.hair.a : this.viewer.hair.b;
    hair.setOverlay(overlayValues(overlay, frame, measured), overlay !== "" && OVERLAYS[overlay].diverging);
  }

  private tell(): void {
    const { timeline } = this.model;
    this.model.tell("frame");
    if (!timeline) return;
    const known = this.known("shot");
    const stretch = known?.statistics["max_stretch"];
    if (known) this.seen(known);
    this.swing.show(this.frame);
    const parts = [`frame ${this.frame}`];
    if (timeline.state === "rolling") parts[0] = `before the first frame: ${timeline.rolled} of ${timeline.preroll}`;
    else if (!timeline.frames.length) parts[0] = "not simulated";
    else {
      const at = closest(timeline.frames, this.frame);
      if (timeline.stale[at]) parts.push(`of run ${timeline.runs[at]}, with other settings`);
    }
    const { in: from, out: to } = this.range;
    if (from !== null || to !== null) parts.push(`plays ${this.span.first} to ${this.span.last}`);
    if (typeof stretch === "number") parts.push(`stretch up to ${(100 * stretch).toFixed(1)} %`);
    this.readout.textContent = parts.join(" · ");
  }
}

/** Marks below the slider: one color a run, hatched where its settings are no longer those of the shot. */
function runMarks({ frames, runs, stale, first, last }: Timeline): HTMLElement[] {
  const marks: HTMLElement[] = [];
  const span = Math.max(1, last - first);
  for (let from = 0, to = 0; from < frames.length; from = to) {
    while (to < frames.length && runs[to] === runs[from] && stale[to] === stale[from]) to++;
    if (!runs[from]) continue;
    const mark = h("span", { class: stale[from] ? "stale" : "" });
    mark.style.setProperty("--hue", String(runHue(runs[from])));
    mark.style.left = `${(100 * (frames[from] - first)) / span}%`;
    mark.style.width = `max(3px, ${(100 * (frames[to - 1] - frames[from])) / span}%)`;
    marks.push(mark);
  }
  return marks;
}

/** Options with a heading; none for no choices. */
function group(label: string, choices: [string, string][]): HTMLElement[] {
  const options = choices.map(([value, text]) => h("option", { value }, text));
  return options.length ? [h("optgroup", { label }, ...options)] : [];
}

/** The place of the number that is nearest to another; numbers are in order. */
function closest(numbers: ArrayLike<number>, to: number): number {
  let best = 0;
  for (let k = 1; k < numbers.length; k++)
    if (Math.abs(numbers[k] - to) <= Math.abs(numbers[best] - to)) best = k;
  return best;
}
