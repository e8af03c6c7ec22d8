// Takes of live hair: kept by a button, played where they are compared, with the timeline where they are of the shot.

import { expect, test, vi } from "vitest";
import { Matrix4 } from "three";
import type { Compared, LiveTake, Snapshot } from "../src/protocol";
import { Take } from "../src/view/take";
import { control, dialog, fill, find, press, slide } from "./controls";
import { open, type Page } from "./page";

const VERTICES = 4;
const STEPS = [0, 1, 2, 4, 5]; // one was left out
const UNIT = 1e-4;
const FPS = 24;

/** A head that goes to the right by a centimetre a step, and hair that lags by a millimetre a step. */
function takeOf(ids: Float64Array, more: Partial<LiveTake> = {}): LiveTake {
  const count = ids.length;
  const points = Array.from({ length: count * VERTICES }, (_, i) => [0.02 * Math.sin(i), 0.1 - 0.02 * (i % VERTICES), 0.01 * Math.floor(i / VERTICES)]).flat();
  const heads = STEPS.flatMap((step) => [1, 0, 0, 0.01 * step, 0, 1, 0, 0, 0, 0, 1, 0]);
  const moved = STEPS.flatMap((step) => points.map((_, i) => (i % 3 ? 0 : -10 * step)));
  return {
    ...{ kind: "live_take", side: "b", id: "one", fps: FPS, first: null, pivot: [0, -1, 0], unit: UNIT },
    ...{ points: Float32Array.from(points), along: Float32Array.from([0, 0.1, 0.5, 1]), carrier: Uint32Array.from({ length: count }, (_, k) => k) },
    ...{ ids, rise: new Float32Array(count).fill(1) },
    ...{ axis: Float32Array.from(Array.from({ length: count }, () => [1, 0.3, 0.2]).flat()), steps: Int32Array.from(STEPS) },
    ...{ heads: Float32Array.from(heads), trunks: new Float32Array(3 * STEPS.length), moved: Int16Array.from(moved), worn: new Int16Array() },
    ...more,
  };
}

const compared = (take: string, name = "a nod"): Compared => ({ kind: "compared", side: "b", name, detail: "", settings: {}, take });

/** The small example, compared with a take. */
async function playing(more: Partial<LiveTake> = {}, file: "small.recipe" | "small.shot" = "small.recipe"): Promise<[Page, LiveTake]> {
  const page = await open(file);
  const { hair } = page.app.viewer;
  page.hear({ ...compared(""), side: "a", name: "now" });
  page.hear(compared("one"));
  for (const kind of ["hairs", "locks"] as const) page.hear({ ...page.first(kind), side: "b" });
  const take = takeOf(hair.a.locks!.ids, more);
  page.hear(take);
  return [page, take];
}

/** How far the first vertex has moved on side b [m]. */
const shift = (page: Page) => page.app.viewer.hair.b.motions?.[3] ?? null;
const snapshot = (page: Page, seconds: number): Snapshot => ({ id: "one", author: "", note: "", time: "2026-01-01T10:00:00", look: page.app.look.state, seconds });

test("a step of a take is where it was seen, and a step that was left out is the one before", () => {
  const take = new Take(takeOf(new Float64Array(2)));
  expect(take.length).toBe(6);
  const { points, pose } = take.at(2);
  expect(pose.head).toEqual(new Matrix4().setPosition(Math.fround(0.02), 0, 0));
  expect(points[0]).toBeCloseTo(take.message.points[0] + 0.02 - 2 * 10 * UNIT, 6);
  expect(take.at(3)).toEqual(take.at(2));
});

test("the last seconds are kept by the key K while hair moves live, with a picture", async () => {
  const page = await open();
  vi.spyOn(HTMLCanvasElement.prototype, "toDataURL").mockReturnValue("data:image/png;base64,AAAA");
  vi.spyOn(page.app.viewer, "drawAt").mockReturnValue(document.createElement("canvas"));
  press("k", {}, page.app.viewer.canvas);
  expect(page.said("keep_take")).toEqual([]);
  page.hear({ kind: "live", on: true, fps: 24, goes_on: [], wind: "", contact: "" });
  press("k", {}, page.app.viewer.canvas);
  expect(page.last("keep_take")).toMatchObject({ picture: "AAAA", look: page.app.look.state });
  control("Keep take").click();
  expect(page.said("keep_take").length).toBe(2);
});

test("a card says how long its take is, and plays it alone", async () => {
  const page = await open();
  page.hear({ kind: "snapshots", snapshots: [snapshot(page, 4.96)] });
  press("t", {}, page.app.viewer.canvas);
  expect(find(".card .seconds").textContent).toBe("5.0 s");
  control("Play the take").click();
  expect(page.last("compare")).toEqual({ kind: "compare", to: "snapshot", name: "one", side: "b" });
  page.hear(compared("one"));
  expect(page.app.viewer.looks.arranged).toMatchObject({ arrangement: "flip", front: "b" });
  page.hear(compared("", ""));
  expect(page.app.viewer.looks.arrangement).toBe("split"); // as before
});

test("a take plays in a loop, stands, and goes on; a comparison that ends puts it at rest", async () => {
  const [page] = await playing();
  const player = find(".take-player");
  expect(player.hidden).toBe(false);
  const seen = new Set<number>();
  for (let k = 0; k < 40; k++) {
    vi.advanceTimersByTime(20);
    seen.add(Math.round(1000 * shift(page)!));
  }
  expect([...seen].sort((a, b) => a - b)).toEqual([0, 9, 18, 36, 45]); // [mm]
  slide(control<HTMLInputElement>("Step of the take"), 2);
  vi.advanceTimersByTime(400);
  expect(shift(page)).toBeCloseTo(0.018, 5);
  expect(page.app.look.state.step).toBe(2);
  press(" ", {}, page.app.viewer.canvas);
  expect(page.app.look.state.step).toBe(null);
  vi.advanceTimersByTime(100);
  expect(shift(page)).not.toBeCloseTo(0.018, 5);
  page.hear(compared("", ""));
  expect(shift(page)).toBe(null);
  expect(player.hidden).toBe(true);
});

test("a follower sees the step at which the leader stands", async () => {
  const [page] = await playing();
  const people = [true, false].map((leads) => ({ name: "", hue: 1, leads, follows: true, you: !leads }));
  page.role({ leads: false, people });
  page.hear({ ...page.app.look.state, kind: "followed", step: 4 });
  vi.advanceTimersByTime(300);
  expect(shift(page)).toBeCloseTo(0.036, 5);
  expect(page.said("introduce").every(({ follows }) => follows)).toBe(true);
});

test("the take of the shot that was made of it goes with its frames", async () => {
  const [page] = await playing({ first: 1 }, "small.shot");
  const timeline = page.model.timeline!;
  const frames = Float64Array.from([1, 2, 3, 4]);
  page.hear({ ...timeline, state: "done", key: 2, frames, runs: new Int32Array(4), stale: new Uint8Array(4), swings: new Float32Array(12) });
  page.app.timeline.goTo(3);
  expect(shift(page)).toBeCloseTo(0.018, 5);
  vi.advanceTimersByTime(300);
  expect(shift(page)).toBeCloseTo(0.018, 5);
  expect(find(".take-player").hidden).toBe(true);
});

test("a shot is made of a take under a name, and compared with it by a wipe", async () => {
  const page = await open();
  page.hear({ kind: "snapshots", snapshots: [snapshot(page, 4)] });
  press("t", {}, page.app.viewer.canvas);
  control("Make a shot of the take").click();
  fill(control<HTMLInputElement>("Name of the shot", dialog()), " nod_2 ");
  control("Make the shot", dialog()).click();
  expect(page.last("make_shot")).toEqual({ kind: "make_shot", id: "one", name: "nod_2" });
  page.hear(compared("one"));
  expect(page.app.viewer.looks.arrangement).toBe("wipe");
  page.hear(compared("", ""));
  expect(page.app.viewer.looks.arrangement).toBe("split");
});
