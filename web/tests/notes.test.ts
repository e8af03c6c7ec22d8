// The dock: notes that are typed and reference pictures that are moved, while answers of the server arrive.

import { expect, test } from "vitest";
import type { Note, Reference } from "../src/protocol";
import { control, drag, fill, find, press } from "./controls";
import { open, type Page } from "./page";

const note = (page: Page, id: string, text: string): Note => ({
  ...{ id, text, author: "A", time: "2026-01-01T10:00:00", resolved: false },
  ...{ look: page.app.look.state, at: null, lock: null, point: 0, strokes: [] },
});

test("answers overwrite no note that is typed", async () => {
  const page = await open();
  press("t", {}, page.app.viewer.canvas);
  control("Notes").click();
  page.hear({ kind: "notes", notes: [note(page, "1", "first")] });
  const text = control<HTMLTextAreaElement>("Text of note 1");
  fill(text, "first, softer");
  page.hear({ kind: "notes", notes: [note(page, "1", "first"), note(page, "2", "second")] });
  expect(page.model.notes.length).toBe(2);
  expect(control<HTMLTextAreaElement>("Text of note 1").value).toBe("first, softer");
  expect(document.activeElement).toBe(text);
  text.dispatchEvent(new Event("change"));
  expect(page.last("edit_note")).toEqual({ kind: "edit_note", id: "1", text: "first, softer" });
  text.blur();
  page.hear({ kind: "notes", notes: [note(page, "1", "first, softer"), note(page, "2", "second")] });
  expect(control<HTMLTextAreaElement>("Text of note 2").value).toBe("second");
});

test("a note says what it is about apart from whether it is resolved", async () => {
  const page = await open();
  press("t", {}, page.app.viewer.canvas);
  const one = note(page, "1", "softer");
  page.hear({ kind: "notes", notes: [{ ...one, lock: 3, look: { ...one.look, frame: 8 } }] });
  expect(find(".card.note > .by").textContent).toBe("Written on lock 3, at frame 8");
  expect(find(".card.note .resolves").textContent).toBe("Resolved");
});

test("answers overwrite no picture that is moved", async () => {
  const page = await open();
  const reference: Reference = { id: "1", name: "photo.png", mode: "next", opacity: 0.5, x: -0.35, y: 0, scale: 0.5 };
  press("t", {}, page.app.viewer.canvas);
  control("References").click();
  page.hear({ kind: "references", references: [reference] });
  const size = control<HTMLInputElement>("size of ‘photo.png’");
  size.focus(); // the slider of its card is moved after the picture was dragged, which leaves the focus where it was
  drag(find(".reference"), [20, 20], [[60, 40], [100, 60]]);
  const { height } = page.app.viewer.clear;
  const moved = page.last("place_reference");
  expect(moved.x).toBeCloseTo(-0.35 + 80 / height, 3);
  expect(moved.y).toBeCloseTo(-40 / height, 3);
  page.hear({ kind: "references", references: [{ ...reference, x: moved.x!, y: moved.y! }] });
  expect(document.activeElement).toBe(size);
  size.value = "0.51";
  for (const event of ["input", "change"]) size.dispatchEvent(new Event(event));
  expect(page.last("place_reference")).toMatchObject({ scale: 0.51, x: moved.x, y: moved.y });
});
