// Keys alone: each action leaves the focus where it was, or at what has that place now.

import { expect, test } from "vitest";
import { control, dialog, enter, fill, find, number, press } from "./controls";
import { open } from "./page";

const focused = () => document.activeElement as HTMLElement;
/** Lets the page see what has changed in it. */
const seen = () => Promise.resolve();

test("save keeps the focus in the field that was typed in, and on a button after it is disabled", async () => {
  const page = await open();
  const length = number("guides.length");
  let typed = false; // a browser says `change` then
  length.addEventListener("blur", () => (typed = true));
  fill(length, "7");
  press("s", { ctrlKey: true });
  expect([typed, focused()]).toEqual([true, length]);
  page.setting(["guides", "length"], 7, 0.07);
  control("Save").focus();
  page.document({ dirty: false });
  await seen();
  expect(focused().textContent).toBe("Save as…");
});

test("undo keeps the focus while a panel is built anew, and goes on to redo after the first step", async () => {
  const page = await open();
  page.document({ redo: true });
  control("Undo").focus();
  page.document({ undo: false, redo: true });
  await seen();
  expect(focused().getAttribute("aria-label")).toContain("Redo");

  page.model.choose("recipe", ["curl"]);
  enter(number("curl.width"), "2");
  press("z", { ctrlKey: true }, document.body);
  page.setting(["curl"], undefined, page.model.value("recipe", ["curl"]));
  await seen();
  expect(focused()).toBe(number("curl.width"));
});

test("a stage that is muted, moved or removed leaves the focus in the list of stages", async () => {
  const page = await open();
  const { stages } = page.model.documents.recipe!;
  const shape = (name: string, k: number) => ({ ...stages[0], name, op: name, place: ["shape", k], muted: false, solo: false });
  const others = stages.filter(({ place }) => place[0] !== "shape");
  const arranged = (...names: string[]) => page.document({ stages: [...others, ...names.map(shape)] });
  arranged("bend", "frizz", "lift");
  for (const name of ["Mute frizz", "Solo frizz", "Move frizz up"]) {
    const before = control(name);
    before.focus();
    arranged("bend", "frizz", "lift");
    await seen();
    expect(before.isConnected).toBe(false);
    expect(focused().getAttribute("aria-label")).toBe(name);
  }
  control("Move frizz up").focus();
  arranged("frizz", "bend", "lift"); // it is the first now
  await seen();
  expect(find(".stack").contains(focused())).toBe(true);
  control("Remove lift").focus();
  arranged("frizz", "bend");
  await seen();
  expect(find(".stack").contains(focused())).toBe(true);
});

test("a setting that is reset leaves the focus on its number", async () => {
  const page = await open();
  page.model.choose("recipe", ["curl"]);
  page.setting(["curl", "width"], 2, 0.02);
  find('[data-setting="curl.width"] .reset').focus();
  page.setting(["curl", "width"], undefined, 0.01);
  await seen();
  expect(focused()).not.toBe(find('[data-setting="curl.width"] .reset'));
  expect(focused().closest<HTMLElement>("[data-setting]")?.dataset["setting"]).toBe("curl.width");
});

test("what takes the edit lock away leaves the focus in the panel, and a dialog gives it back", async () => {
  const page = await open();
  number("guides.length").focus();
  page.role({ leads: false });
  await seen();
  expect(find(".dock").contains(focused())).toBe(true);
  page.role({ leads: true });
  control("Save as…").focus();
  control("Save as…").click();
  control("Close", dialog()).focus();
  control("Close", dialog()).click();
  await seen();
  expect(focused()).not.toBe(document.body);
});

test("a note that is given up leaves the focus where keys are no text, and a field that is left does not get it again", async () => {
  const page = await open();
  press("a", {}, document.body);
  expect(focused().tagName).toBe("TEXTAREA");
  press("Escape");
  await seen();
  expect(focused().matches("textarea, input")).toBe(false);
  expect(focused()).not.toBe(document.body);

  control("Settings").click();
  number("guides.length").focus();
  number("guides.length").blur();
  await seen();
  page.model.choose("recipe", ["curl"]);
  await seen();
  expect(focused()).toBe(document.body);
});

test("a search that is given up leaves the focus in the picture", async () => {
  const page = await open();
  page.app.viewer.canvas.focus();
  press("/");
  expect(focused()).toBe(find(".search"));
  press("Escape");
  expect(focused()).toBe(page.app.viewer.canvas);
});

test("a button that a pointer has pressed leaves the focus in the picture, where keys act on the page", async () => {
  const page = await open();
  page.document({ redo: true });
  const undo = control("Undo");
  undo.dispatchEvent(new PointerEvent("pointerdown", { bubbles: true }));
  undo.focus();
  page.document({ undo: false });
  await seen();
  expect(focused()).toBe(page.app.viewer.canvas);
});
