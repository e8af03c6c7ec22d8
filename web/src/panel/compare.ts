// Two looks: side by side, with a wipe between them, or one in place of the other; each with its label.

import { h, iconButton } from "../dom";
import type { Model } from "../model";
import type { Arrangement, Viewer } from "../view/viewer";
import { bindKey } from "./keys";

const MODES: Record<Arrangement, string> = { split: "side by side", wipe: "wipe", flip: "flip (Tab)" };

export class CompareBar {
  readonly element = h("section", { class: "compare", hidden: true, "aria-label": "Comparison" });
  private readonly mode = h("select", { "aria-label": "Arrangement of the two looks" });
  private readonly labels = { a: h("span", { class: "look-label a" }), b: h("span", { class: "look-label b" }) };
  private readonly divider = h("div", {
    class: "divider",
    role: "slider",
    tabindex: 0,
    "aria-label": "Place of the wipe",
    "aria-valuemin": 0,
    "aria-valuemax": 100,
  });

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly end: () => void,
  ) {
    for (const [name, label] of Object.entries(MODES)) this.mode.append(h("option", { value: name }, label));
    this.mode.addEventListener("change", () => this.arrange(this.mode.value as Arrangement));
    const bar = h(
      "div",
      { class: "compare-bar" },
      this.mode,
      iconButton("swap", "Swap the two sides", () => this.swap()),
      h("button", { type: "button", class: "quiet", onclick: () => this.end() }, "End"),
    );
    this.element.append(this.divider, this.labels.a, this.labels.b, bar);
    model.on("compared", () => this.update());
    bindKey({ keys: "Tab", does: "flip between two looks that are compared", on: (event) => this.flips(event), run: () => this.flip() });
    let held = false;
    this.divider.addEventListener("pointerdown", (event) => {
      held = true;
      this.divider.setPointerCapture(event.pointerId);
    });
    this.divider.addEventListener("pointermove", (event) => held && this.wipe(event.clientX / innerWidth));
    for (const name of ["pointerup", "pointercancel"] as const) this.divider.addEventListener(name, () => (held = false));
    this.divider.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
      if (!by) return;
      event.preventDefault();
      this.wipe(this.viewer.wipe + by);
    });
  }

  private flips(event: KeyboardEvent): boolean {
    return event.key === "Tab" && this.model.compared !== "" && this.viewer.arrangement === "flip" && !event.shiftKey;
  }

  private flip(): void {
    this.viewer.front = this.viewer.front === "a" ? "b" : "a";
    this.viewer.invalidate();
    this.update();
  }

  private swap(): void {
    this.viewer.first = this.viewer.first === "a" ? "b" : "a";
    if (this.viewer.arrangement === "flip") this.flip();
    this.viewer.invalidate();
    this.update();
  }

  private arrange(mode: Arrangement): void {
    this.viewer.arrangement = mode;
    this.viewer.invalidate();
    this.update();
  }

  private wipe(at: number): void {
    this.viewer.wipe = Math.min(0.97, Math.max(0.03, at));
    this.viewer.invalidate();
    this.update();
  }

  private update(): void {
    const { viewer, labels } = this;
    const { compared } = this.model;
    this.element.hidden = !compared;
    const names = { a: "now", b: compared };
    const [left, right] = viewer.first === "a" ? (["a", "b"] as const) : (["b", "a"] as const);
    const one = viewer.arrangement === "flip";
    labels.a.textContent = one ? names[viewer.front] : names[left];
    labels.b.textContent = names[right];
    labels.b.hidden = one;
    this.element.dataset["mode"] = viewer.arrangement;
    this.divider.hidden = viewer.arrangement !== "wipe";
    this.divider.style.left = `${100 * viewer.wipe}%`;
    this.divider.setAttribute("aria-valuenow", String(Math.round(100 * viewer.wipe)));
  }
}
