// The tip of a brush: how large, strong and soft it is, and the ring that shows it in the picture.

import type { Vector3 } from "three";
import { h } from "../dom";
import { pixelsPerMetre } from "../view/pick";
import type { Viewer } from "../view/viewer";
import { row, toggle } from "./hand_tool";
import { bindKey, plainKey } from "./keys";
import { Slider } from "./slider";

const STEP = 1.15; // of the radius, by a key
const [SMALLEST, LARGEST] = [2, 80]; // radius [mm]
const FALLOFFS = ["smooth", "sharp", "flat"] as const;
const LIGHTEST = 0.02; // fraction of the strength under a pen that hardly touches

export class BrushTip {
  readonly rows: HTMLElement[];
  readonly mirrored: HTMLInputElement;
  /** Of the pen, from 0 to 1; a mouse has half of it. */
  pressure = 0.5;
  private readonly radius: Slider;
  private readonly strength: Slider;
  private readonly wide: HTMLOutputElement;
  private readonly strong: HTMLOutputElement;
  private readonly falloff: HTMLSelectElement;
  private readonly pen: HTMLInputElement;

  /** name: of the tool; radius: at first [mm]; strength: at first; active: whether keys change it now */
  constructor(
    name: string,
    private readonly viewer: Viewer,
    private readonly ring: HTMLElement,
    first: { radius: number; strength: number },
    active: () => boolean,
  ) {
    this.radius = new Slider({ id: `${name}-radius` }, () => this.tell());
    this.strength = new Slider({ id: `${name}-strength` }, () => this.tell());
    this.wide = h("output", { class: "unit", for: `${name}-radius` });
    this.strong = h("output", { class: "unit", for: `${name}-strength` });
    this.falloff = h("select", { id: `${name}-falloff` }, ...FALLOFFS.map((one) => h("option", { value: one }, one)));
    this.pen = toggle(`${name}-pen`);
    this.mirrored = toggle(`${name}-mirrored`);
    this.rows = [
      row("radius", this.radius.element, this.wide),
      row("strength", this.strength.element, this.strong),
      row("falloff", this.falloff),
      row("pen pressure", this.pen),
      row("both sides", this.mirrored),
    ];
    this.radius.set(first.radius, { least: SMALLEST, most: LARGEST, step: 1 });
    this.strength.set(first.strength, { least: 0.05, most: 1, step: 0.05 });
    this.tell();
    const keyed = (event: KeyboardEvent) => active() && plainKey("[", "]")(event);
    bindKey({ section: "Groom", keys: "[ and ]", does: "smaller brush, larger brush", on: keyed, run: (event) => this.resize(event.key === "[" ? 1 / STEP : STEP) });
    viewer.element.addEventListener("pointerleave", () => this.hide());
  }

  /** Radius [m]. */
  get metres(): number {
    return this.radius.value / 1000;
  }

  /** What a stroke says of its brush. */
  get stroke() {
    const pressed = this.pen.checked ? Math.max(LIGHTEST, this.pressure) : 1;
    return {
      radius: this.metres,
      mirrored: this.mirrored.checked,
      strength: Math.min(1, this.strength.value * pressed),
      falloff: this.falloff.value as (typeof FALLOFFS)[number],
    };
  }

  /** Radius in the picture at a place [pixels]. */
  pixels(place: Vector3): number {
    return this.metres * pixelsPerMetre(place, this.viewer.camera, this.viewer.clear.height);
  }

  /** Puts the ring under the pointer; place: what it touches, if anything */
  show(at: { x: number; y: number }, place: Vector3 | null): void {
    const pixels = this.pixels(place ?? this.viewer.controls.target);
    this.ring.toggleAttribute("hidden", false);
    this.ring.classList.toggle("idle", !place);
    const [left, top] = [at.x - pixels, at.y - pixels].map((edge) => `${edge}px`);
    Object.assign(this.ring.style, { left, top, width: `${2 * pixels}px`, height: `${2 * pixels}px` });
  }

  hide(): void {
    this.ring.toggleAttribute("hidden", true);
  }

  private resize(factor: number): void {
    this.radius.set(Math.min(LARGEST, Math.max(SMALLEST, this.radius.value * factor)));
    this.tell();
  }

  private tell(): void {
    this.wide.textContent = `${Math.round(this.radius.value)} mm`;
    this.strong.textContent = `${Math.round(100 * this.strength.value)} %`;
  }
}
