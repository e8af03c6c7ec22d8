// What a page had when the connection was lost, to be given back to a server that was started anew.

import type { File, Model } from "./model";

/** Unsaved texts of a file, and those that were read or saved last. */
type Texts = Record<"text" | "edits" | "saved" | "saved_edits", string>;

export class Unsaved {
  private kept: Partial<Record<File, Texts>> = {};

  constructor(private readonly model: Model) {}

  /** Keeps what is not saved, if this page may change it. */
  keep(): void {
    const { documents, role } = this.model;
    if (!role.leads) return;
    for (const [file, { dirty, text, edits, saved, saved_edits }] of Object.entries(documents))
      if (dirty) this.kept[file as File] = { text, edits, saved, saved_edits };
  }

  /** Gives it to the server, as one step that can be undone. */
  giveBack(): void {
    for (const [file, texts] of Object.entries(this.kept)) this.model.say({ kind: "restore", file: file as File, ...texts });
  }

  forget(): void {
    this.kept = {};
  }
}
