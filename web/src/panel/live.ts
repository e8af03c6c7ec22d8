// Live hair: the switch, and what it shows: steps as they come, and how many of them.

import "./live.css";
import { h, iconButton } from "../dom";
import type { Model } from "../model";
import type { Blow, LiveStep, MoveHead } from "../protocol";
import { headOf, Rods, sameStep } from "../view/rods";
import { Vector3 } from "three";
import type { Viewer } from "../view/viewer";
import { bindKey, plainKey } from "./keys";

const MOTIONS: [MoveHead["motion"], string, string][] = [
  ["nod", "Nod", "Nod twice"],
  ["turn", "Turn", "Turn to one side and to the other"],
  ["shake", "Shake", "Shake the head"],
  ["hop", "Hop", "Hop twice"],
  ["walk", "Walk", "Walk, until it is pressed again"],
  ["clip", "Clip", "Play the clip of the shot in a loop, until it is pressed again"],
];
const SIDES: [Blow["side"], string][] = [
  ["", "no wind"],
  ["left", "wind from the left"],
  ["right", "wind from the right"],
  ["front", "wind from the front"],
  ["back", "wind from behind"],
];

const EASED = 1000; // time in which hair has gone over to another groom [ms]
const SAID_FOR = 6000; // [ms]
const CAUTION = "Live: locks may pass through one another";

export class LiveHair {
  readonly button = iconButton("live", "Live hair (L): it moves with the head", () => this.toggle());
  readonly line = h("div", { class: "live-line", role: "note", hidden: true });
  private readonly rate = h("output", { class: "rate", "aria-label": "Live steps a second" });
  /** Buttons of what is done to the hair. */
  readonly buttons = h("div", { class: "motions", role: "group", "aria-label": "Motions" });
  private readonly motions = MOTIONS.map(([motion, label, title]) =>
    h("button", { type: "button", class: "quiet", title, "data-motion": motion, onclick: () => this.model.say({ kind: "move_head", motion }) }, label),
  );
  private readonly wind = h("select", { "aria-label": "Wind" }, ...SIDES.map(([side, label]) => h("option", { value: side }, label)));
  private readonly contact = h("span", { class: "contact", title: "What contact adds to the stiffness of locks: by default, or found in the background from a short run in contact" });
  private readonly cut = h("span", { class: "cut-off", role: "status" });
  private rods: Rods | null = null;
  private step: LiveStep | null = null;
  private shown: LiveStep | null = null;
  /** When groom, rods or bodies came last [ms]. */
  private changed = 0;
  /** When steps were seen in the last second [ms]. */
  private seen: number[] = [];
  private waiting = false;
  private saying = 0;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
  ) {
    this.button.setAttribute("aria-pressed", "false");
    this.buttons.append(...this.motions, this.wind);
    this.line.append(this.buttons, CAUTION, this.contact, this.rate, this.cut);
    this.wind.addEventListener("change", () => model.say({ kind: "blow", side: this.wind.value as Blow["side"] }));
    bindKey({ section: "View", keys: "L", does: "let hair move live, or put it at rest", on: plainKey("l"), run: () => this.toggle() });
    model.on("live", () => this.turned());
    model.on("role", () => {
      for (const control of [this.button, ...this.motions, this.wind]) control.toggleAttribute("disabled", !model.role.leads);
    });
    model.hear("rods", (message) => {
      if (message.side !== "a") return; // of a look that is compared
      this.rods = new Rods(message);
      this.changed = performance.now();
      this.step = null;
    });
    model.hear("live_step", (message) => this.take(message));
    for (const kind of ["locks", "hairs", "body"] as const)
      model.hear(kind, () => {
        this.changed = performance.now();
        if (this.step) this.show(); // they came at rest
      });
  }

  private toggle(): void {
    if (this.model.role.leads) this.model.say({ kind: "go_live", on: !this.model.live.on });
  }

  /** The server has turned it on or off. */
  private turned(): void {
    const { live } = this.model;
    this.button.setAttribute("aria-pressed", String(live.on));
    this.line.toggleAttribute("hidden", !live.on);
    if (!live.fps) {
      this.seen = [];
      this.rate.textContent = "is being prepared";
      this.cut.textContent = "";
    } else if (!this.seen.length) this.rate.textContent = "";
    for (const motion of this.motions) {
      const { motion: name } = motion.dataset;
      if (name === "walk" || name === "clip") motion.setAttribute("aria-pressed", String(live.goes_on.includes(name)));
      if (name === "clip") motion.toggleAttribute("hidden", this.model.welcome?.mode !== "shot");
    }
    this.wind.value = live.wind;
    this.contact.textContent = live.contact && `contact: ${live.contact}`;
    if (!live.on) this.rods = this.step = this.shown = null;
    if (!this.step) this.viewer.putAtRest(); // a frame of a shot may be seen
  }

  /** A step has come; it is shown with the next picture, where a later one does not replace it. */
  private take(step: LiveStep): void {
    if (!this.model.live.on || step.side !== "a" || step.key !== this.rods?.message.key) return;
    this.step = step;
    if (step.note) this.say(step.note);
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      if (!this.step) return;
      if (!this.stands) this.show(); // the picture of hair that stands gets finer
      this.count();
    });
  }

  /** Says for a while what was cut off. */
  private say(note: string): void {
    this.cut.textContent = note;
    clearTimeout(this.saying);
    this.saying = window.setTimeout(() => (this.cut.textContent = ""), SAID_FOR);
  }

  /** Whether the step is not seen to differ from the one that is shown. */
  private get stands(): boolean {
    const { shown, step } = this;
    return shown !== null && step !== null && performance.now() - this.changed >= EASED && sameStep(step, shown);
  }

  private show(): void {
    const { rods, step, viewer } = this;
    if (!rods || !step) return;
    this.shown = step;
    const { trunk, points, worn } = step;
    viewer.carry(rods, points, { head: headOf(step), trunk: new Vector3(...trunk), pivot: new Vector3(...rods.message.pivot) }, worn);
  }

  /** Says how many steps of a second are seen. */
  private count(): void {
    const now = performance.now();
    this.seen = [...this.seen.filter((at) => now - at < 1000), now];
    const fps = Math.round(this.model.live.fps);
    const long = now - this.seen[0] > 900;
    const seen = Math.min(this.seen.length, fps);
    if (long) this.rate.textContent = seen < fps - 1 ? `${seen} of ${fps} steps a second` : `${fps} steps a second`;
    this.rate.classList.toggle("behind", long && seen < fps - 1);
  }
}
