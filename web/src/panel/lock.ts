// Locks: click one to choose it, or draw a lasso with Shift; isolate them, drag points of one, return them.

import "./lock.css";
import { Vector3 } from "three";
import { h, iconButton } from "../dom";
import type { Model, Place } from "../model";
import { onButton } from "./hand_tool";
import { bindKey, plainKey } from "./keys";
import type { Json } from "../protocol";
import type { Size } from "../view/box";
import { inPlane, onScreen, pick } from "../view/pick";
import type { Viewer } from "../view/viewer";

const HANDLES = [0.2, 0.4, 0.6, 0.8, 1]; // places along a lock that can be dragged
const MOST_LISTED = 40; // edited locks that are listed
const NS = "http://www.w3.org/2000/svg";
const STILL = 4; // a pointer that moves less has clicked [pixels]

export class LockTool {
  readonly element = h("section", { class: "panel lock", hidden: true, "aria-label": "Selected lock" });
  readonly handles = document.createElementNS(NS, "svg");
  private readonly title = h("h2", {});
  private readonly isolate = h("button", { type: "button", class: "quiet" }, "Isolate");
  private readonly back = h("button", { type: "button", class: "quiet" }, "Reset lock");
  private readonly falloff = h("input", { type: "range", min: 0.05, max: 0.8, step: 0.05, value: 0.3, id: "lock-falloff" });
  private readonly alone = h("input", { type: "checkbox", role: "switch", class: "switch", id: "lock-alone" });
  private readonly aloneLabel = h("label", { for: "lock-alone", title: "Settings on the right are those of the selected locks" });
  private readonly motion = h("p", { class: "hint", "aria-label": "Motion of this lock", hidden: true });
  private readonly own = h("ul", { class: "own", "aria-label": "Values of this lock alone" });
  private readonly edited = h("ul", { class: "own", "aria-label": "Edited locks" });
  private readonly lasso = document.createElementNS(NS, "polyline");
  /** Rows of the chosen locks; the last one has the handles. */
  private rows: number[] = [];
  private held = -1;
  private gesture = 0;
  private sending = 0;
  /** The lock and the shot whose motion was asked for last. */
  private asked = "";
  /** Whether another tool has the pointer. */
  busy = () => false;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
  ) {
    model.hear("locks", ({ side }) => side === "a" && this.arrived());
    this.handles.classList.add("handles");
    const close = h("button", { type: "button", class: "quiet", onclick: () => this.choose(-1) }, "Done");
    this.element.append(
      this.title,
      h("div", { class: "group" }, this.isolate, this.back, close),
      h("div", { class: "field-head falloff" }, h("label", { for: "lock-falloff", title: "Fraction of the length of the lock over which the move of a handle fades" }, "falloff"), this.falloff),
    );
    this.element.append(
      h(
        "div",
        { class: "field-head" },
        this.aloneLabel,
        this.alone,
      ),
      this.motion,
      this.own,
      this.edited,
    );
    this.lasso.classList.add("lasso");
    this.handles.append(this.lasso);
    this.listenForLasso();
    bindKey({ section: "Groom", keys: "N and P", does: "select the next lock, the previous one", on: plainKey("n", "p"), run: (event) => this.step(event.key.toLowerCase() === "n" ? 1 : -1) });
    this.alone.addEventListener("change", () => this.scope(this.alone.checked));
    this.isolate.addEventListener("click", () => model.say({ kind: "isolate", locks: this.ids }));
    this.back.addEventListener("click", () => model.say({ kind: "isolate", locks: this.isolatedIds, out: false }));
    this.falloff.style.setProperty("--part", "33%");
    const canvas = viewer.canvas;
    let pressed = { x: 0, y: 0 };
    canvas.addEventListener("pointerdown", (event) => {
      pressed = { x: event.clientX, y: event.clientY };
    });
    canvas.addEventListener("click", (event) => {
      if (Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) < STILL) this.click(event);
    });
    model.on("document", () => this.update());
    model.on("role", () => this.update());
    model.on("numbers", () => this.askMotion());
    model.on("lock_motion", () => this.showMotion());
  }

  private get row(): number {
    return this.rows.at(-1) ?? -1;
  }

  /** The id of the lock that was chosen last. */
  get id(): number {
    return this.viewer.hair.a.locks?.ids[this.row] ?? -1;
  }

  /** The ids of the chosen locks. */
  get ids(): number[] {
    const { locks } = this.viewer.hair.a;
    return locks ? this.rows.map((row) => locks.ids[row]) : [];
  }

  /** Chooses locks by their places in the list; -1: none. */
  choose(...rows: number[]): void {
    this.rows = rows.filter((row) => row >= 0);
    this.scope(this.rows.length > 0 && this.alone.checked);
    this.update();
    this.mark();
    this.model.tell("look");
  }

  /** Chooses locks by their ids. */
  chooseIds(ids: number[]): void {
    const { locks } = this.viewer.hair.a;
    const rows = ids.map((id) => locks?.ids.indexOf(id) ?? -1);
    if (rows.join() !== this.rows.join()) this.choose(...rows);
  }

  /** Chooses the next lock of the list, or the one before. */
  private step(by: number): void {
    const count = this.viewer.hair.a.locks?.ids.length ?? 0;
    if (!count || !this.model.documents.recipe) return;
    this.choose(this.row < 0 ? (by > 0 ? 0 : count - 1) : (this.row + by + count) % count);
  }

  /** Settings are those of this lock, or of all again. */
  private scope(alone: boolean): void {
    this.alone.checked = alone;
    this.model.locks = alone ? this.ids : [];
    this.model.tell("chosen");
  }

  /** Asks for the words of motion of the lock that was chosen last, whenever it or the shot is another. */
  private askMotion(): void {
    const { shot } = this.model.documents;
    const about = shot && this.id >= 0 ? `${this.id} ${this.model.numbers?.revision} ${shot.text}` : "";
    if (about !== this.asked && about && this.model.numbers) this.model.say({ kind: "ask_motion", lock: this.id });
    this.asked = about;
    this.showMotion();
  }

  private showMotion(): void {
    const { lockMotion } = this.model;
    const known = this.asked && lockMotion?.lock === this.id;
    this.motion.toggleAttribute("hidden", !known);
    this.motion.textContent = known ? lockMotion!.text : "";
  }

  /** What was given to the chosen locks alone, each with a way to take it out of all of them. */
  private tellOwn(): void {
    const said = this.model.documents.recipe?.said ?? {};
    const found = new Map<string, [Place, Json][]>(); // by the setting
    for (const id of this.ids)
      for (const own of ownValues(said, String(id))) {
        const setting = named(said, own[0].slice(0, -2));
        found.set(setting, [...(found.get(setting) ?? []), own]);
      }
    this.own.toggleAttribute("hidden", !found.size);
    this.own.replaceChildren(
      ...[...found].map(([setting, values]) => {
        const changes = values.map(([place]): [Place, Json] => [place, null]);
        const take = () => this.model.say({ kind: "set", changes, gesture: this.model.newGesture(), resting: true });
        const some = values.length < this.rows.length ? `, of ${values.length} of ${this.rows.length}` : "";
        const different = [...new Set(values.map(([, value]) => String(value)))].join(", ");
        return h("li", {}, h("span", {}, `${setting} ${different}${some}`), iconButton("bin", `Remove its own ${setting}`, take));
      }),
    );
  }

  /** What a lock is called: its place in the list, and where on the head it grows. */
  private called(row: number): string {
    const { locks } = this.viewer.hair.a;
    if (!locks || row < 0) return "";
    const root = new Vector3().fromArray(locks.points, 3 * locks.offsets[row]);
    const { x, y, z } = root.sub(this.viewer.middle);
    const size = Math.hypot(x, y, z) || 1;
    const where = [
      y > 0.75 * size ? "top" : z > 0.3 * size ? "front" : z < -0.3 * size ? "back" : "",
      x > 0.3 * size ? "left" : x < -0.3 * size ? "right" : "",
    ];
    return `${row + 1} · ${where.filter(Boolean).join(" ") || "side"}`;
  }

  /** The locks that were edited, each a button that chooses it. */
  private listEdited(): void {
    const recipe = this.model.documents.recipe;
    const { locks } = this.viewer.hair.a;
    const edits = ((recipe?.values["edit"] ?? []) as Record<string, Json>[]).map((edit) => Number(edit["lock"]));
    const all = locks ? [...new Set([...edits, ...lockIds(recipe?.said ?? {})])].sort((a, b) => a - b) : [];
    this.edited.toggleAttribute("hidden", !all.length);
    const rows = new Map(all.map((id) => [id, locks!.ids.indexOf(id)]));
    const there = all.filter((id) => rows.get(id)! >= 0).slice(0, MOST_LISTED);
    const button = (id: number) =>
      h("button", { type: "button", class: "quiet chip", title: `id ${id}`, onclick: () => this.choose(rows.get(id)!) }, this.called(rows.get(id)!));
    this.edited.replaceChildren(h("li", { class: "chips" }, "edited locks: ", ...there.map(button)));
  }

  /** Locks have come: the chosen one may be another row, or gone. */
  private arrived(): void {
    const count = this.viewer.hair.a.locks?.ids.length ?? 0;
    this.rows = this.rows.filter((row) => row < count);
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
      const { x, y } = onScreen(points[k], this.viewer.camera, this.viewer.size);
      dot.setAttribute("cx", String(x));
      dot.setAttribute("cy", String(y));
    });
  }

  /** Those of the chosen locks that are isolated. */
  private get isolatedIds(): number[] {
    const { locks } = this.viewer.hair.a;
    return locks ? this.rows.filter((row) => locks.marked[row]).map((row) => locks.ids[row]) : [];
  }

  private get isolated(): boolean {
    return this.row >= 0 && (this.viewer.hair.a.locks?.marked[this.row] ?? 0) > 0;
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
    if (!locks || this.viewer.looks.difference || !this.model.documents.recipe || this.busy()) return;
    const { viewer } = this;
    const row = viewer.onOpenLook(viewer.at(event), (at, size) => pick(locks.points, locks.offsets, viewer.camera, size, at)?.lock ?? -1);
    if (row === null) return; // another look is there
    const more = event.shiftKey || event.ctrlKey || event.metaKey;
    if (!more) this.choose(row);
    else if (row >= 0) this.choose(...(this.rows.includes(row) ? this.rows.filter((one) => one !== row) : [...this.rows, row]));
  }

  /** Shift and a drag draw a lasso: locks whose tips are seen in it are chosen. */
  private listenForLasso(): void {
    const { element } = this.viewer;
    let path: { x: number; y: number }[] = [];
    const draw = () => this.lasso.setAttribute("points", path.map(({ x, y }) => `${x},${y}`).join(" "));
    element.addEventListener(
      "pointerdown",
      (event) => {
        if (!event.shiftKey || event.button !== 0 || onButton(event) || this.busy() || !this.model.documents.recipe) return;
        event.stopPropagation();
        element.setPointerCapture(event.pointerId);
        path = [this.viewer.at(event)];
      },
      { capture: true },
    );
    element.addEventListener(
      "pointermove",
      (event) => {
        if (!path.length) return;
        event.stopPropagation();
        path.push(this.viewer.at(event));
        draw();
      },
      { capture: true },
    );
    const end = () => {
      if (path.length > 3) this.choose(...new Set([...this.rows, ...this.inLasso(path)]));
      path = [];
      draw();
    };
    for (const name of ["pointerup", "pointercancel"] as const) element.addEventListener(name, end, { capture: true });
  }

  private inLasso(path: { x: number; y: number }[]): number[] {
    const [first] = path;
    const seen = this.viewer.onOpenLook(first, (at, size) => {
      const inPart = path.map(({ x, y }) => ({ x: x - first.x + at.x, y: y - first.y + at.y }));
      return this.tipsWithin(inPart, size);
    });
    return seen ?? [];
  }

  /** Locks whose tips are seen within a line around them, by the camera as it is. */
  private tipsWithin(path: { x: number; y: number }[], size: Size): number[] {
    const { locks } = this.viewer.hair.a;
    if (!locks) return [];
    const { camera } = this.viewer;
    const middle = this.viewer.middle;
    const toEye = camera.position.clone().sub(middle).normalize();
    const found: number[] = [];
    for (let row = 0; row + 1 < locks.offsets.length; row++) {
      const tip = new Vector3().fromArray(locks.points, 3 * (locks.offsets[row + 1] - 1));
      const inFront = tip.clone().sub(middle).dot(toEye) > -0.02;
      if (inFront && isInside(onScreen(tip, camera, size), path)) found.push(row);
    }
    return found;
  }

  private mark(): void {
    const { locks } = this.viewer.hair.a;
    if (!locks) return;
    const marked = Uint8Array.from(locks.marked);
    for (const row of this.rows) marked[row] = 2;
    this.viewer.hair.a.mark(marked);
    this.viewer.invalidate();
  }

  private update(): void {
    this.element.toggleAttribute("hidden", this.row < 0);
    const one = `Lock ${this.called(this.row)}${this.isolated ? ", isolated" : ""}`;
    this.title.title = this.ids.map((id) => `id ${id}`).join(", ");
    this.aloneLabel.textContent = `values of ${this.rows.length > 1 ? "these locks" : "this lock"} alone`;
    this.title.textContent = this.rows.length > 1 ? `${this.rows.length} locks` : one;
    const isolated = this.isolatedIds.length;
    this.isolate.toggleAttribute("hidden", isolated === this.rows.length);
    this.back.toggleAttribute("hidden", !isolated);
    this.back.textContent = this.rows.length > 1 ? "Reset locks" : "Reset lock";
    this.listEdited();
    this.element.querySelector(".falloff")!.toggleAttribute("hidden", !this.isolated);
    this.element.toggleAttribute("inert", !this.model.role.leads);
    this.tellOwn();
    this.askMotion();
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
    dot.addEventListener("pointercancel", () => {
      this.held = -1;
    });
    dot.addEventListener("keydown", (event) => this.key(event, index));
    this.handles.append(dot);
    return dot;
  }

  private under(event: PointerEvent, index: number): Vector3 {
    return inPlane(this.viewer.at(event), this.points()[index], this.viewer.camera, this.viewer.size);
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
        falloff: Number(this.falloff.value),
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

/** Ids of locks that a recipe gives values of their own. */
function* lockIds(said: Json): Generator<number> {
  if (said === null || typeof said !== "object") return;
  for (const [key, value] of Object.entries(said)) {
    if (key === "lock" && value !== null && typeof value === "object") yield* Object.keys(value).map(Number);
    else yield* lockIds(value);
  }
}

/** Whether a place is inside of a closed path: a ray from there crosses it an odd number of times. */
function isInside(at: { x: number; y: number }, path: { x: number; y: number }[]): boolean {
  let inside = false;
  path.forEach((a, k) => {
    const b = path[(k + 1) % path.length];
    if (a.y > at.y !== b.y > at.y && at.x < a.x + ((at.y - a.y) / (b.y - a.y)) * (b.x - a.x)) inside = !inside;
  });
  return inside;
}

/** A setting as a person calls it: the operator in place of its number. */
function named(said: Json, place: Place): string {
  const [first, second, ...rest] = place;
  if (first !== "shape" || typeof second !== "number") return place.join(" ");
  const operator = (said as { shape: { op?: string }[] }).shape[second];
  return [operator?.op ?? `shape ${second + 1}`, ...rest].join(" ");
}
