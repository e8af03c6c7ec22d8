// Numbers in sight, and a line for what went wrong.

import "./status.css";
import { count, h } from "../dom";
import type { Model } from "../model";
import type { Json } from "../protocol";
import type { DrawStatistics } from "../view/viewer";

export class Status {
  readonly element = h("div", { class: "status" });
  private readonly parts: Record<string, HTMLElement> = {};

  constructor(private readonly model: Model) {
    for (const [name, label] of [
      ["locks", "locks"],
      ["hairs", "hairs"],
      ["groom", "groom"],
      ["draw", "picture"],
      ["inside", "points inside the head"],
      ["contacts", "contacts"],
      ["sim", "simulated"],
    ]) {
      const value = h("b", {});
      const part = h("span", { "data-number": name, hidden: true }, value, ` ${label}`);
      this.parts[name] = part;
      this.element.append(part);
    }
    model.on("numbers", () => this.update());
    for (const topic of ["numbers", "document"] as const) model.on(topic, () => this.wait());
    model.on("measured", () => this.inside(model.measured?.inside ?? 0));
  }

  drew({ drawMs, shown }: DrawStatistics): void {
    if (drawMs !== undefined) this.set("draw", `${drawMs.toFixed(0)} ms`);
    const hairs = this.model.numbers?.hairs ?? 0;
    if (hairs) this.set("hairs", shown < hairs ? `${count(shown)} of ${count(hairs)}` : count(hairs));
    this.parts["hairs"].title = shown < hairs ? "So many stand for all, as long as the picture gets finer, or where the card holds no more" : "";
  }

  /** Statistics of the simulation of the frame that is shown. */
  simulated(statistics: Record<string, Json>): void {
    const { wall_ms: ms, inside, contacts } = statistics;
    if (typeof ms === "number") this.set("sim", `${ms.toFixed(0)} ms/frame`);
    if (typeof contacts === "number") this.set("contacts", count(contacts));
    if (typeof inside === "number") this.inside(inside);
  }

  private inside(points: number): void {
    this.set("inside", count(points));
    this.parts["inside"].classList.toggle("warn", points > 0);
  }

  /** While a newer groom is being made, what it took to make the one that is seen stands back. */
  private wait(): void {
    this.parts["groom"].classList.toggle("waiting", !this.model.settled);
  }

  private update(): void {
    const { numbers } = this.model;
    if (!numbers) return;
    this.set("locks", count(numbers.locks));
    this.set("hairs", count(numbers.hairs));
    this.set("groom", `${numbers.groom_ms.toFixed(0)} ms`);
    const times = Object.entries(numbers.times).map(([stage, ms]) => `${stage} ${ms.toFixed(0)} ms`);
    this.parts["groom"].title = times.join("\n") || "taken from memory";
  }

  private set(name: string, text: string): void {
    this.parts[name].removeAttribute("hidden");
    this.parts[name].querySelector("b")!.textContent = text;
  }
}


const MOST_NOTICES = 2;

/** Short messages that go on their own; lasting ones are problems. */
export class Notices {
  readonly element = h("div", { class: "notices", role: "status", "aria-live": "polite" });
  private readonly shown = new Map<string, { notice: HTMLElement; timer: number }>();

  constructor(model: Model) {
    model.hear("saved", ({ name }) => this.show(`${name} is saved`));
    model.hear("notice", ({ message }) => this.show(message));
    model.hear("trouble", ({ message }) => this.show(model.words(message), "bad"));
  }

  /** Shows a message; the same message again only renews it. */
  show(text: string, kind: "good" | "bad" = "good"): void {
    const known = this.shown.get(text);
    clearTimeout(known?.timer);
    const notice = known?.notice ?? h("p", { class: `notice ${kind}` }, text);
    const remove = () => {
      notice.remove();
      this.shown.delete(text);
    };
    this.shown.set(text, { notice, timer: window.setTimeout(remove, kind === "bad" ? 9000 : 3500) });
    if (!known) this.element.append(notice);
    while (this.element.children.length > MOST_NOTICES) this.element.firstElementChild?.remove();
  }
}
