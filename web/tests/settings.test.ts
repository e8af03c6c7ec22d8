// The panel of settings: its first sight, the search over all stages, pins, ramps, and what an operator asks for.

import { expect, test, vi } from "vitest";
import type { Json } from "../src/protocol";
import { choose, control, dialog, drag, enter, fill, find, number, press, texts } from "./controls";
import { open, type Page } from "./page";

const fields = () => [...document.querySelectorAll<HTMLElement>(".settings > .fields > .field")];
const shown = () => fields().filter((one) => !one.hidden).map((one) => one.dataset["setting"]);

test("five settings of an operator are at first sight, and those that the file says", async () => {
  const page = await open();
  page.model.choose("recipe", ["curl"]);
  expect(shown().length).toBe(5);
  const said = fields().slice(-9).map((one) => one.dataset["setting"]!.split(".")[1]);
  page.hear({ ...page.first("document"), said: { curl: Object.fromEntries(said.map((name): [string, Json] => [name, {}])) } });
  page.model.choose("recipe", ["hairs"]);
  page.model.choose("recipe", ["curl"]);
  expect(shown().length).toBe(5 + 9);
});

test("a search finds settings of all stages and shows the one that is chosen", async () => {
  const page = await open();
  const found = () => texts(".search-results [role=option]");
  const search = find<HTMLInputElement>(".search");
  press("/", {}, page.app.viewer.canvas);
  expect(document.activeElement).toBe(search);
  fill(search, "per_lock");
  expect(found()[0]).toMatch(/^per lock/);
  fill(search, "flat");
  expect(found().some((text) => text.startsWith("flatness"))).toBe(true);
  const stages = new Set(texts(".found-stage"));
  expect(stages.has("curl") && stages.size > 1).toBe(true); // also what is called flat in other stages, or described so
  fill(search, "hairs stray distance");
  press("Enter");
  expect(page.model.chosen.place).toEqual(["hairs"]);
  expect(document.activeElement!.closest<HTMLElement>(".field")!.dataset["setting"]).toMatch(/^hairs\./);
  expect(find(".field.found").hidden).toBe(false);
  expect(find(".search-results").hidden).toBe(true);
  page.app.viewer.canvas.focus();
  press("/");
  fill(search, "nothing is called this");
  expect(find(".search-results").textContent).toContain("No setting");
  expect(shown()).toEqual([]);
  press("Escape");
  expect(shown().length).toBeGreaterThan(4);
});

// What stylists type, and the setting that is found first.
const WORDS: [string, string, string][] = [
  ["tighter", "curl.width", "less"],
  ["parting", "guides.part_line", ""],
  ["parted on the left", "guides.part_line", "more"],
  ["redder", "color.redness", "more"],
  ["more volume", "guides.lift", "more"],
  ["bounce", "motion.bounce", ""],
  ["fringe", "guides.zone", ""],
  ["bangs", "guides.zone", ""],
  ["dense", "hairs.per_lock", "more"],
  ["messy", "hairs.frizz", "more"],
  ["curlier", "curl.width", "less"],
  ["shorter", "guides.length", "less"],
  ["blond", "color.melanin", "less"],
  ["frizz", "hairs.frizz", ""],
];

test.each(["guides", "curl", "hairs"])("words that stylists type find the setting that they mean, in %s", async (stage) => {
  const page = await open("small.shot");
  const search = find<HTMLInputElement>(".search");
  for (const [typed, setting, way] of WORDS) {
    page.model.choose("recipe", [stage]);
    fill(search, typed);
    const about = find(".search-results [role=option] .found-about").textContent!;
    expect(about.includes("drag to the"), `${typed}: ${about}`).toBe(way !== "");
    if (way) expect(about, typed).toContain(way);
    press("Enter", {}, search);
    const focused = document.activeElement!.closest<HTMLElement>(".field")!.dataset["setting"]!;
    expect(focused === setting || focused.startsWith(`${setting}.`), `${typed}: ${focused}`).toBe(true);
  }
});

test("what only a shot has is said to be there", async () => {
  await open();
  fill(find<HTMLInputElement>(".search"), "bounce");
  expect(find(".search-results").textContent).toContain("bounce: in a shot; open one (Ctrl+O)");
});

test("the page begins with the few settings that most meetings need, by their names among stylists", async () => {
  let page = await open();
  expect(find(".settings h2").textContent).toBe("essentials");
  const all = ["guides.length", "curl.width", "curl.pitch", "guides.part_line.offset", "guides.lift", "hairs.per_lock", "hairs.frizz", "color.melanin", "color.redness"];
  expect(shown()).toEqual(all);
  expect(texts(".fields > .field:not([hidden]) > .field-head > label")).toEqual(["length", "size of curls", "tightness of turns", "parting", "volume", "hairs", "frizz", "darkness", "redness"]);
  enter(number("guides.length"), "20");
  expect(page.last("set")).toMatchObject({ changes: [[["guides", "length"], 20]] });
  control("All settings").click();
  expect(shown()).toContain("seed");
  page = await open("small.shot");
  find('[data-stage="recipe"]').click();
  expect(shown()).toEqual([...all, "motion.bounce"]);
});

test("a pinned setting is at first sight of its stage, also when the page is loaded again", async () => {
  (await open()).model.choose("recipe", ["curl"]);
  expect(shown()).not.toContain("curl.flatness");
  control("All settings").click();
  expect(shown()).toContain("curl.flatness");
  control("Pin flatness").click();
  control("Fewer settings").click();
  expect(shown()).toContain("curl.flatness");
  expect(shown()).not.toContain("curl.attract");
  (await open()).model.choose("recipe", ["curl"]);
  expect(shown()).toContain("curl.flatness");
  control("Unpin flatness").click();
  expect(shown()).not.toContain("curl.flatness");
});

/** The ramp of the width of curls, which is opened, with the size that a browser gives it. */
async function openRamp(): Promise<{ page: Page; ramp: SVGElement; dots: () => SVGElement[] }> {
  const page = await open();
  page.model.choose("recipe", ["curl"]);
  page.setting(["curl", "width"], { value: 1, ramp: [[0, 1], [1, 1]] }, { ...(page.model.value("recipe", ["curl", "width"]) as object), ramp: [[0, 1], [1, 1]] });
  const fold = find<HTMLDetailsElement>('[data-setting="curl.width"] details');
  expect(texts("summary", fold)).toEqual(["along the hair"]);
  fold.open = true;
  fold.dispatchEvent(new Event("toggle"));
  const ramp = find<SVGElement>('[data-setting="curl.width.ramp"] svg.ramp');
  vi.spyOn(ramp, "getBoundingClientRect").mockReturnValue(new DOMRect(0, 0, 268, 104));
  return { page, ramp, dots: () => [...ramp.querySelectorAll("circle")] };
}

test("a ramp is edited by its points", async () => {
  const { page, ramp, dots } = await openRamp();
  drag(ramp, [134, 30], [[134, 60], [134, 83]]);
  const { changes, resting } = page.last("set");
  expect(resting).toBe(true);
  const [[place, points]] = changes as [[(string | number)[], [number, number][]]];
  expect(place).toEqual(["curl", "width", "ramp"]);
  expect(points.length).toBe(3);
  expect(Math.abs(points[1][0] - 0.5)).toBeLessThan(0.05);
  expect(points[1][1]).toBeLessThan(0.5);
  dots()[1].focus();
  press("Delete", {}, dots()[1]);
  expect((page.last("set").changes[0][1] as Json[]).length).toBe(2);
});

test("points of a ramp stay in its box, and shapes are offered", async () => {
  const { page, ramp, dots } = await openRamp();
  const heights = () => dots().map((dot) => Number(dot.getAttribute("cy")));
  drag(ramp, [134, 52], [[134, 0], [134, -80]]);
  expect(heights().length).toBe(3);
  expect(Math.min(...heights())).toBeGreaterThanOrEqual(5);
  const points = page.last("set").changes[0][1] as Json;
  page.setting(["curl", "width", "ramp"], points);
  expect(Math.min(...heights())).toBeGreaterThanOrEqual(5);
  expect(Math.max(...heights())).toBeLessThanOrEqual(99);
  expect(texts("text", ramp)[0]).toBe("0");
  choose(control("ramp: shape of the curve"), "decreases to the tip");
  expect(page.last("set")).toMatchObject({ changes: [[["curl", "width", "ramp"], [[0, 1], [1, 0]]]], resting: true });
});

test("an operator asks for the curve that it needs", async () => {
  const page = await open();
  page.hear({ ...page.first("names"), curves: ["wave", "other"] });
  choose(control("Add an operator"), "attract");
  expect(page.said("arrange")).toEqual([]);
  expect(dialog().getAttribute("aria-label")).toBe("Choose a curve for ‘attract’");
  choose(find("select", dialog()), "wave");
  control("Add", dialog()).click();
  expect(page.last("arrange")).toMatchObject({ action: "add", op: "attract", values: { curve: "wave" } });
});
