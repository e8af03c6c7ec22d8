// One lock: click it to choose it, isolate it, drag its points, return it.

import { Vector3 } from "three";
import { h, iconButton } from "../dom";
import type { Model, Place } from "../model";
import type { Json } from "../protocol";
import { inPlane, onScreen, pick } from "../view/pick";
import type { Viewer } from "../view/viewer";

const HANDLES = [0.2, 0.4, 0.6, 0.8, 1]; // places along a lock that can be dragged
const NS = "http://www.w3.org/2000/svg";
const STILL = 4; // a pointer that moves less has clicked [pixels]

export class LockTool {
  readonly element = h("section", { class: "panel lock", hidden: true, "aria-label": "Chosen lock" });
  readonly handles = document.createElementNS(NS, "svg");
  private readonly title = h("h2", {});
  private readonly isolate = h("button", { type: "button", class: "quiet" }, "Isolate");
  private readonly back = h("button", { type: "button", class: "quiet" }, "Return to the recipe");
  private readonly reach = h("input", { type: "range", min: 0.05, max: 0.8, step: 0.05, value: 0.3, id: "lock-reach" });
  private readonly alone = h("input", { type: "checkbox", role: "switch", class: "switch", id: "lock-alone" });
  private readonly own = h("ul", { class: "own", "aria-label": "Values of this lock alone" });
  private row = -1;
  private held = -1;
  private gesture = 0;
  private sending = 0;
  /** Whether another tool has the pointer. */
  busy = () => false;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
  ) {
    this.handles.classList.add("handles");
    const close = h("button", { type: "button", class: "quiet", onclick: () => this.choose(-1) }, "Done");
    this.element.append(
      this.title,
      h("div", { class: "group" }, this.isolate, this.back, close),
      h("div", { class: "field-head reach" }, h("label", { for: "lock-reach", title: "How much of the lock comes along with a point" }, "reach"), this.reach),
    );
    this.element.append(
      h(
        "div",
        { class: "field-head" },
        h("label", { for: "lock-alone", title: "Settings on the right are those of this lock" }, "values of this lock alone"),
        this.alone,
      ),
      this.own,
    );
    this.alone.addEventListener("change", () => this.scope(this.alone.checked));
    this.isolate.addEventListener("click", () => model.say({ kind: "isolate", locks: [this.id] }));
    this.back.addEventListener("click", () => model.say({ kind: "isolate", locks: [this.id], out: false }));
    this.reach.style.setProperty("--part", "33%");
    const canvas = viewer.renderer.domElement;
    let pressed = { x: 0, y: 0 };
    canvas.addEventListener("pointerdown", (event) => {
      pressed = { x: event.clientX, y: event.clientY };
    });
    canvas.addEventListener("click", (event) => {
      if (Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) < STILL) this.click(event);
    });
    model.on("document", () => this.update());
    model.on("role", () => this.update());
  }

  /** The id of the chosen lock. */
  get id(): number {
    return this.viewer.hair.a.locks?.ids[this.row] ?? -1;
  }

  /** Chooses a lock by its place in the list; -1: none. */
  choose(row: number): void {
    this.row = row;
    this.scope(row >= 0 && this.alone.checked);
    this.update();
    this.mark();
  }

  /** Settings are those of this lock, or of all again. */
  private scope(alone: boolean): void {
    this.alone.checked = alone;
    this.model.locks = alone ? [this.id] : [];
    this.model.tell("chosen");
  }

  /** What was given to this lock alone, each with a way to take it out. */
  private tellOwn(): void {
    const said = this.model.documents.recipe?.said ?? {};
    const found = this.row < 0 ? [] : [...ownValues(said, String(this.id))];
    this.own.toggleAttribute("hidden", !found.length);
    this.own.replaceChildren(
      ...found.map(([place, value]) => {
        const name = named(said, place.slice(0, -2));
        const take = () =>
          this.model.say({ kind: "set", changes: [[place, null]], gesture: this.model.newGesture(), resting: true });
        return h("li", {}, h("span", {}, `${name} ${String(value)}`), iconButton("bin", `Not its own ${name}`, take));
      }),
    );
  }

  /** Locks have come: the chosen one may be another row, or gone. */
  arrived(): void {
    if (this.row >= (this.viewer.hair.a.locks?.ids.length ?? 0)) this.row = -1;
    this.mark();
    this.update();
  }

  /** Puts the handles where the points of the lock are on the screen. */
  place(): void {
    const points = this.isolated ? this.points() : [];
    const dots = [...this.handles.querySelectorAll("circle")];
    for (let k = dots.length; k < points.length; k++) dots.push(this.dot(k));
    dots.forEach((dot, k) => {
      dot.toggleAttribute("hidden", !points[k]);
      dot.style.display = points[k] ? "" : "none";
      if (!points[k]) return;
      const { x, y } = onScreen(points[k], this.viewer.camera, this.size);
      dot.setAttribute("cx", String(x));
      dot.setAttribute("cy", String(y));
    });
  }

  private get isolated(): boolean {
    return this.row >= 0 && (this.viewer.hair.a.locks?.marked[this.row] ?? 0) > 0;
  }

  private get size() {
    const { clientWidth, clientHeight } = this.viewer.element;
    return { width: clientWidth, height: clientHeight };
  }

  private points(): Vector3[] {
    const locks = this.viewer.hair.a.locks;
    if (!locks || this.row < 0) return [];
    return HANDLES.map((at) => new Vector3().fromArray(locks.points, 3 * (locks.offsets[this.row] + this.index(at))));
  }

  private index(at: number): number {
    const { offsets } = this.viewer.hair.a.locks!;
    return Math.round(at * (offsets[this.row + 1] - offsets[this.row] - 1));
  }

  private click(event: MouseEvent): void {
    const { locks } = this.viewer.hair.a;
    if (!locks || this.viewer.compared || !this.model.documents.recipe || this.busy()) return;
    const box = this.viewer.element.getBoundingClientRect();
    const at = { x: event.clientX - box.left, y: event.clientY - box.top };
    this.choose(pick(locks.points, locks.offsets, this.viewer.camera, this.size, at)?.lock ?? -1);
  }

  private mark(): void {
    const { locks } = this.viewer.hair.a;
    if (!locks) return;
    const marked = Uint8Array.from(locks.marked);
    if (this.row >= 0) marked[this.row] = 2;
    this.viewer.hair.a.mark(marked);
    this.viewer.invalidate();
  }

  private update(): void {
    this.element.toggleAttribute("hidden", this.row < 0);
    this.title.textContent = `Lock ${this.id}${this.isolated ? ", isolated" : ""}`;
    this.isolate.toggleAttribute("hidden", this.isolated);
    this.back.toggleAttribute("hidden", !this.isolated);
    this.element.querySelector(".reach")!.toggleAttribute("hidden", !this.isolated);
    this.element.toggleAttribute("inert", !this.model.role.leads);
    this.tellOwn();
    this.place();
  }

  private dot(index: number): SVGCircleElement {
    const dot = document.createElementNS(NS, "circle");
    dot.setAttribute("r", "6");
    dot.setAttribute("tabindex", "0");
    dot.setAttribute("role", "button");
    dot.setAttribute("aria-label", `Point ${index + 1} of ${HANDLES.length} of the lock: arrow keys move it`);
    dot.addEventListener("pointerdown", (event) => {
      this.held = index;
      this.gesture = this.model.newGesture();
      dot.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    dot.addEventListener("pointermove", (event) => {
      if (this.held === index) this.pull(index, this.under(event, index), false);
    });
    dot.addEventListener("pointerup", (event) => {
      if (this.held !== index) return;
      this.pull(index, this.under(event, index), true);
      this.held = -1;
    });
    dot.addEventListener("keydown", (event) => this.key(event, index));
    this.handles.append(dot);
    return dot;
  }

  private under(event: PointerEvent, index: number): Vector3 {
    const box = this.viewer.element.getBoundingClientRect();
    const at = { x: event.clientX - box.left, y: event.clientY - box.top };
    return inPlane(at, this.points()[index], this.viewer.camera, this.size);
  }

  private key(event: KeyboardEvent, index: number): void {
    const ways: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, 1],
      ArrowDown: [0, -1],
    };
    const way = ways[event.key];
    if (!way) return;
    event.preventDefault();
    const [right, up] = [0, 1].map((c) => new Vector3().setFromMatrixColumn(this.viewer.camera.matrixWorld, c));
    const to = this.points()
      [index].addScaledVector(right, 0.003 * way[0])
      .addScaledVector(up, 0.003 * way[1]);
    this.gesture = this.model.newGesture();
    this.pull(index, to, true);
  }

  private pull(index: number, to: Vector3, resting: boolean): void {
    const message = () => {
      this.sending = 0;
      this.model.say({
        kind: "drag",
        lock: this.id,
        point: this.index(HANDLES[index]),
        to: [to.x, to.y, to.z],
        reach: Number(this.reach.value),
        gesture: this.gesture,
        resting,
      });
    };
    cancelAnimationFrame(this.sending);
    if (resting) message();
    else this.sending = requestAnimationFrame(message);
  }
}

/** Where a recipe gives a lock a value of its own, and which. */
function* ownValues(said: Json, lock: string, place: Place = []): Generator<[Place, Json]> {
  if (said === null || typeof said !== "object") return;
  for (const [key, value] of Object.entries(said)) {
    const here = [...place, Array.isArray(said) ? Number(key) : key];
    const own = key === "lock" && value !== null && typeof value === "object" ? (value as Record<string, Json>) : {};
    if (lock in own) yield [[...here, lock], own[lock]];
    else yield* ownValues(value, lock, here);
  }
}

/** A setting as a person calls it: the operator in place of its number. */
function named(said: Json, place: Place): string {
  const [first, second, ...rest] = place;
  if (first !== "shape" || typeof second !== "number") return place.join(" ");
  const operator = (said as { shape: { op?: string }[] }).shape[second];
  return [operator?.op ?? `shape ${second + 1}`, ...rest].join(" ");
}
