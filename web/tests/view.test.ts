// How the groom is looked at: the list of views, light, lens and bookmarks, and what is remembered of them.

import { expect, test, vi } from "vitest";
import { choose, control, find, press } from "./controls";
import { open, type Page } from "./page";

const eye = (page: Page) => page.app.viewer.camera.position.toArray();
const bookmark = (digit: number, shiftKey = false) => press(String(digit), { code: `Digit${digit}`, shiftKey }, document.querySelector("canvas")!);

test("the list of views says when the camera has left them", async () => {
  const page = await open();
  const views = control<HTMLSelectElement>("View from");
  choose(views, "Left");
  const first = page.app.viewer.view.place;
  page.app.viewer.key("ArrowLeft");
  expect(views.selectedOptions[0].textContent).toBe("free view");
  expect(page.app.viewer.view.place).not.toEqual(first);
  choose(views, "Left");
  page.app.viewer.view.place.forEach((value, k) => expect(value).toBeCloseTo(first[k], 9));
});

test("light, camera and bookmarks are remembered", async () => {
  const page = await open();
  const light = control<HTMLSelectElement>("Light");
  choose(light, light.options[1].value);
  page.app.viewer.orbit(0.7, 0.1);
  page.app.viewer.move();
  bookmark(1, true);
  const there = eye(page);
  press("ArrowLeft", {}, page.app.viewer.canvas);
  expect(eye(page)).not.toEqual(there);
  bookmark(1);
  eye(page).forEach((value, k) => expect(value).toBeCloseTo(there[k], 9));
  const again = await open();
  eye(again).forEach((value, k) => expect(value).toBeCloseTo(there[k], 9));
  expect(control<HTMLSelectElement>("Light").selectedIndex).toBe(1);
});

test("light, lens and bookmarks are kept with the recipe, for other browsers", async () => {
  const page = await open();
  const { viewer } = page.app;
  const size = () => viewer.view.focalLength / viewer.camera.position.distanceTo(viewer.controls.target);
  const before = size();
  control("Camera, light and sheet").click();
  const set = (name: string, value: number) => {
    const input = control<HTMLInputElement>(name);
    input.value = String(value);
    for (const event of ["input", "change"]) input.dispatchEvent(new Event(event, { bubbles: true }));
  };
  set("Focal length", 50);
  set("Light rotation", 90);
  expect(size()).toBeCloseTo(before, 9); // of the subject in the picture
  control("Store bookmark 2").click();
  expect(page.last("keep_view")).toMatchObject({ slot: 2, look: { light_turn: 90, focal_length: 50 } });
  vi.advanceTimersByTime(2000);
  expect(page.last("keep_view")).toMatchObject({ slot: 0, look: { light_turn: 90, focal_length: 50 } });
  const kept = page.last("keep_view").look;

  localStorage.clear(); // another browser
  const other = await open("small.recipe", (message) => (message.kind === "views" ? { ...message, views: { 0: kept, 2: kept } } : message));
  expect(other.app.viewer.view.focalLength).toBeCloseTo(50, 1);
  expect(other.app.viewer.stage.lights.turn).toBe(90);
  control("Camera, light and sheet").click();
  expect(control("Recall bookmark 2").hidden).toBe(false);
});

test("a render that starts says for how long", async () => {
  const page = await open();
  page.app.render.start({ width: 100, height: 80 });
  expect(find(".render-state").textContent).toContain("Starting, 0 s");
  vi.advanceTimersByTime(3000);
  expect(find(".render-state").textContent).toContain("Starting, 3 s");
  control("Close", find(".render-bar")).click();
  expect(find(".render").hidden).toBe(true);
});
