// Notes about the look: pinned to a camera, a lock and a frame, with arrows and lines drawn over the picture.

import { Vector3 } from "three";
import { h, iconButton } from "../dom";
import type { Model } from "../model";
import type { Note } from "../protocol";
import { arrow, fromPixels, isNew, type Stroke, toPixels } from "../view/marks";
import { onScreen, pick } from "../view/pick";
import type { Viewer } from "../view/viewer";
import { ownName, shortTime } from "./author";
import { openDialog } from "./dialog";
import { bindKey, plainKey } from "./keys";
import type { Look } from "./look";
import "./notes.css";
import type { Dock, DockTab } from "./dock";

type Tool = "pin" | "arrow" | "pen";
const TOOLS: Record<Tool, string> = { pin: "Pin to the hair", arrow: "Arrow", pen: "Draw" };
const SAME = 1e-3; // cameras that differ by less see the same [m]
const SVG = "http://www.w3.org/2000/svg";

interface Pin {
  at: [number, number, number];
  lock: number | null;
  point: number;
}

/** A note that is being written. */
interface Draft {
  text: string;
  strokes: Stroke[];
  pin: Pin | null;
  tool: Tool;
}

export class Notes {
  /** Over the picture: pins, and the lines of the note that is open. */
  readonly marks = document.createElementNS(SVG, "svg");
  private readonly list = h("ul", { class: "strip", "aria-label": "Notes" });
  private readonly tab: DockTab;
  private draft: Draft | null = null;
  private line: Stroke | null = null;
  /** The note whose view is seen. */
  private opened = "";

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly look: Look,
    private readonly dock: Dock,
  ) {
    this.marks.classList.add("marks");
    const add = h("button", { type: "button", class: "primary", onclick: () => this.begin() }, "Write a note");
    this.tab = { title: "Notes", element: this.list, kept: true, signed: true, actions: [add], count: () => model.notes.filter((one) => !one.resolved).length };
    dock.add(this.tab);
    for (const topic of ["notes", "role"] as const) model.on(topic, () => this.update());
    bindKey({ section: "Review", keys: "A", does: "write a note, with arrows and lines over the picture", on: plainKey("a"), run: () => this.begin() });
    bindKey({ section: "Review", keys: "Escape", does: "discard the note that is being written", on: (event) => this.draft !== null && event.key === "Escape", run: () => this.end() });
    this.marks.addEventListener("pointerdown", (event) => this.press(event));
    this.marks.addEventListener("pointermove", (event) => this.drag(event));
    for (const name of ["pointerup", "pointercancel"] as const) this.marks.addEventListener(name, () => this.release());
    this.update();
  }

  /** Places pins and lines where they are seen now. */
  place(): void {
    const { viewer, model } = this;
    const parts: Element[] = [];
    const split = viewer.looks.split;
    if (!split && this.dock.isShown(this.tab)) {
      model.notes.forEach((note, k) => {
        const pin = !note.resolved && note.at && this.whereIs(note as Pin);
        if (pin) parts.push(this.dot(pin, String(k + 1), note));
      });
    }
    const shown = this.draft?.strokes ?? (this.isSeen() ? this.open?.strokes : undefined) ?? [];
    for (const stroke of split ? [] : [...shown, ...(this.line ? [this.line] : [])])
      for (const kind of ["under", "over"]) {
        const line = document.createElementNS(SVG, "polyline");
        line.classList.add(kind);
        line.setAttribute("points", stroke.map((point) => Object.values(toPixels(point as [number, number], viewer.clear)).join(",")).join(" "));
        parts.push(line);
      }
    const pin = this.draft?.pin && this.whereIs(this.draft.pin);
    if (pin) parts.push(this.dot(pin, "+", null));
    this.marks.replaceChildren(...parts);
  }

  private get open(): Note | undefined {
    return this.model.notes.find(({ id }) => id === this.opened);
  }

  /** Whether the view is that of the open note. */
  private isSeen(): boolean {
    const { camera } = this.viewer.cameraState;
    return this.open?.look.camera.every((value, k) => Math.abs(value - camera[k]) < SAME) ?? false;
  }

  /** Where a pin is: it follows its lock. */
  private whereIs({ at, lock, point }: Pin): { x: number; y: number } | null {
    const { camera, size, hair } = this.viewer;
    const place = new Vector3(...at);
    const { locks } = hair.a;
    const row = lock === null || !locks ? -1 : locks.ids.indexOf(lock);
    if (locks && row >= 0 && locks.offsets[row] + point < locks.offsets[row + 1])
      place.fromArray(hair.a.placed ?? locks.points, 3 * (locks.offsets[row] + point));
    const seen = onScreen(place, camera, size);
    return seen.x < 0 || seen.y < 0 || seen.x > size.width || seen.y > size.height ? null : seen;
  }

  private dot({ x, y }: { x: number; y: number }, label: string, note: Note | null): Element {
    const group = document.createElementNS(SVG, "g");
    group.setAttribute("transform", `translate(${x} ${y})`);
    group.classList.add("pin");
    group.classList.toggle("open", note?.id === this.opened);
    const circle = document.createElementNS(SVG, "circle");
    circle.setAttribute("r", "10");
    const text = document.createElementNS(SVG, "text");
    text.textContent = label;
    group.append(circle, text);
    if (note) group.addEventListener("click", () => this.show(note));
    return group;
  }

  /** Brings back the view of a note. */
  private show(note: Note): void {
    this.opened = note.id;
    this.look.apply(note.look, true);
    this.dock.open(this.tab);
    this.update();
    this.list.querySelector(`[data-id="${note.id}"]`)?.scrollIntoView({ block: "nearest", inline: "nearest" });
  }

  private begin(): void {
    if (this.draft) return;
    this.draft = { text: "", strokes: [], pin: null, tool: "pin" };
    this.opened = "";
    this.dock.open(this.tab);
    this.update();
    this.list.querySelector("textarea")?.focus();
  }

  private end(): void {
    this.draft = this.line = null;
    this.update();
  }

  private keep(): void {
    const { draft } = this;
    if (!draft || (!draft.text.trim() && !draft.strokes.length)) return;
    const { at = null, lock = null, point = 0 } = draft.pin ?? {};
    const { text, strokes } = draft;
    this.model.say({ kind: "write_note", author: ownName(), text: text.trim(), look: this.look.state, at, lock, point, strokes });
    this.end();
  }

  private press(event: PointerEvent): void {
    const { draft, viewer } = this;
    if (!draft) return;
    event.preventDefault();
    this.marks.setPointerCapture(event.pointerId);
    if (draft.tool === "pin") {
      const { locks } = viewer.hair.a;
      const found = locks && pick(locks.points, locks.offsets, viewer.camera, viewer.size, viewer.at(event), 14);
      if (!found) return;
      const at = new Vector3().fromArray(locks.points, 3 * (locks.offsets[found.lock] + found.point)).toArray();
      draft.pin = { at, lock: locks.ids[found.lock], point: found.point };
      this.place();
    } else this.line = [fromPixels(viewer.at(event), viewer.clear)];
  }

  private drag(event: PointerEvent): void {
    const { draft, line, viewer } = this;
    if (!draft || !line) return;
    const at = fromPixels(viewer.at(event), viewer.clear);
    if (draft.tool === "arrow") this.line = arrow(line[0], at);
    else if (isNew(line, at)) line.push(at);
    this.place();
  }

  private release(): void {
    if (this.draft && this.line && this.line.length > 1) this.draft.strokes.push(this.line);
    this.line = null;
    this.place();
  }

  private update(): void {
    this.dock.update();
    this.marks.classList.toggle("draws", this.draft !== null);
    if (!this.typing) {
      const notes = this.model.notes.map((note, k) => this.card(note, k + 1));
      const resolved = (card: HTMLElement) => Number(card.classList.contains("resolved"));
      notes.sort((a, b) => resolved(a) - resolved(b));
      const empty = h("li", { class: "nothing" }, "No notes yet. A note remembers the camera, the lock and the frame that it is about.");
      this.list.replaceChildren(...(this.draft ? [this.editor(this.draft)] : []), ...notes, ...(notes.length || this.draft ? [] : [empty]));
    }
    this.place();
  }

  /** Whether the text of a note is being typed: its card stays. A draft that was ended goes. */
  private get typing(): boolean {
    const { activeElement } = document;
    if (!(activeElement instanceof HTMLTextAreaElement) || !this.list.contains(activeElement)) return false;
    return this.draft !== null || activeElement.closest(".draft") === null;
  }

  private editor(draft: Draft): HTMLElement {
    const text = h("textarea", { rows: 3, maxlength: 4000, placeholder: "What should change here?", "aria-label": "Text of the note" });
    text.value = draft.text;
    text.addEventListener("input", () => (draft.text = text.value));
    text.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) this.keep();
      if (event.key === "Escape") this.end();
    });
    const tools = Object.entries(TOOLS).map(([name, label]) => {
      const button = h("button", { type: "button", class: "quiet", "aria-pressed": String(draft.tool === name) }, label);
      button.addEventListener("click", () => {
        draft.tool = name as Tool;
        for (const one of tools) one.setAttribute("aria-pressed", String(one === button));
      });
      return button;
    });
    const button = (label: string, press: () => void, kind = "quiet") => h("button", { type: "button", class: kind, onclick: press }, label);
    return h(
      "li",
      { class: "card draft" },
      text,
      h("div", { class: "group tools", role: "group", "aria-label": "On the picture" }, ...tools),
      h("div", { class: "group" }, button("Keep", () => this.keep(), "primary"), button("Discard", () => this.end())),
    );
  }

  private card(note: Note, number: number): HTMLElement {
    const { model } = this;
    const change = (values: { text?: string; resolved?: boolean }) => model.say({ kind: "edit_note", id: note.id, ...values });
    const text = h("textarea", { rows: 2, maxlength: 4000, "aria-label": `Text of note ${number}` });
    text.value = note.text;
    text.addEventListener("change", () => change({ text: text.value }));
    const resolved = h("input", { type: "checkbox", checked: note.resolved });
    resolved.addEventListener("change", () => change({ resolved: resolved.checked }));
    const where = [note.lock !== null && `on lock ${note.lock}`, note.look.frame !== null && `at frame ${note.look.frame}`].filter(Boolean).join(", ");
    const show = h("button", { type: "button", class: "quiet number", title: "Show what it is about", "aria-label": `Show note ${number}`, onclick: () => this.show(note) }, String(number));
    const kind = `card note${note.resolved ? " resolved" : ""}${note.id === this.opened ? " open" : ""}`;
    return h(
      "li",
      { class: kind, "data-id": note.id },
      h(
        "div",
        { class: "card-head" },
        show,
        h("span", { class: "by", title: new Date(note.time).toLocaleString() }, [note.author, shortTime(note.time)].filter(Boolean).join(" · ")),
        iconButton("bin", `Delete note ${number}`, () => this.askDelete(note, number)),
      ),
      where && h("p", { class: "by" }, `Written ${where}`),
      text,
      h("label", { class: "resolves" }, resolved, "Resolved"),
    );
  }

  private askDelete(note: Note, number: number): void {
    const remove = h("button", { type: "button", class: "primary" }, "Delete");
    const dialog = openDialog("Delete a note", h("p", {}, `Note ${number} is deleted for all viewers.`), remove);
    remove.addEventListener("click", () => {
      this.model.say({ kind: "delete_note", id: note.id });
      dialog.close();
    });
    remove.focus();
  }
}
