// The chart of a shot: how fast tips and roots move in each frame, and the earlier takes of the shot, each with
// the frames that it has. A take is a button that compares it.

import "./swing.css";
import { h } from "../dom";
import type { Model } from "../model";
import type { KeptRun, Timeline } from "../protocol";

const NS = "http://www.w3.org/2000/svg";
const [WIDTH, HEIGHT] = [1000, 100]; // of the chart, which is stretched to its place
const NUMBERS = 3; // of a frame: speed of tips, of roots, and the motion kept

/** One of the numbers of each frame. */
interface Series {
  frames: ArrayLike<number>;
  swings: Float32Array;
  number: number;
}

/** Color of a run, by its number. */
export const runHue = (run: number): number => (25 + 137 * (run - 1)) % 360;

/** What an earlier take is, in words. */
export function keptLabel({ number, changes, same_groom }: KeptRun): string {
  const what = changes.slice(0, 2).map((change) => change.replace(/^(.*) = –$/, "$1 by default"));
  if (changes.length > 2) what.push(`${changes.length - 2} more`);
  if (!same_groom) what.unshift("another groom");
  return [`run ${number}`, ...what].join(" · ");
}

export class SwingChart {
  readonly element = h("div", { class: "swing" });
  private readonly takes = h("div", { class: "takes" });
  private readonly chart = document.createElementNS(NS, "svg");
  private readonly scale = h("span", { class: "swing-scale" });
  private readonly legend = h("div", { class: "swing-legend" });
  private readonly nothing = h("p", {});
  private readonly plot = h("div", { class: "swing-plot" }, this.chart, this.scale, this.nothing);
  private readonly use = h("button", { type: "button", class: "quiet", hidden: true }, "Use its settings");

  /** goTo: shows a frame */
  constructor(
    private readonly model: Model,
    private readonly goTo: (frame: number) => void,
  ) {
    this.chart.setAttribute("viewBox", `0 0 ${WIDTH} ${HEIGHT}`);
    this.chart.setAttribute("preserveAspectRatio", "none");
    this.chart.setAttribute("role", "img");
    this.chart.setAttribute("aria-label", "Swing of the tips");
    this.element.append(this.takes, this.plot, h("div", { class: "swing-foot" }, this.legend, this.use));
    const scrub = (event: PointerEvent) => event.buttons & 1 && this.goTo(this.frameAt(event));
    this.chart.addEventListener("pointerdown", scrub);
    this.chart.addEventListener("pointermove", scrub);
    this.use.addEventListener("click", () => this.compared && model.say({ kind: "use_run", run: this.compared.number }));
  }

  /** The earlier take that is compared. */
  private get compared(): KeptRun | undefined {
    const { timeline } = this.model;
    return timeline?.kept.find(({ number }) => timeline.against === `run ${number}`);
  }

  /** Whether hair touches in the shot. */
  private get touches(): boolean {
    return this.model.value("shot", ["contact", "on"]) === true;
  }

  private frameAt(event: PointerEvent): number {
    const { first, last } = this.model.timeline!;
    const box = this.chart.getBoundingClientRect();
    const part = Math.min(1, Math.max(0, (event.clientX - box.left) / box.width));
    return Math.round(first + part * (last - first));
  }

  /** Draws the takes and the chart, with a mark at a frame. */
  show(frame: number): void {
    const { timeline, role } = this.model;
    if (this.element.parentElement?.hidden || !timeline) return;
    const { compared } = this;
    this.takes.replaceChildren(...timeline.kept.map((take) => this.take(take, take === compared)));
    this.use.hidden = !compared;
    this.use.disabled = !role.leads;
    const nothing = absence(timeline);
    this.nothing.textContent = nothing;
    this.chart.toggleAttribute("hidden", nothing !== "");
    if (nothing) {
      this.scale.textContent = "";
      this.legend.replaceChildren();
      return;
    }
    const tips = { frames: timeline.frames, swings: timeline.swings, number: 0 };
    const others = { frames: timeline.against_frames, swings: timeline.against_swings, number: 0 };
    const roots = { ...tips, number: 1 };
    const kept = { ...tips, number: 2 };
    const top = Math.max(1e-3, ...[tips, roots, others].flatMap((one) => values(one)).map(([, value]) => value));
    const run = timeline.runs.at(-1) ?? 1;
    this.chart.replaceChildren(
      line(timeline, kept, 1, "kept"),
      line(timeline, roots, top, "roots"),
      ...(compared ? [line(timeline, others, top, "tips other", compared.number)] : []),
      ...[...new Set(timeline.runs)].map((run) => line(timeline, madeBy(timeline, run), top, "tips", run)),
      mark(timeline, frame),
    );
    this.scale.textContent = speed(top);
    const entry = (series: Series, name: string, kind: string, text: (value: number) => string, of = run) => {
      const value = values(series).find(([at]) => at === frame)?.[1];
      const style = `--hue: ${runHue(of)}`;
      return h("span", {}, h("i", { class: kind, style }), `${name} `, h("b", {}, value === undefined ? "–" : text(value)));
    };
    const free = compared && `${this.touches && !compared.contact ? "free swing, without contact," : "tips"} of run ${compared.number}`;
    this.legend.replaceChildren(
      h("span", { class: "swing-title" }, "Mean speed of"),
      entry(tips, "tips", "tips", speed),
      ...(compared ? [entry(others, free!, "tips other", speed, compared.number)] : []),
      entry(roots, "roots", "roots", speed),
      ...(timeline.against && !compared ? [h("span", {}, `${timeline.against} has no speeds: a cache holds positions alone`)] : []),
      ...(values(kept).length ? [entry(kept, "motion kept, estimated", "kept", (value) => `${Math.round(100 * value)} %`)] : []),
    );
    const highest = (series: Series) => speed(Math.max(0, ...values(series).map(([, value]) => value)));
    this.chart.setAttribute("aria-label", `Mean speed in each frame: tips up to ${highest(tips)}, roots up to ${highest(roots)}`);
  }

  private take(take: KeptRun, pressed: boolean): HTMLElement {
    const { first, last } = this.model.timeline!;
    const span = Math.max(1, last - first);
    const label = keptLabel(take);
    const bar = h("i", { class: "stale" });
    bar.style.left = `${(100 * (take.first - first)) / span}%`;
    bar.style.width = `max(3px, ${(100 * (take.last - take.first)) / span}%)`;
    const title = pressed ? "End the comparison" : "Compare with this run";
    const button = h("button", { type: "button", class: "take", title, "aria-pressed": String(pressed), style: `--hue: ${runHue(take.number)}` }, bar, h("span", {}, label));
    button.disabled = !this.model.role.leads;
    button.addEventListener("click", () => this.model.say({ kind: "against", run: pressed ? 0 : take.number }));
    return button;
  }
}

/** Why there is no chart; empty where there is one. */
function absence({ state, frames }: Timeline): string {
  if (state === "none") return "A cache holds positions, not speeds, and has no chart of its swing. Open its shot and run it to see one.";
  return frames.length ? "" : "No frames are simulated yet. “Run” simulates them, and draws the speed of their tips here.";
}

/** Frames and their numbers, where these are known. */
function values({ frames, swings, number }: Series): [number, number][] {
  return Array.from(frames, (frame, k): [number, number] => [frame, swings[NUMBERS * k + number] ?? NaN]).filter(([, value]) => !Number.isNaN(value));
}

/** Speeds of the tips in the frames of one run, and in the one before, from which its line goes on. */
function madeBy({ frames, runs, swings }: Timeline, run: number): Series {
  const from = runs.indexOf(run);
  const chosen = Array.from(frames.keys()).filter((k) => runs[k] === run || k === from - 1);
  return {
    frames: chosen.map((k) => frames[k]),
    swings: Float32Array.from(chosen.flatMap((k) => [...swings.slice(NUMBERS * k, NUMBERS * (k + 1))])),
    number: 0,
  };
}

function line({ first, last }: Timeline, series: Series, top: number, kind: string, run = 1): SVGElement {
  const drawn = document.createElementNS(NS, "polyline");
  const span = Math.max(1, last - first);
  const points = values(series).map(([frame, value]) => `${(WIDTH * (frame - first)) / span},${HEIGHT * (1 - 0.94 * Math.min(1, value / top))}`);
  drawn.setAttribute("points", points.join(" "));
  drawn.setAttribute("class", kind);
  drawn.style.setProperty("--hue", String(runHue(run)));
  return drawn;
}

function mark({ first, last }: Timeline, frame: number): SVGElement {
  const drawn = document.createElementNS(NS, "line");
  const x = String((WIDTH * (frame - first)) / Math.max(1, last - first));
  for (const [name, value] of Object.entries({ x1: x, x2: x, y1: "0", y2: String(HEIGHT), class: "now" })) drawn.setAttribute(name, value);
  return drawn;
}

/** A speed in words; v: in metres a second. */
const speed = (v: number): string => `${(100 * v).toPrecision(v < 0.1 ? 2 : 3)} cm/s`;
