// Snapshots of the look: taken by a button or a key, and shown as a list of thumbnails.

import { h, iconButton } from "../dom";
import type { Model } from "../model";
import type { Snapshot } from "../protocol";
import { thumbnail } from "../view/capture";
import type { Viewer } from "../view/viewer";
import { ownName, shortTime } from "./author";
import { compareWith } from "./compare";
import { openDialog } from "./dialog";
import { bindKey, plainKey } from "./keys";
import type { Look } from "./look";
import type { Notices } from "./status";
import type { Dock, DockTab } from "./dock";

type Kept = "take_snapshot" | "keep_take";

export class Snapshots {
  readonly button = iconButton("snapshot", "Take a snapshot (S)", () => this.take());
  private readonly strip = h("ul", { class: "strip", "aria-label": "Snapshots" });
  private readonly tab: DockTab;
  /** What is taken as soon as the groom is that of its settings. */
  private waiting: Kept | null = null;
  /** Plays the take of a snapshot. */
  play = (_: string): void => {};
  /** Makes a shot of it. */
  makeShot = (_: string): void => {};

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly look: Look,
    private readonly dock: Dock,
    private readonly notices: Notices,
  ) {
    const take = h("button", { type: "button", class: "primary", onclick: () => this.take() }, "Take a snapshot");
    this.tab = { title: "Snapshots", element: this.strip, kept: true, signed: true, actions: [take], count: () => model.snapshots.length };
    dock.add(this.tab);
    for (const topic of ["snapshots", "pictures", "role"] as const) model.on(topic, () => this.update());
    this.button.hidden = take.hidden = true; // until a recipe is open
    model.on("document", () => {
      this.button.hidden = take.hidden = !model.documents.recipe;
    });
    model.on("numbers", () => this.waiting && model.settled && this.take(this.waiting));
    bindKey({ section: "Review", keys: "S", does: "take a snapshot", on: plainKey("s"), run: () => this.take() });
    this.update();
  }

  /** Takes a snapshot of the open recipe, or of live hair, as soon as the groom that is seen is that of its settings. */
  take(kind: Kept = "take_snapshot"): void {
    const { model } = this;
    if (!model.documents.recipe) return;
    this.waiting = model.settled || model.stuck ? null : kind;
    if (this.waiting) return;
    const picture = thumbnail(this.viewer).toDataURL("image/png").split(",")[1];
    model.say({ kind, author: ownName(), look: this.look.state, picture });
    if (kind === "take_snapshot") this.notices.show("A snapshot is taken (T shows it)"); // who changes settings stays with them
  }

  private update(): void {
    const { snapshots } = this.model;
    this.dock.update();
    if (this.strip.contains(document.activeElement) && document.activeElement instanceof HTMLTextAreaElement) return;
    const empty = h("li", { class: "nothing" }, "No snapshots yet. A snapshot keeps the settings, the camera and the light, with a picture and a note.");
    const at = this.strip.scrollLeft;
    this.strip.replaceChildren(...(snapshots.length ? [...snapshots].reverse().map((one) => this.card(one)) : [empty]));
    this.strip.scrollLeft = at;
  }

  private card(one: Snapshot): HTMLElement {
    const { model } = this;
    const { leads } = model.role;
    const title = one.note.split("\n")[0] || shortTime(one.time);
    const picture = h("img", { src: model.pictures.get(`snapshots/${one.id}`), alt: "" });
    const compare = h(
      "button",
      { type: "button", class: "thumbnail", disabled: !leads, title: "Compare with it", "aria-label": `Compare with ‘${title}’`, onclick: () => compareWith(model, `snapshot:${one.id}`) },
      picture,
      one.seconds > 0 && h("span", { class: "seconds" }, `${one.seconds.toFixed(1)} s`),
    );
    const note = h("textarea", { rows: 1, maxlength: 4000, placeholder: "Note", "aria-label": `Note of ‘${title}’` });
    note.value = one.note;
    note.addEventListener("change", () => model.say({ kind: "edit_snapshot", id: one.id, note: note.value }));
    note.addEventListener("keydown", (event) => event.key === "Escape" && compare.focus());
    note.addEventListener("blur", () => setTimeout(() => this.update()));
    const buttons = h(
      "span",
      { class: "group" },
      one.seconds > 0 && iconButton("play", "Play the take", () => this.play(one.id), { disabled: !leads }),
      one.seconds > 0 && iconButton("film", "Make a shot of the take", () => this.makeShot(one.id), { disabled: !leads }),
      iconButton("load", "Load: use its settings", () => model.say({ kind: "load_snapshot", id: one.id }), { disabled: !leads }),
      iconButton("camera", "Use its camera and light", () => this.look.apply(one.look, false)),
      iconButton("bin", "Delete", () => this.askDelete(one, title)),
    );
    const when = h("time", { datetime: one.time, title: new Date(one.time).toLocaleString() }, shortTime(one.time));
    const head = h("div", { class: "card-head" }, h("span", { class: "by" }, one.author, one.author ? " · " : "", when), buttons);
    return h("li", { class: "card", "data-id": one.id }, compare, head, note);
  }

  private askDelete(one: Snapshot, title: string): void {
    const remove = h("button", { type: "button", class: "primary" }, "Delete");
    const dialog = openDialog("Delete a snapshot", h("p", {}, `‘${title}’ and its files are deleted for all viewers.`), remove);
    remove.addEventListener("click", () => {
      this.model.say({ kind: "delete_snapshot", id: one.id });
      dialog.close();
    });
    remove.focus();
  }
}
