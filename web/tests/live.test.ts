// Live hair: its switch, the rods that carry it, and what it leaves when it is off.

import { expect, test, vi } from "vitest";
import { Matrix4 } from "three";
import type { Live, LiveStep, Rods as RodsMessage } from "../src/protocol";
import { easeFrom, seen, shareLeft } from "../src/view/ease";
import { Rods } from "../src/view/rods";
import { choose, control, drag, find, press } from "./controls";
import { open, type Page } from "./page";

const VERTICES = 4;
const TURN = new Matrix4().makeRotationY(0.4).setPosition(0.01, 0.02, 0.03);

const numbers = (count: number) => Array.from({ length: count }, (_, k) => k);

/** Bent rods of locks that are straight, or half as long as their coils' wire. */
function rodsOf(ids: ArrayLike<number>, key = 1, rise = 1): RodsMessage {
  const count = ids.length;
  const points = Array.from({ length: count * VERTICES }, (_, i) => [0.02 * Math.sin(i), 0.1 - 0.02 * (i % VERTICES), 0.01 * Math.floor(i / VERTICES)]);
  return {
    ...{ kind: "rods", side: "a", key, pivot: [0, -1, 0], along: Float32Array.from([0, 0.1, 0.5, 1]) },
    ...{ points: Float32Array.from(points.flat()), carrier: Uint32Array.from({ length: count }, (_, k) => k) },
    axis: Float32Array.from(Array.from({ length: count }, () => [1, 0.3, 0.2]).flat()),
    ...{ ids: Float64Array.from(ids), rise: new Float32Array(count).fill(rise) },
  };
}

/** Points after a motion. */
function moved(points: Float32Array, motion: Matrix4): Float32Array {
  const { elements: m } = motion;
  return points.map((_, i) => {
    const [row, at] = [i % 3, i - (i % 3)];
    return m[row] * points[at] + m[4 + row] * points[at + 1] + m[8 + row] * points[at + 2] + m[12 + row];
  });
}

/** A step in which everything has made a motion with the head. */
function stepOf(rods: RodsMessage, motion: Matrix4, more: Partial<LiveStep> = {}): LiveStep {
  const head = motion.clone().transpose().elements.slice(0, 12);
  return { kind: "live_step", side: "a", key: rods.key, step: 0, head, trunk: [0, 0, 0], note: "", points: moved(rods.points, motion), worn: new Float32Array(), ...more };
}

const lives = (page: Page, on: boolean, fps = 24, more: Partial<Live> = {}) => page.hear({ kind: "live", on, fps, goes_on: [], wind: "", contact: "", ...more });
const headBody = (page: Page) => page.app.viewer.stage.bodies.get(0)!.surface("a");

/** The small example in live motion, its hair one step on. */
async function moving(): Promise<[Page, RodsMessage]> {
  const page = await open();
  lives(page, true);
  const rods = rodsOf(page.app.viewer.hair.a.locks!.ids);
  page.hear(rods);
  page.hear(stepOf(rods, TURN));
  vi.advanceTimersByTime(50);
  return [page, rods];
}

test("the motions of vertices are those of rods that move rigidly", () => {
  const message = rodsOf(numbers(3));
  const motions = new Rods(message).motions(moved(message.points, TURN), TURN);
  const expected = TURN.clone().transpose().elements.slice(0, 12);
  for (let v = 0; v < 3 * VERTICES; v++)
    expected.forEach((value, k) => expect(motions[12 * v + k]).toBeCloseTo(value, 5));
});

test("a rod that is drawn out keeps the wire of its coil as long", () => {
  const rise = 0.5;
  const message = rodsOf([0], 1, rise);
  message.points.set(numbers(VERTICES).flatMap((k) => [0, -0.02 * k, 0]));
  const longer = new Matrix4().makeScale(1, 1.3, 1);
  const motions = new Rods(message).motions(moved(message.points, longer), new Matrix4());
  const across = Math.sqrt((1 - (1.3 * rise) ** 2) / (1 - rise ** 2));
  const expected = [across, 0, 0, 0, 0, 1.3, 0, 0, 0, 0, across, 0];
  for (let v = 0; v < VERTICES; v++) expected.forEach((value, k) => expect(motions[12 * v + k]).toBeCloseTo(value, 5));
  const [radius, axial] = [across * Math.sqrt(1 - rise ** 2), 1.3 * rise];
  expect(Math.hypot(radius, axial)).toBeCloseTo(1, 6);
});

test("the key L asks for live hair, and a line says what it is", async () => {
  const page = await open();
  press("l", {}, page.app.viewer.canvas);
  expect(page.last("go_live")).toEqual({ kind: "go_live", on: true });
  expect(find(".live-line").hidden).toBe(true);
  lives(page, true, 0);
  expect(find(".live-line").textContent).toMatch(/may pass through one another.*is being prepared/);
  expect(control("Live hair").getAttribute("aria-pressed")).toBe("true");
  control("Live hair").click();
  expect(page.last("go_live").on).toBe(false);
  page.role({ leads: false });
  expect(control<HTMLButtonElement>("Live hair").disabled).toBe(true);
});

test("the line says where the stiffness of contact is from", async () => {
  const page = await open();
  lives(page, true, 24, { contact: "default for curls" });
  expect(find(".live-line .contact").textContent).toBe("contact: default for curls");
  lives(page, true, 24, { contact: "calibrated" });
  expect(find(".live-line").textContent).toMatch(/contact: calibrated/);
  lives(page, true);
  expect(find(".live-line .contact").textContent).toBe("");
});

test("hair and head follow a step, and are exactly as they were when it is off", async () => {
  const still = await open();
  const { hair } = still.app.viewer;
  const before = { box: hair.a.box.clone(), points: hair.a.placed!.slice(), head: headBody(still).points.slice() };
  const [page] = await moving();
  const { a } = page.app.viewer.hair;
  expect(a.motions!.length).toBe(12 * VERTICES * (a.locks!.ids.length + 1)); // and those of the head
  const expected = moved(before.head, TURN);
  headBody(page).points.forEach((value, i) => expect(value).toBeCloseTo(expected[i], 5));
  expect(a.box.equals(before.box)).toBe(false);
  lives(page, false, 0);
  expect(a.motions).toBe(null);
  expect(a.placed).toEqual(before.points);
  expect(headBody(page).points).toEqual(before.head);
  expect(a.box.equals(before.box)).toBe(true);
});

test("a step of other rods, or after the end, moves nothing", async () => {
  const [page, rods] = await moving();
  const { a } = page.app.viewer.hair;
  const before = a.motions;
  page.hear(stepOf({ ...rods, key: 7 }, new Matrix4()));
  vi.advanceTimersByTime(50);
  expect(a.motions).toBe(before);
  lives(page, false, 0);
  page.hear(stepOf(rods, TURN));
  vi.advanceTimersByTime(50);
  expect(a.motions).toBe(null);
});

test("a groom that comes meanwhile is carried on", async () => {
  const [page] = await moving();
  const { a } = page.app.viewer.hair;
  page.hear({ ...page.first("locks"), draft: true });
  expect(a.motions).not.toBe(null);
  const expected = moved(page.first("body").points, TURN);
  headBody(page).points.forEach((value, i) => expect(value).toBeCloseTo(expected[i], 5));
});

test("of a groom with another number of locks those that stay move on, and new ones go with the head", async () => {
  const [page, rods] = await moving();
  const lags = TURN.clone().setPosition(0.05, -0.02, 0.01); // the hair, behind its head
  page.hear({ ...stepOf(rods, lags), head: stepOf(rods, TURN).head });
  const locks = page.first("locks");
  const [count, size] = [locks.ids.length - 1, locks.offsets[1]];
  const ids = Float64Array.from([...locks.ids.slice(1, count), 12345]); // two are gone, and the last is new
  const [points, axis] = [locks.points.slice(0, 3 * size * count), locks.axis.slice(0, 3 * count)];
  page.hear({ ...locks, draft: true, ids, points, axis, offsets: locks.offsets.slice(0, count + 1), marked: locks.marked.slice(0, count) });
  vi.advanceTimersByTime(2000); // the picture, and the ease
  const places = page.app.viewer.hair.a.seen!;
  const first = 3 * size * (count - 1); // of the new one
  moved(points, lags).forEach((value, i) => i < first && expect(places[i]).toBeCloseTo(value, 5));
  moved(points, TURN).forEach((value, i) => i >= first && expect(places[i]).toBeCloseTo(value, 5));
});

test("what is cut off and steps that are left out are said", async () => {
  const [page, rods] = await moving();
  for (let k = 0; k < 15; k++) {
    page.hear(stepOf(rods, TURN, { step: 2 * k, note: k === 3 ? "the head was thrown" : "" }));
    vi.advanceTimersByTime(1000 / 12);
  }
  expect(find(".live-line").textContent).toContain("the head was thrown");
  expect(find(".live-line .rate").textContent).toMatch(/1[123] of 24 steps a second/);
});

test("the hair of a shot in a frame is at rest before it moves, and the frame comes back", async () => {
  const page = await open("small.shot");
  const { a } = page.app.viewer.hair;
  const rest = a.placed!;
  const none = { root: new Float32Array(), drawn: new Uint32Array(), left: new Uint8Array(), bodies: new Float32Array() };
  const values = { stretch: new Uint8Array(), contact: new Uint8Array(), depth: new Uint8Array(), curl: new Uint8Array() };
  const timeline = page.model.timeline!;
  page.hear({ ...timeline, state: "done", key: 2, frames: Float64Array.from([1]), runs: new Int32Array(1), stale: new Uint8Array(1), swings: new Float32Array(3) });
  page.hear({ kind: "frame", layer: "shot", frame: 1, statistics: {}, points: rest.map((x) => x + 0.01), axis: a.locks!.axis, ...none, ...values });
  const framed = a.placed;
  expect(framed).not.toEqual(rest);
  lives(page, true, 0);
  expect(a.placed).toEqual(rest);
  lives(page, false, 0);
  expect(a.placed).toEqual(framed);
});

test("buttons play motions and wind; those that go on are pressed on all pages", async () => {
  const [page] = await moving();
  control("Nod").click();
  control("Walk").click();
  choose(control("Wind"), "left");
  expect(page.said("move_head").map(({ motion }) => motion)).toEqual(["nod", "walk"]);
  expect(page.last("blow").side).toBe("left");
  lives(page, true, 24, { goes_on: ["walk"], wind: "back" });
  expect(control("Walk").getAttribute("aria-pressed")).toBe("true");
  expect(control("Nod").getAttribute("aria-pressed")).toBe(null);
  expect(control<HTMLSelectElement>("Wind").value).toBe("back");
  expect(find("[data-motion=clip]").hidden).toBe(true); // no shot is open
  page.role({ leads: false });
  expect(control<HTMLButtonElement>("Hop").disabled).toBe(true);
});

test("the handle turns the head as it is seen, moves it with Shift, and lets go", async () => {
  const [page] = await moving();
  page.app.viewer.frame(0, 0); // from the front
  page.app.viewer.camera.updateMatrixWorld();
  page.app.viewer.onPaint();
  const handle = control("Head");
  expect(handle.style.translate).toMatch(/px/);
  drag(handle, [100, 100], [[200, 100]]);
  vi.advanceTimersByTime(50);
  const [held, free] = page.said("hold_head");
  expect(held.turn![1]).toBeCloseTo(0.8, 2); // to the right of the picture
  expect(Math.abs(held.turn![0])).toBeLessThan(0.05);
  expect(free).toEqual({ kind: "hold_head", turn: null });
  drag(handle, [100, 100], [[100, 50], [100, 0]], { shiftKey: true });
  vi.advanceTimersByTime(50);
  const moved = page.said("hold_head").filter(({ turn }) => turn !== null).at(-1)!;
  expect(moved.turn).toEqual([0, 0, 0]);
  expect(moved.shift![1]).toBeGreaterThan(0.01);
  expect(page.last("hold_head").turn).toBe(null);
  press("ArrowLeft", {}, handle);
  expect(page.last("hold_head").turn).toBe(null); // the key is up again
  expect(page.said("hold_head").at(-2)!.turn![1]).toBeLessThan(-0.3);
});

test("a pointer that is gone, and a page that no longer leads, let go", async () => {
  const [page] = await moving();
  page.app.viewer.onPaint();
  const handle = control("Head");
  const point = (name: string, clientX: number) => handle.dispatchEvent(new PointerEvent(name, { clientX, clientY: 0, button: 0, pointerId: 1, bubbles: true }));
  for (const end of [() => point("lostpointercapture", 0), () => page.role({ leads: false })]) {
    point("pointerdown", 0);
    point("pointermove", 50);
    vi.advanceTimersByTime(50);
    expect(page.last("hold_head").turn).not.toBe(null);
    end();
    expect(page.last("hold_head").turn).toBe(null);
  }
});

/** Locks of three points on their rods, carried by a motion. */
function carried(count: number, motion: Matrix4, wide: number) {
  const message = rodsOf(Array.from({ length: count }, (_, k) => 10 + k));
  const points = Float32Array.from({ length: 9 * count }, (_, i) => wide * Math.sin(1 + i));
  const rods = new Rods(message);
  const locks = { ids: Float64Array.from({ length: count }, (_, k) => 10 + k), offsets: Int32Array.from({ length: count + 1 }, (_, k) => 3 * k) };
  return { locks, points, rods, motions: rods.motions(moved(message.points, motion), motion) };
}

test("hair goes on from where it is seen when groom and rods change, and new locks begin at rest", () => {
  const [before, now] = [carried(2, TURN, 0.1), carried(3, new Matrix4().makeRotationX(-0.3), 0.15)];
  const places = seen(before, null, 0);
  moved(before.points, TURN).forEach((value, i) => expect(places[i]).toBeCloseTo(value, 5));
  const ease = easeFrom(before.locks, places, now);
  const first = seen(now, ease, 1);
  places.forEach((value, i) => expect(first[i]).toBeCloseTo(value, 5));
  expect(ease.slice(18)).toEqual(new Float32Array(9));
  seen(now, ease, 0).forEach((value, i) => expect(value).toBeCloseTo(seen(now, null, 0)[i], 6));
  const halved = { ids: before.locks.ids, offsets: Int32Array.from([0, 2, 4]) }; // of two points: the middle lies between them
  const ends = new Float32Array([...places.slice(0, 3), ...places.slice(6, 9), ...places.slice(9, 12), ...places.slice(15, 18)]);
  const resampled = seen(now, easeFrom(halved, ends, now), 1);
  for (let c = 0; c < 3; c++) expect(resampled[3 + c]).toBeCloseTo(0.5 * (places[c] + places[6 + c]), 5);
  expect([shareLeft(0), shareLeft(1)]).toEqual([1, 0]);
});

test("hair is at rest when another server is found, which does not move it", async () => {
  const [page] = await moving();
  page.hear({ ...page.model.welcome!, session: "another" });
  expect(page.app.viewer.hair.a.motions).toBe(null);
  expect(find(".live-line").hidden).toBe(true);
  press("l", {}, page.app.viewer.canvas);
  expect(page.last("go_live").on).toBe(true);
});

test("the picture of hair that stands is left to get finer", async () => {
  const [page, rods] = await moving();
  vi.advanceTimersByTime(1000);
  const carry = vi.spyOn(page.app.viewer, "carry");
  const step = (motion: Matrix4) => {
    page.hear(stepOf(rods, motion));
    vi.advanceTimersByTime(50);
  };
  step(TURN);
  expect(carry).not.toHaveBeenCalled();
  step(TURN.clone().setPosition(0.02, 0, 0));
  expect(carry).toHaveBeenCalledTimes(1);
});
