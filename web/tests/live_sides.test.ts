// Looks that are compared while hair moves live: each by rods of its own, under one handle.

import { expect, test, vi } from "vitest";
import type { Compared, LiveStep, Rods } from "../src/protocol";
import type { Side } from "../src/view/looks";
import { choose, control } from "./controls";
import { open, type Page } from "./page";

const HEAD = [1, 0, 0, 0.01, 0, 1, 0, 0, 0, 0, 1, 0];
const compared = (side: Side, name = "as it was", take = ""): Compared => ({ kind: "compared", side, name, detail: "", settings: {}, take });

/** Straight rods of a side, one for each lock. */
function rodsOf(page: Page, side: Side, key: number): Rods {
  const { ids } = page.app.viewer.hair.a.locks!;
  const count = ids.length;
  return {
    ...{ kind: "rods", side, key, pivot: [0, -1, 0], along: Float32Array.from([0, 1]) },
    ...{ points: Float32Array.from({ length: 6 * count }, (_, i) => (i % 6 === 4 ? -0.05 : 0)), carrier: Uint32Array.from({ length: count }, (_, k) => k) },
    axis: Float32Array.from({ length: 3 * count }, (_, i) => (i % 3 ? 0 : 1)),
    ...{ ids, rise: new Float32Array(count).fill(1) },
  };
}

/** A step in which all has gone to the right with the head, and hair by so much more [m]. */
function step(page: Page, rods: Rods, by: number): void {
  const points = rods.points.map((x, i) => (i % 3 ? x : x + 0.01 + by));
  const message: LiveStep = { kind: "live_step", side: rods.side, key: rods.key, step: 0, head: HEAD, trunk: [0, 0, 0], note: "", points, worn: new Float32Array() };
  page.hear(message);
  vi.advanceTimersByTime(50);
}

const shift = (page: Page, side: Side) => page.app.viewer.hair[side].motions?.[3] ?? null;

/** The small example in live motion, compared with how it was. */
async function both(): Promise<[Page, Rods, Rods]> {
  const page = await open();
  page.hear({ kind: "live", on: true, fps: 24, goes_on: [], wind: "", contact: "" });
  page.hear(compared("a", "now"));
  page.hear(compared("b"));
  for (const kind of ["hairs", "locks"] as const) page.hear({ ...page.first(kind), side: "b" });
  const [a, b] = [rodsOf(page, "a", 1), rodsOf(page, "b", 2)];
  for (const one of [a, b]) page.hear(one);
  step(page, a, 0.001);
  step(page, b, 0.002);
  return [page, a, b];
}

test("each look moves by its own rods, with the head", async () => {
  const [page, a] = await both();
  expect(shift(page, "a")).toBeCloseTo(0.011, 6);
  expect(shift(page, "b")).toBeCloseTo(0.012, 6);
  const skin = page.app.viewer.stage.bodies.get(0)!;
  expect(skin.surface("b").points[0]).toBeCloseTo(page.first("body").points[0] + 0.01, 6);
  step(page, { ...a, side: "b" }, 0.5); // of other rods
  expect(shift(page, "b")).toBeCloseTo(0.012, 6);
  expect(shift(page, "c")).toBe(null);
});

test("a look that comes anew meanwhile is carried on", async () => {
  const [page] = await both();
  page.hear({ ...page.first("locks"), side: "b" });
  expect(shift(page, "b")).toBeCloseTo(0.012, 6);
  const skin = page.app.viewer.stage.bodies.get(0)!;
  expect(skin.surface("b").points[0]).toBeCloseTo(page.first("body").points[0] + 0.01, 6);
});

test.each([
  ["live hair is turned off", (page: Page) => page.hear({ kind: "live", on: false, fps: 0, goes_on: [], wind: "", contact: "" })],
  ["the comparison ends", (page: Page) => page.hear(compared("b", ""))],
])("the other look is at rest when %s", async (_, end) => {
  const [page, , b] = await both();
  end(page);
  expect(shift(page, "b")).toBe(null);
  step(page, b, 0.003);
  expect(shift(page, "b")).toBe(null);
});

test("one handle moves both heads, also side by side", async () => {
  const [page] = await both();
  const place = () => {
    page.app.viewer.onPaint();
    return Number.parseFloat(control("Head").style.translate);
  };
  choose(control("Arrangement of the looks"), "wipe");
  const alone = place();
  choose(control("Arrangement of the looks"), "split");
  expect(place()).toBeLessThan(alone); // over the left one
  choose(control("Arrangement of the looks"), "flip");
  expect(place()).toBeCloseTo(alone, 3);
});
