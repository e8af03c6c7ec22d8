// A hand in live hair: it touches what is under the pointer, and lets go when the pointer is gone.

import { expect, test, vi } from "vitest";
import { Vector3 } from "three";
import type { LiveStep, Rods } from "../src/protocol";
import { onScreen } from "../src/view/pick";
import { control, find } from "./controls";
import { open, type Page } from "./page";

/** The small example in live motion, its hair at rest, with the hand taken up. */
async function withHand(): Promise<Page> {
  const page = await open();
  page.hear({ kind: "live", on: true, fps: 24, goes_on: [], wind: "", contact: "" });
  const { ids } = page.app.viewer.hair.a.locks!;
  const count = ids.length;
  const points = Float32Array.from({ length: 6 * count }, (_, i) => (i % 6 === 4 ? -0.05 : 0)); // straight down
  const rods: Rods = {
    ...{ kind: "rods", side: "a", key: 1, pivot: [0, -1, 0], along: Float32Array.from([0, 1]), points },
    ...{ ids, rise: new Float32Array(count).fill(1), carrier: Uint32Array.from({ length: count }, (_, k) => k), axis: Float32Array.from({ length: 3 * count }, (_, i) => (i % 3 ? 0 : 1)) },
  };
  page.hear(rods);
  const still: LiveStep = { kind: "live_step", side: "a", key: 1, step: 0, head: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0], trunk: [0, 0, 0], note: "", points, worn: new Float32Array() };
  page.hear(still);
  vi.advanceTimersByTime(50);
  page.app.viewer.frame(0, 0);
  page.app.viewer.camera.updateMatrixWorld();
  control("Hand").click();
  return page;
}

const point = (name: string, { x, y }: { x: number; y: number }, more: PointerEventInit = {}) =>
  find(".picture").dispatchEvent(new PointerEvent(name, { clientX: x, clientY: y, button: 0, pointerId: 1, bubbles: true, ...more }));

/** Where the tip of a lock is in the picture, and in the scene. */
function tip(page: Page, lock = 0) {
  const { hair, camera, size } = page.app.viewer;
  const place = new Vector3().fromArray(hair.a.seen!, 3 * (hair.a.locks!.offsets[lock + 1] - 1));
  return { place, ...onScreen(place, camera, size) };
}

test("a pointer pulls the hair under it in the plane of the picture, and lets go", async () => {
  const page = await withHand();
  expect(control("Hand").getAttribute("aria-pressed")).toBe("true");
  const from = tip(page);
  point("pointerdown", from);
  const [first] = page.said("touch_hair");
  expect(first.does).toBe("pull");
  expect(new Vector3(...first.at!).distanceTo(from.place)).toBeLessThan(0.03);
  point("pointermove", { x: from.x + 40, y: from.y });
  vi.advanceTimersByTime(50);
  const there = page.last("touch_hair");
  const way = new Vector3(...there.at!).sub(new Vector3(...first.at!));
  const sideways = new Vector3().setFromMatrixColumn(page.app.viewer.camera.matrixWorld, 0);
  expect(way.dot(sideways)).toBeCloseTo(way.length(), 6);
  point("pointerup", from);
  expect(page.last("touch_hair").does).toBe(null);
});

test("a palm is half in the hair, a comb in it, and a stroke may begin off the hair", async () => {
  const page = await withHand();
  const from = tip(page);
  for (const [tool, deep] of [["comb", 0], ["pat", 0.5]] as const) {
    find<HTMLInputElement>(`[name=live-hand][value=${tool}]`).click();
    point("pointerdown", { x: 2, y: 2 });
    const before = page.said("touch_hair").length;
    point("pointermove", from);
    const touch = page.last("touch_hair");
    expect(page.said("touch_hair").length).toBe(before + 1);
    expect(touch.does).toBe(tool);
    expect(touch.radius).toBeCloseTo(0.04);
    const { camera } = page.app.viewer;
    const towards = camera.position.clone().sub(from.place).normalize();
    if (deep) expect(new Vector3(...touch.at!).sub(from.place).dot(towards)).toBeGreaterThan(0.01);
    point("pointerup", from);
    expect(page.last("touch_hair").does).toBe(null);
    vi.advanceTimersByTime(50);
  }
});

test("a pointer that leaves the picture or is lost, and a hand that is taken away, let go once", async () => {
  const page = await withHand();
  const from = tip(page);
  const ends = [
    () => point("pointermove", { x: -5, y: from.y }),
    () => point("lostpointercapture", from),
    () => void dispatchEvent(new Event("blur")),
    () => page.role({ leads: false }),
  ];
  for (const end of ends) {
    point("pointerdown", from);
    vi.advanceTimersByTime(50);
    expect(page.last("touch_hair").does).toBe("pull");
    const before = page.said("touch_hair").length;
    end();
    point("pointermove", from);
    point("pointerup", from);
    vi.advanceTimersByTime(50);
    expect(page.said("touch_hair").slice(before).map(({ does }) => does)).toEqual([null]);
  }
  expect(control("Hand").getAttribute("aria-pressed")).toBe("false");
});

test("the handle of the head is not in the way of a hand", async () => {
  const page = await withHand();
  const handle = find<HTMLElement>(".head-handle");
  page.app.viewer.onPaint();
  expect(handle.hidden).toBe(true);
  control("Hand").click();
  page.app.viewer.onPaint();
  expect(handle.hidden).toBe(false);
});

test("the hand is put away when hair is at rest again", async () => {
  const page = await withHand();
  page.hear({ kind: "live", on: false, fps: 0, goes_on: [], wind: "", contact: "" });
  const { hand } = page.app.tools;
  expect(hand.button.getAttribute("aria-pressed")).toBe("false");
  hand.button.click();
  expect(hand.on).toBe(false);
});

test("next to another look, the hand touches the open one where it is drawn, and no hair where the other is", async () => {
  const page = await withHand();
  const { viewer } = page.app;
  const alone = tip(page);
  for (const side of ["a", "b"] as const) page.hear({ kind: "compared", side, name: side, detail: "", settings: {}, take: "" });
  expect(viewer.looks.split).toBe(true);
  const seen = viewer.seenAt(alone.place)!;
  expect(Math.hypot(seen.x - alone.x, seen.y - alone.y)).toBeGreaterThan(50);
  point("pointerdown", seen);
  const first = page.last("touch_hair");
  expect(new Vector3(...first.at!).distanceTo(alone.place)).toBeLessThan(0.03);
  point("pointermove", { x: seen.x + 20, y: seen.y });
  vi.advanceTimersByTime(50);
  const there = viewer.seenAt(new Vector3(...page.last("touch_hair").at!))!;
  const from = viewer.seenAt(new Vector3(...first.at!))!;
  expect(there.x - from.x).toBeCloseTo(20, 3);
  point("pointerup", seen);
  const before = page.said("touch_hair").length;
  const { clear } = viewer;
  point("pointerdown", { x: seen.x + clear.width / 2, y: seen.y }); // the same place on the other look
  vi.advanceTimersByTime(50);
  expect(page.said("touch_hair").length).toBe(before);
  point("pointerup", seen);
});
