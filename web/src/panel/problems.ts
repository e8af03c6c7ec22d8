// What stands in the way, with buttons that remedy it; it stays until it is gone. Also the progress of long work.

import "./problems.css";
import { h } from "../dom";
import type { Model } from "../model";
import type { FromPage, Problem } from "../protocol";
import { openMerge } from "./merge";
import { showChanges } from "./files";

export class ProblemBar {
  readonly element = h("section", { class: "problems", role: "alert", "aria-label": "Problems" });
  private readonly progress = h("div", { class: "problem progress", hidden: true, role: "status" });
  /** Problems of the page itself by subject, such as a lost connection, each with a button of its own if it has one. */
  private readonly own = new Map<string, HTMLElement>();

  private readonly list = h("div", {});

  /** questions: of other people, above the problems */
  constructor(
    private readonly model: Model,
    questions: HTMLElement,
  ) {
    this.element.append(questions, this.list);
    for (const topic of ["problems", "role"] as const) model.on(topic, () => this.update());
    model.on("progress", () => this.showProgress());
    new ResizeObserver(() => {
      document.documentElement.style.setProperty("--problems", `${this.element.offsetHeight}px`);
    }).observe(this.element);
    this.update();
  }

  /** Shows a problem of the page itself; an empty text removes it. */
  keep(subject: string, text: string, ...buttons: HTMLElement[]): void {
    if (text) this.own.set(subject, h("div", { class: "problem" }, h("p", {}, text), h("div", { class: "group" }, ...buttons)));
    else this.own.delete(subject);
    this.update();
  }

  private update(): void {
    this.list.replaceChildren(...this.own.values(), ...this.model.problems.map((one) => this.row(one)), this.progress);
    document.documentElement.classList.toggle("old-look", this.model.problems.some((one) => OLD_LOOK.includes(one.subject)));
  }

  private row(problem: Problem): HTMLElement {
    const { leads } = this.model.role;
    const button = (label: string, press: () => void, more = {}) =>
      h("button", { type: "button", class: "quiet", disabled: !leads, onclick: press, ...more }, label);
    const buttons = problem.fixes.map((fix) => button(fix.label, () => this.remedy(fix.message as unknown as FromPage)));
    if (problem.subject === "recovered") buttons.unshift(button("See", () => showChanges(this.model), { disabled: false }));
    if (problem.subject.startsWith("conflict/")) {
      buttons.unshift(button("See and merge …", () => openMerge(this.model, problem), { disabled: false }));
    }
    return h(
      "div",
      { class: `problem ${problem.subject.split("/")[0]}`, "data-problem": problem.subject },
      h("p", {}, this.model.words(problem.message)),
      h("div", { class: "group" }, ...buttons),
    );
  }

  private remedy(message: FromPage): void {
    const gesture = message.kind === "set" ? { gesture: this.model.newGesture() } : {};
    this.model.say({ ...message, ...gesture } as FromPage);
  }

  private showProgress(): void {
    const { progress } = this.model;
    this.progress.hidden = !progress;
    if (!progress) return;
    const stage = progress.stage.replaceAll("_", " ");
    this.progress.replaceChildren(
      h("p", {}, `Making the groom: ${stage}`),
      h("progress", { max: 1, value: progress.done, "aria-label": "Progress of the groom" }),
      h("button", { type: "button", class: "quiet", onclick: () => this.model.say({ kind: "cancel" }) }, "Cancel"),
    );
  }
}

/** Problems during which the look that is seen is not that of the settings. */
const OLD_LOOK = ["groom", "work"];
