// The dock: one panel at a time, and what those find in it who only look.

import { expect, test } from "vitest";
import { control, fill, find, press, slide, slider, texts } from "./controls";
import { open } from "./page";

const shown = () => texts('.dock [role="tab"][aria-selected="true"]');

test("one panel is in the dock, and the stages are there with the settings", async () => {
  const page = await open("small.shot");
  expect(texts('.dock [role="tab"]:not([hidden])')).toEqual(["Settings", "Chart", "Snapshots", "Notes", "References"]);
  expect(shown()).toEqual(["Settings"]);
  control("Chart of the swing, and earlier runs").click();
  expect(shown()).toEqual(["Chart"]);
  expect([...document.querySelectorAll<HTMLElement>(".dock-panel")].filter((one) => !one.hidden).length).toBe(1);
  expect(document.documentElement.dataset["dock"]).toBe("chart");
  control("Chart of the swing, and earlier runs").click();
  expect(shown()).toEqual(["Settings"]);
  page.model.choose("recipe", ["curl"]);
  press("a", {}, page.app.viewer.canvas);
  expect(shown()).toEqual(["Notes"]);
  page.model.choose("recipe", ["locks"]); // a stage that is chosen shows its settings
  expect(shown()).toEqual(["Settings"]);
});

test("tabs go by arrows, and T goes between the settings and what was seen last", async () => {
  const page = await open();
  const key = (name: string) => press(name, {}, find('.dock [role="tab"][aria-selected="true"]'));
  key("ArrowRight");
  key("ArrowRight");
  expect(shown()).toEqual(["Notes"]);
  key("ArrowLeft");
  expect(shown()).toEqual(["Snapshots"]);
  press("t", {}, page.app.viewer.canvas);
  expect(shown()).toEqual(["Settings"]);
  press("t", {}, page.app.viewer.canvas);
  expect(shown()).toEqual(["Snapshots"]);
  press("/", {}, page.app.viewer.canvas);
  expect(shown()).toEqual(["Settings"]);
});

test("who only looks reads and searches the settings, and changes none", async () => {
  const page = await open();
  page.role({ leads: false });
  const { disabled } = find<HTMLFieldSetElement>(".settings > .fields");
  expect(disabled).toBe(true);
  expect(find(".settings > .hint").textContent).toContain("To change them, ask to edit");
  fill(control<HTMLInputElement>("Search settings"), "curlier");
  press("Enter", {}, control("Search settings"));
  expect(page.model.chosen.place).toEqual(["curl"]);
  expect(document.querySelectorAll(".settings .line").length).toBe(0); // all of each setting is in sight
  slide(slider("curl.width"), 0.02);
  expect(page.said("set")).toEqual([]);
});

test("no two buttons or lists of a shot have the same name", async () => {
  await open("small.shot");
  const all = [...document.querySelectorAll("button, select")].filter((one) => !one.closest("[hidden], .fields, .sheets"));
  const names = all.map((one) => one.getAttribute("aria-label") ?? one.textContent);
  expect(names.filter((name, k) => names.indexOf(name) !== k)).toEqual([]);
  expect(names).toContain("Compare looks");
  expect(names).toContain("Compare runs and caches");
});
