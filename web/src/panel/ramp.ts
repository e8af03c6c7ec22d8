// A curve from root to tip, drawn by its points: drag them, click between them for another, Delete takes one away.

import "./ramp.css";
import { h } from "../dom";

export type Ramp = [number, number][];

const WIDTH = 268;
const HEIGHT = 104;
const [LEFT, RIGHT, TOP, BOTTOM] = [26, 9, 9, 9]; // room for dots and, on the left, for numbers
const NS = "http://www.w3.org/2000/svg";

/** Shapes to begin with. */
const PRESETS: Record<string, Ramp> = {
  "constant": [
    [0, 1],
    [1, 1],
  ],
  "increases to the tip": [
    [0, 0],
    [1, 1],
  ],
  "decreases to the tip": [
    [0, 1],
    [1, 0],
  ],
  "begins late": [
    [0, 0],
    [0.3, 0],
    [0.6, 1],
    [1, 1],
  ],
  "in the middle": [
    [0, 0],
    [0.5, 1],
    [1, 0],
  ],
  "at both ends": [
    [0, 1],
    [0.5, 0],
    [1, 1],
  ],
};

/** The ramp that was copied last, for another setting. */
let copied: Ramp | null = null;

export class RampEditor {
  readonly element: HTMLElement;
  private readonly svg = document.createElementNS(NS, "svg");
  private readonly curve = document.createElementNS(NS, "path");
  private readonly area = document.createElementNS(NS, "path");
  private readonly numbers = document.createElementNS(NS, "g");
  private readonly readout = h("output", { class: "ramp-readout" });
  private readonly shapes = h("select", { class: "ramp-shapes" });
  private points: Ramp = [
    [0, 1],
    [1, 1],
  ];
  private held = -1;
  private top = 1;

  constructor(
    label: string,
    private readonly change: (ramp: Ramp, resting: boolean) => void,
  ) {
    this.svg.setAttribute("viewBox", `0 0 ${WIDTH} ${HEIGHT}`);
    this.svg.setAttribute("role", "group");
    this.svg.setAttribute("aria-label", `${label}: a curve from root to tip`);
    this.svg.classList.add("ramp");
    this.area.classList.add("ramp-area");
    this.curve.classList.add("ramp-curve");
    this.numbers.classList.add("ramp-numbers");
    this.svg.append(this.numbers, this.area, this.curve);
    this.shapes.setAttribute("aria-label", `${label}: shape of the curve`);
    this.shapes.addEventListener("change", () => this.take(this.shapes.value));
    this.shapes.addEventListener("focus", () => this.offer());
    this.shapes.addEventListener("pointerdown", () => this.offer());
    this.offer();
    this.element = h("div", { class: "ramp-editor" });
    this.element.append(
      this.svg,
      h("div", { class: "ramp-ends" }, h("span", {}, "root"), this.readout, h("span", {}, "tip")),
      this.shapes,
    );
    this.svg.addEventListener("pointerdown", (event) => this.press(event));
    this.svg.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"] as const) this.svg.addEventListener(name, () => this.release());
  }

  private offer(): void {
    this.shapes.replaceChildren(
      h("option", { value: "" }, "preset …"),
      ...Object.keys(PRESETS).map((name) => h("option", { value: name }, name)),
      h("option", { value: "copy" }, "copy this curve"),
      h("option", { value: "paste", disabled: !copied }, "paste the copied curve"),
    );
  }

  private take(name: string): void {
    this.shapes.value = "";
    if (name === "copy") copied = this.points.map(([x, y]) => [x, y]);
    const ramp = name === "paste" ? copied : PRESETS[name];
    if (!ramp) return;
    this.set(ramp);
    this.change(this.points, true);
  }

  set(ramp: Ramp): void {
    if (this.held >= 0) return;
    this.points = ramp.map(([x, y]) => [x, y]);
    const highest = Math.max(...ramp.map(([, y]) => y));
    this.top = Math.max(1.25, 1.25 * highest);
    this.draw();
  }

  private press(event: PointerEvent): void {
    const [x, y] = this.place(event);
    let nearest = this.points.findIndex(
      ([px, py]) => Math.hypot((px - x) * WIDTH, ((py - y) / this.top) * HEIGHT) < 14,
    );
    if (nearest < 0) {
      nearest = this.points.findIndex(([px]) => px > x);
      if (nearest < 0) nearest = this.points.length;
      this.points.splice(nearest, 0, [x, y]);
    }
    this.held = nearest;
    this.svg.setPointerCapture(event.pointerId);
    event.preventDefault();
    this.moved(x, y);
    (this.svg.querySelectorAll("circle")[nearest] as SVGElement | undefined)?.focus();
  }

  private move(event: PointerEvent): void {
    if (this.held >= 0) this.moved(...this.place(event));
  }

  private moved(x: number, y: number): void {
    const before = this.points[this.held - 1]?.[0] ?? -0.01;
    const after = this.points[this.held + 1]?.[0] ?? 1.01;
    this.points[this.held] = [
      round(Math.min(Math.max(x, before + 0.01, 0), after - 0.01, 1)),
      round(Math.min(Math.max(y, 0), this.top)), // the box grows when the hand rests
    ];
    this.draw();
    this.change(this.points, false);
  }

  private release(): void {
    if (this.held < 0) return;
    this.held = -1;
    this.change(this.points, true);
  }

  private key(event: KeyboardEvent, index: number): void {
    const steps: Record<string, [number, number]> = {
      ArrowLeft: [-0.02, 0],
      ArrowRight: [0.02, 0],
      ArrowUp: [0, 0.02 * this.top],
      ArrowDown: [0, -0.02 * this.top],
    };
    const [x, y] = this.points[index];
    if (steps[event.key]) {
      this.held = index;
      this.moved(x + steps[event.key][0], y + steps[event.key][1]);
      this.release();
    } else if ((event.key === "Delete" || event.key === "Backspace") && this.points.length > 1) {
      this.points.splice(index, 1);
      this.draw();
      this.change(this.points, true);
    } else if (event.key === "Enter" && this.points[index + 1]) {
      const [nx, ny] = this.points[index + 1];
      this.points.splice(index + 1, 0, [round((x + nx) / 2), round((y + ny) / 2)]);
      this.draw();
      this.change(this.points, true);
    } else return;
    event.preventDefault();
    (this.svg.querySelectorAll("circle")[Math.min(index, this.points.length - 1)] as SVGElement).focus();
  }

  private place(event: PointerEvent): [number, number] {
    const box = this.svg.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * WIDTH;
    const y = ((event.clientY - box.top) / box.height) * HEIGHT;
    return [(x - LEFT) / (WIDTH - LEFT - RIGHT), ((HEIGHT - BOTTOM - y) / (HEIGHT - TOP - BOTTOM)) * this.top];
  }

  private draw(): void {
    const at = (x: number, y: number): [number, number] => [
      LEFT + x * (WIDTH - LEFT - RIGHT),
      HEIGHT - BOTTOM - (y / this.top) * (HEIGHT - TOP - BOTTOM),
    ];
    this.drawNumbers((y) => at(0, y)[1]);
    const along = Array.from({ length: 65 }, (_, k) => at(k / 64, evaluate(this.points, k / 64)));
    const line = along.map(([x, y], k) => `${k ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");
    this.curve.setAttribute("d", line);
    this.area.setAttribute("d", `${line}L${WIDTH - RIGHT} ${HEIGHT - BOTTOM}L${LEFT} ${HEIGHT - BOTTOM}Z`);
    const dots = this.svg.querySelectorAll("circle");
    for (let k = this.points.length; k < dots.length; k++) dots[k].remove();
    this.points.forEach(([x, y], k) => {
      const dot = dots[k] ?? this.svg.appendChild(this.dot(k));
      const [cx, cy] = at(x, y);
      dot.setAttribute("cx", String(cx));
      dot.setAttribute("cy", String(cy));
      dot.setAttribute("aria-label", `point at ${x}, factor ${y}`);
    });
    const [x, y] = this.points[this.held] ?? [];
    this.readout.textContent = this.held >= 0 ? `${x} → ${y}` : "";
  }

  /** Lines at round factors, with their numbers. */
  private drawNumbers(height: (y: number) => number): void {
    const step = [0.25, 0.5, 1, 2, 5, 10, 20, 50].find((one) => this.top / one <= 4) ?? this.top;
    const marks = Array.from({ length: Math.floor(this.top / step) + 1 }, (_, k) => k * step);
    this.numbers.replaceChildren(
      ...marks.flatMap((y) => {
        const line = document.createElementNS(NS, "path");
        line.setAttribute("d", `M${LEFT} ${height(y)}H${WIDTH - RIGHT}`);
        const text = document.createElementNS(NS, "text");
        text.setAttribute("x", String(LEFT - 6));
        text.setAttribute("y", String(height(y) + 3.5));
        text.textContent = String(y);
        return [line, text];
      }),
    );
  }

  private dot(index: number): SVGCircleElement {
    const dot = document.createElementNS(NS, "circle");
    dot.setAttribute("r", "5");
    dot.setAttribute("tabindex", "0");
    dot.setAttribute("role", "button");
    dot.addEventListener("keydown", (event) => this.key(event, index));
    return dot;
  }
}

const round = (x: number) => Math.round(x * 1000) / 1000;

/** The ramp's factor at x: smooth, no overshoot (Fritsch and Carlson 1980), as in python/ringlet/data/quantities.py. */
export function evaluate(points: Ramp, x: number): number {
  const n = points.length;
  if (n === 1 || x <= points[0][0]) return points[0][1];
  if (x >= points[n - 1][0]) return points[n - 1][1];
  const h = points.slice(1).map(([px], k) => px - points[k][0]);
  const slope = points.slice(1).map(([, py], k) => (py - points[k][1]) / h[k]);
  const d = points.map((_, k) => {
    if (n === 2) return slope[0];
    if (k === 0) return end(h[0], h[1], slope[0], slope[1]);
    if (k === n - 1) return end(h[n - 2], h[n - 3], slope[n - 2], slope[n - 3]);
    if (slope[k - 1] * slope[k] <= 0) return 0;
    const [w1, w2] = [2 * h[k] + h[k - 1], h[k] + 2 * h[k - 1]];
    return (w1 + w2) / (w1 / slope[k - 1] + w2 / slope[k]);
  });
  const k = Math.max(0, points.findIndex(([px]) => px > x) - 1);
  const t = (x - points[k][0]) / h[k];
  const [a, b] = [points[k][1], points[k + 1][1]];
  return (
    a * (1 + 2 * t) * (1 - t) ** 2 +
    h[k] * d[k] * t * (1 - t) ** 2 +
    b * t * t * (3 - 2 * t) +
    h[k] * d[k + 1] * t * t * (t - 1)
  );
}

function end(h0: number, h1: number, s0: number, s1: number): number {
  const d = ((2 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
  if (Math.sign(d) !== Math.sign(s0)) return 0;
  if (Math.sign(s0) !== Math.sign(s1) && Math.abs(d) > 3 * Math.abs(s0)) return 3 * s0;
  return d;
}
