// Takes of live hair: the last seconds are kept as a snapshot, and play where it is compared. Where the take of a shot is
// compared with its frames, it goes with the timeline.

import "./takes.css";
import { h, iconButton } from "../dom";
import type { Model } from "../model";
import type { LiveTake } from "../protocol";
import { Take } from "../view/take";
import type { Arrangement, Side } from "../view/looks";
import type { Viewer } from "../view/viewer";
import { compareWith } from "./compare";
import { openDialog } from "./dialog";
import { bindKey, plainKey } from "./keys";
import type { TimelineBar } from "./timeline";

export class TakePlayer {
  readonly element = h("div", { class: "take-player", hidden: true, role: "group", "aria-label": "Take of live hair" });
  /** In the line of live hair. */
  readonly keep: HTMLButtonElement;
  private readonly button = iconButton("pause", "Pause the take (space)", () => this.toggle());
  private readonly slider = h("input", { type: "range", min: 0, step: 1, "aria-label": "Step of the take" });
  private readonly readout = h("output", {});
  private readonly takes = new Map<Side, Take>();
  private readonly drawn = new Map<Side, number>();
  /** When step 0 was to be seen [ms]. */
  private begun = 0;
  private asked = 0;
  /** The snapshot whose take is to be seen in an arrangement, and how looks were arranged before. */
  private wanted: { id: string; arrangement: Arrangement } | null = null;
  private before: Arrangement | null = null;

  /** keep: keeps the last seconds as a snapshot */
  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly timeline: TimelineBar,
    keep: () => void,
  ) {
    const title = "Keep the last 5 seconds as a snapshot that plays (K)";
    this.keep = h("button", { type: "button", class: "quiet keep-take", title, onclick: keep }, "Keep take");
    this.element.append(this.button, this.slider, this.readout);
    this.slider.addEventListener("input", () => this.stand(Number(this.slider.value)));
    model.hear("live_take", (message) => this.add(message));
    model.on("compared", () => this.compared());
    model.hear("trouble", () => (this.wanted = null)); // it may have been refused
    for (const kind of ["hairs", "locks", "body"] as const)
      model.hear(kind, () => {
        this.drawn.clear(); // they came at rest
        this.draw();
      });
    for (const topic of ["frame", "timeline", "live", "step"] as const) model.on(topic, () => this.draw());
    bindKey({ section: "Review", keys: "K", does: "keep the last seconds of live hair as a snapshot", on: (event) => model.live.on && plainKey("k")(event), run: keep });
    bindKey({ section: "Review", keys: "Space", does: "play the take that is compared, or stop", on: (event) => this.takes.size > 0 && plainKey(" ")(event), run: () => this.toggle() });
  }

  /** Shows the take of a snapshot alone, as it plays. */
  play(id: string): void {
    this.wanted = { id, arrangement: "flip" };
    if (this.sideOf(id)) this.compared();
    else compareWith(this.model, `snapshot:${id}`);
  }

  /** Asks for a name, and makes a shot of the take of a snapshot, which is then compared with it by a wipe. */
  makeShot(id: string): void {
    const name = h("input", { type: "text", maxlength: 80, placeholder: "a name that is free", "aria-label": "Name of the shot" });
    const make = h("button", { type: "button", class: "primary" }, "Make the shot");
    const what = "Writes a shot with the motion of the head, the material and the recipe of the take, opens it, and simulates it in contact.";
    const dialog = openDialog("Make a shot of the take", h("p", {}, what), name, make);
    const say = () => {
      this.wanted = { id, arrangement: "wipe" };
      this.model.say({ kind: "make_shot", id, name: name.value.trim() });
      dialog.close();
    };
    make.addEventListener("click", say);
    name.addEventListener("keydown", (event) => {
      if (event.key !== "Enter") return;
      event.preventDefault();
      say();
    });
    name.focus();
  }

  private sideOf(id: string): Side | undefined {
    return this.model.others.find((side) => this.model.compared[side]?.take === id);
  }

  private add(message: LiveTake): void {
    const { side, id } = message;
    if (this.model.compared[side]?.take !== id) return;
    if (!this.takes.size) this.begun = performance.now();
    this.takes.set(side, new Take(message));
    this.drawn.delete(side);
    this.update();
    this.draw();
  }

  /** Other looks are compared: takes of those that are not are forgotten. */
  private compared(): void {
    const { model, viewer } = this;
    for (const [side, take] of this.takes)
      if (model.compared[side]?.take !== take.message.id) {
        this.takes.delete(side);
        viewer.putAtRest(side);
      }
    if (!model.others.length) {
      model.step = null;
      viewer.looks.arrangement = this.before ?? viewer.looks.arrangement;
      this.before = null;
    }
    const { wanted } = this;
    const side = wanted && this.sideOf(wanted.id);
    if (side) {
      this.wanted = null;
      this.before ??= viewer.looks.arrangement;
      Object.assign(viewer.looks, { arrangement: wanted.arrangement, front: side });
      viewer.invalidate();
      model.tell("arranged");
      model.tell("look");
    }
    this.update();
  }

  private update(): void {
    this.element.hidden = !this.takes.size;
    this.slider.max = String(this.length - 1);
  }

  /** Steps of the longest take. */
  private get length(): number {
    return Math.max(1, ...[...this.takes.values()].map((take) => take.length));
  }

  private get fps(): number {
    return Math.max(...[...this.takes.values()].map(({ message }) => message.fps));
  }

  /** The frame of the shot that a take goes with; null where it plays by itself. */
  private frameOf({ message }: Take): number | null {
    const { timeline, model } = this;
    return message.first === null || model.live.on || !timeline.count ? null : timeline.current! - message.first;
  }

  private toggle(): void {
    const { step } = this.model;
    if (step !== null) this.begun = performance.now() - (1000 * step) / this.fps;
    this.stand(step === null ? this.now : null);
  }

  /** Stands at a step from now on, or plays. */
  private stand(step: number | null): void {
    this.model.step = step;
    this.model.tell("step");
    this.model.tell("look"); // followers see the same step
  }

  /** The step that is to be seen. */
  private get now(): number {
    return this.model.step ?? Math.floor(((performance.now() - this.begun) * this.fps) / 1000) % this.length;
  }

  private draw(): void {
    if (!this.takes.size) return;
    const { viewer, model, drawn } = this;
    const plays = model.step === null;
    for (const [side, take] of this.takes) {
      const frame = this.frameOf(take);
      const step = frame === null ? this.now % take.length : Math.min(Math.max(frame, 0), take.length - 1);
      if (drawn.get(side) === step) continue;
      drawn.set(side, step);
      const { points, pose, worn } = take.at(step);
      viewer.carry(take.rods, points, pose, worn, side);
    }
    const own = [...this.takes.values()].some((take) => this.frameOf(take) === null);
    this.element.hidden = !own; // the timeline plays the others
    this.slider.value = String(this.now);
    this.readout.textContent = `${(this.now / this.fps).toFixed(1)} of ${(this.length / this.fps).toFixed(1)} s`;
    this.button.setAttribute("aria-pressed", String(plays));
    if (plays && own && !this.asked)
      this.asked = requestAnimationFrame(() => {
        this.asked = 0;
        this.draw();
      });
  }
}
