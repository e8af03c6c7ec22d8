// The frames of a shot: playback between two points, what the page keeps of them, and the chart of their swing.

import { expect, test, vi } from "vitest";
import type { Frame, Timeline } from "../src/protocol";
import { choose, control, find, press, texts } from "./controls";
import { open, type Page } from "./page";

/** The server says that there are frames, and gives those that the page asks for. */
function simulated(page: Page, count: number, change: Partial<Timeline> = {}): void {
  const numbers = Array.from({ length: count }, (_, k) => k + 1);
  page.hear({
    ...page.model.timeline!,
    ...{ first: 1, last: count, state: "done", key: 2, frames: Float64Array.from(numbers), runs: new Int32Array(count).fill(1) },
    ...{ stale: new Uint8Array(count), swings: new Float32Array(3 * count).fill(0.1), ...change },
  });
  answer(page);
}

/** The server gives the frames that were asked for, until the page asks for no more. */
function answer(page: Page): void {
  const { points, axis } = page.app.viewer.hair.a.locks!;
  const none = { root: new Float32Array(), drawn: new Uint32Array(), left: new Uint8Array(), bodies: new Float32Array() };
  const values = { stretch: new Uint8Array(), contact: new Uint8Array(), depth: new Uint8Array(), curl: new Uint8Array() };
  const frame = (number: number): Frame => ({ kind: "frame", layer: "shot", frame: number, statistics: {}, points: points.slice(), axis, ...none, ...values });
  for (let given = -1; given !== page.said("watch").length; ) {
    given = page.said("watch").length;
    for (const number of page.last("watch")?.shot ?? []) page.hear(frame(number));
  }
}

test("space plays after a click on a button, and presses one that has the focus by keys", async () => {
  const page = await open("small.shot");
  simulated(page, 4);
  const { timeline } = page.app;
  const button = find<HTMLButtonElement>(".timeline button");
  button.focus();
  expect(press(" ", {}, button)).toBe(false);
  button.dispatchEvent(new MouseEvent("pointerdown", { bubbles: true }));
  const shown = vi.spyOn(timeline, "show");
  expect(press(" ", {}, button)).toBe(true);
  vi.advanceTimersByTime(350);
  expect(shown).toHaveBeenCalled();
});

test("frames are played between in and out points, at a rate", async () => {
  const page = await open("small.shot");
  simulated(page, 4);
  const { timeline, viewer } = page.app;
  for (const [frame, key] of [[2, "i"], [3, "o"]] as const) {
    timeline.show(frame);
    press(key, {}, viewer.canvas);
  }
  expect(document.querySelectorAll(".left-out").length).toBe(2);
  expect(find(".frame-readout").textContent).toContain("plays 2 to 3");
  press("End", {}, viewer.canvas);
  expect(timeline.current).toBe(3);
  const played: (number | null)[] = [];
  const show = timeline.show.bind(timeline);
  vi.spyOn(timeline, "show").mockImplementation((frame) => {
    show(frame);
    played.push(timeline.current);
  });
  choose(control("Playback rate (frames per second)"), "60");
  press(" ", {}, viewer.canvas);
  vi.advanceTimersByTime(350);
  expect(played.length).toBe(Math.floor(350 / (1000 / 60)));
  expect(new Set(played)).toEqual(new Set([2, 3]));
  press(" ", {}, viewer.canvas);
  vi.advanceTimersByTime(350);
  expect(played.length).toBe(Math.floor(350 / (1000 / 60)));
  timeline.show(2);
  press("i", {}, viewer.canvas);
  expect(document.querySelectorAll(".left-out").length).toBe(1);
});

test("the page keeps only frames near the current one", async () => {
  const page = await open("small.shot");
  simulated(page, 300);
  const { timeline } = page.app;
  expect(timeline.count).toBe(300);
  timeline.goTo(100);
  answer(page);
  expect(timeline.settled).toBe(true);
  const asked = page.said("watch").flatMap(({ shot }) => shot ?? []).filter((frame) => frame > 20 && frame < 299);
  expect([...new Set(asked)].sort((a, b) => a - b)).toEqual(Array.from({ length: 16 }, (_, k) => 100 + k));
  control("Play the simulated frames").click();
  for (let step = 0; step < 40; step++) {
    vi.advanceTimersByTime(1000 / 24 + 1);
    answer(page);
  }
  expect(timeline.current!).toBeGreaterThan(130);
  expect(timeline.current!).toBeLessThan(300);
});

test("a cache says that it has no chart of its swing", async () => {
  const page = await open("small.shot");
  simulated(page, 1, { state: "none" });
  control("Chart of the swing, and earlier runs").click();
  expect(find(".swing").textContent).toContain("A cache holds positions, not speeds");
  expect(find(".swing-plot svg").hasAttribute("hidden")).toBe(true);
  simulated(page, 1);
  expect(find(".swing-plot svg").hasAttribute("hidden")).toBe(false);
  expect(texts(".swing-legend")[0]).toContain("tips");
});
