// Files, problems and keys: what dialogs say, and what the page shows of messages.

import { expect, test } from "vitest";
import type { Problem } from "../src/protocol";
import { control, dialog, enter, fill, find, number, press, texts } from "./controls";
import { open } from "./page";

const eye = (page: Awaited<ReturnType<typeof open>>) => page.app.viewer.camera.position.toArray();

test("keys act on the page, but not on text that is typed", async () => {
  const page = await open();
  const { canvas } = page.app.viewer;
  control("Save as…").click();
  fill(find("#save-name"), "wide");
  expect(press("z", { ctrlKey: true })).toBe(false); // of the text alone
  expect(page.said("undo")).toEqual([]);
  control("Close", dialog()).click();
  press("ArrowLeft", {}, canvas);
  const there = eye(page);
  press("f", {}, canvas);
  expect(eye(page)).not.toEqual(there);
  press("?", {}, canvas);
  expect(dialog().getAttribute("aria-label")).toBe("Keyboard shortcuts");
  expect(dialog().textContent).toContain("Ctrl+Shift+Z");
  expect(texts("h3", dialog())).toEqual(["File", "View", "Groom", "Review", "Frames"]);
  control("Close", dialog()).click();
  press("z", { ctrlKey: true }, document.body);
  expect(page.said("undo").length).toBe(1);
  press("z", { ctrlKey: true, shiftKey: true }, document.body);
  expect(page.said("redo").length).toBe(1);
});

test("another file is opened after unsaved changes are saved", async () => {
  const page = await open();
  page.hear({ kind: "files", names: ["other.recipe.toml", "small.recipe.toml"] });
  enter(number("curl.width"), "2");
  page.setting(["curl", "width"], 2, 0.02);
  press("o", { ctrlKey: true });
  expect(texts(".file", dialog())).toEqual(["other.recipe.toml"]);
  control("other.recipe.toml", dialog()).click();
  expect(page.said("open")).toEqual([]);
  control("Save and open", dialog()).click();
  expect(page.last("save")).toEqual({ kind: "save", file: "recipe" });
  expect(page.last("open")).toEqual({ kind: "open", name: "other.recipe.toml", discard: false });
  expect(document.querySelector("dialog")).toBeNull();

  const { ids } = page.app.viewer.hair.a.locks!;
  page.hear({ ...page.model.welcome!, name: "other.recipe.toml" });
  page.hear({ ...page.first("document"), name: "other.recipe.toml" });
  const locks = page.first("locks");
  page.hear({ ...locks, ids: locks.ids.slice(0, 4), offsets: locks.offsets.slice(0, 5), points: locks.points.slice(0, 3 * 160), axis: locks.axis.slice(0, 3 * 160), marked: locks.marked.slice(0, 4) });
  expect([ids.length, page.app.viewer.hair.a.locks!.ids.length]).toEqual([8, 4]);

  control("Save as…").click();
  fill(find("#save-name"), "third");
  find<HTMLFormElement>("form", dialog()).requestSubmit();
  expect(page.last("save")).toEqual({ kind: "save", file: "recipe", name: "third", variant: false, with_copy: false });
  page.hear({ ...page.model.welcome!, name: "third.recipe.toml" });
  page.hear({ ...page.first("document"), name: "third.recipe.toml" });
  expect(find(".file-name").textContent).toBe("third.recipe.toml");
});

test("the bar names the files that are written, and each of them gets a name of its own", async () => {
  const page = await open("small.shot");
  const saveAs = (...names: string[]) => {
    control("Save as…").click();
    names.forEach((name, k) => fill(find(`#save-name${k || ""}`), name));
    expect(dialog().querySelectorAll("input[name]").length).toBe(names.length);
    find<HTMLFormElement>("form", dialog()).requestSubmit();
  };
  page.document({ file: "shot" });
  expect(find(".file-name").textContent).toBe("small.shot.toml ·");
  expect(control("Save").title).toBe("Save small.shot.toml (Ctrl+S)");
  saveAs("slow");
  expect(page.said("save")).toEqual([{ kind: "save", file: "shot", name: "slow", variant: false, with_copy: false }]);
  page.document({ file: "recipe" });
  expect(find(".file-name").textContent).toBe("small.recipe.toml, small.shot.toml ·");
  saveAs("wide", "slow");
  expect(page.said("save").slice(1)).toEqual([
    { kind: "save", file: "recipe", name: "wide", variant: false, with_copy: false },
    { kind: "save", file: "shot", name: "slow", variant: false, with_copy: true },
  ]);
});

test("a conflict is merged setting by setting", async () => {
  const page = await open();
  const difference = { name: "curl.width", base: "1.0", mine: "2", theirs: "1.3", both: true };
  const differences = [difference, { name: "curl.pitch", base: "1.75", mine: "1.75", theirs: "1.25", both: false }];
  const problem: Problem = { subject: "conflict/recipe", message: "changed on disk", file: "recipe", setting: "", fixes: [], differences };
  page.hear({ kind: "problems", problems: [problem] });
  control("See and merge …").click();
  const merge = control<HTMLButtonElement>("Merge", dialog());
  expect(merge.disabled).toBe(true);
  expect(control<HTMLInputElement>("curl.pitch: theirs", dialog()).checked).toBe(true); // what one side changed
  control("curl.width: mine", dialog()).click();
  expect(merge.disabled).toBe(false);
  merge.click();
  expect(page.last("resolve")).toEqual({ kind: "resolve", file: "recipe", choice: "merge", mine: ["curl.width"], theirs: ["curl.pitch"] });
  page.hear({ kind: "problems", problems: [] });
  expect(document.querySelector('[data-problem="conflict/recipe"]')).toBeNull();
});

test("messages do not pile up, and the diff is whole", async () => {
  const page = await open();
  for (const k of [0, 1, 2, 0, 1]) page.hear({ kind: "notice", message: `message ${k}` });
  expect(document.querySelectorAll(".notice").length).toBe(2);
  const long = "x".repeat(300);
  const sign = { sign: "+", line: `name = '${long}'` } as const;
  page.document({ changes: [sign] });
  find(".file-name").click();
  expect(find("ins.change", dialog()).textContent).toContain(long);
});
