// Locks: chosen by keys and a lasso, isolated, dragged by their handles, and given values of their own.

import { Vector3 } from "three";
import { expect, test } from "vitest";
import { check, control, drag, find, press, slide, slider, texts } from "./controls";
import { open, type Page } from "./page";

const ids = (page: Page) => [...page.app.viewer.hair.a.locks!.ids];

/** The server says the locks again, some of them isolated. */
function isolate(page: Page, ...rows: number[]): void {
  const locks = page.first("locks");
  for (const row of rows) locks.marked[row] = 1;
  page.hear(locks);
}

test("locks are chosen by a lasso and by keys, and the edited ones are listed", async () => {
  const page = await open();
  const { viewer, lock } = page.app;
  press("n");
  expect(lock.ids).toEqual([ids(page)[0]]);
  const around: [number, number][] = [[500, 60], [750, 320], [500, 610], [250, 320], [500, 64]];
  drag(viewer.element, around[0], around.slice(1), { shiftKey: true });
  const chosen = lock.ids;
  expect(chosen.length).toBeGreaterThan(1);
  expect(chosen.length).toBeLessThan(ids(page).length); // not those behind the head
  control("Isolate").click();
  expect(page.last("isolate")).toEqual({ kind: "isolate", locks: chosen });
  isolate(page, ...chosen.map((id) => ids(page).indexOf(id)));
  const edit = chosen.map((id) => ({ lock: id }));
  page.setting(["edit"], edit);
  expect(texts('[aria-label="Edited locks"] button').length).toBe(chosen.length);
});

test("an isolated lock is dragged by its handles, and returned", async () => {
  const page = await open();
  const { lock } = page.app;
  lock.choose(2);
  control("Isolate").click();
  expect(page.last("isolate")).toEqual({ kind: "isolate", locks: [ids(page)[2]] });
  isolate(page, 2);
  lock.place();
  const dots = [...document.querySelectorAll<SVGElement>(".handles circle")].filter((dot) => dot.style.display !== "none");
  expect(dots.length).toBe(5);
  const [x, y] = ["cx", "cy"].map((name) => Number(dots[4].getAttribute(name)));
  drag(dots[4], [x, y], [[x + 20, y - 15], [x + 40, y - 30]]);
  const last = page.last("drag");
  const tip = page.app.viewer.hair.a.locks!.points.slice(3 * (3 * 40 - 1), 3 * 3 * 40);
  expect(last).toMatchObject({ lock: ids(page)[2], point: 39, resting: true, falloff: 0.3 });
  const moved = Math.hypot(...last.to.map((value, axis) => value - tip[axis]));
  expect(moved).toBeGreaterThan(0.005);
  expect(moved).toBeLessThan(0.1);
  control("Reset lock").click();
  expect(page.last("isolate")).toEqual({ kind: "isolate", locks: [ids(page)[2]], out: false });
});

test("a value is set for one lock, and reverted", async () => {
  const page = await open();
  page.app.lock.choose(2);
  const id = String(ids(page)[2]);
  check(control("values of this lock alone"));
  slide(slider("curl.width"), 1.5, 2);
  expect(page.last("set").changes).toEqual([[["curl", "width", "lock", id], 2]]);
  page.setting(["curl", "width"], { value: 1, lock: { [id]: 2 } }, { value: 0.01, lock: { [id]: 0.02 } });
  control("Remove its own curl width").click();
  expect(page.last("set").changes).toEqual([[["curl", "width", "lock", id], null]]);
});

test("a value of several locks is set and reverted in one step", async () => {
  const page = await open();
  page.app.lock.choose(2, 5);
  const [a, b] = [2, 5].map((row) => String(ids(page)[row]));
  check(control("values of these locks alone"));
  slide(slider("curl.width"), 1.5, 2);
  expect(page.last("set").changes).toEqual([[["curl", "width", "lock", a], 2], [["curl", "width", "lock", b], 2]]);
  page.setting(["curl", "pitch"], { value: 1.5, lock: { [a]: 2 } }, { value: 0.015, lock: { [a]: 0.02 } });
  page.setting(["curl", "width"], { value: 1, lock: { [a]: 2, [b]: 2 } }, { value: 0.01, lock: { [a]: 0.02, [b]: 0.02 } });
  const listed = texts("li", find(".lock .own"));
  expect(listed.some((one) => one.includes("curl pitch") && one.includes("of 1 of 2"))).toBe(true);
  expect(listed.some((one) => one.includes("curl width") && !one.includes(" of "))).toBe(true);
  control("Remove its own curl width").click();
  const { changes, gesture } = page.last("set");
  expect(changes).toEqual([[["curl", "width", "lock", a], null], [["curl", "width", "lock", b], null]]);
  expect(page.said("set").filter((one) => one.gesture === gesture).length).toBe(1); // one step of undo
});

test("next to another look, a click chooses a lock of the open one where it is drawn", async () => {
  const page = await open();
  const { viewer, lock } = page.app;
  for (const side of ["a", "b"] as const) page.hear({ kind: "compared", side, name: side, detail: "", settings: {}, take: "" });
  expect(viewer.looks.split).toBe(true);
  const { points, offsets } = viewer.hair.a.locks!;
  const highest = Array.from({ length: offsets.length - 1 }, (_, k) => k).sort((a, b) => points[3 * offsets[b + 1] - 2] - points[3 * offsets[a + 1] - 2])[0];
  const seen = viewer.seenAt(new Vector3().fromArray(points, 3 * (offsets[highest + 1] - 1)))!;
  const click = (x: number) => {
    for (const name of ["pointerdown", "pointerup", "click"]) viewer.canvas.dispatchEvent(new PointerEvent(name, { clientX: x, clientY: seen.y, bubbles: true }));
  };
  click(seen.x + viewer.clear.width / 2); // the same place on the other look
  expect(lock.ids).toEqual([]);
  click(seen.x);
  expect(lock.ids).toEqual([ids(page)[highest]]);
});
