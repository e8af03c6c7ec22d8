// What is seen before there is hair, and when the picture is lost.

import { expect, test } from "vitest";
import { control, texts } from "./controls";
import { open, Socket } from "./page";

test("the skin that hair is to grow on is framed until hair is there", async () => {
  const page = await open();
  const { viewer } = page.app;
  const target = () => viewer.controls.target.toArray();
  const hair = target();
  viewer.reset();
  page.hear({ kind: "subject", low: [2, 1, -0.1], high: [2.2, 1.1, 0.1] });
  expect(target()[0]).toBeCloseTo(2.1, 1);
  expect(target()[1]).toBeCloseTo(1.03, 1);
  const away = viewer.camera.position.clone().sub(viewer.controls.target).length();
  expect(away).toBeGreaterThan(0.4); // outside of the head
  page.hear(page.first("locks"));
  target().forEach((value, axis) => expect(value).toBeCloseTo(hair[axis]!, 6));
  page.hear({ kind: "subject", low: [2, 1, -0.1], high: [2.2, 1.1, 0.1] }); // another head, which keeps the camera
  target().forEach((value, axis) => expect(value).toBeCloseTo(hair[axis]!, 6));
});

test("all bodies of a scene are seen at once, and those of another scene take their place", async () => {
  const page = await open();
  const { bodies } = page.app.viewer.stage;
  const body = page.first("body");
  const before = bodies.get(0);
  page.hear({ ...body, index: 0, of: 2 });
  expect(bodies.get(0)).toBe(before);
  page.hear({ ...body, index: 1, of: 2 });
  expect(bodies.get(0)).not.toBe(before);
  expect(bodies.size).toBe(2);
  page.hear({ ...body, index: 0, of: 2 }); // a scene that another one overtakes
  page.hear({ ...body, index: 0, of: 1 });
  expect(bodies.size).toBe(1);
});

test("a graphics card that is lost is one line, with what to do", async () => {
  const page = await open();
  page.app.viewer.canvas.dispatchEvent(new Event("webglcontextlost"));
  Socket.latest.close(); // is reported too
  expect(texts(".problems .problem:not([hidden]) p").filter(Boolean)).toEqual([
    "The picture stands still: the browser has lost the graphics card. Load the page again; the groom and all edits stay.",
    "The server does not answer. Your edits are kept here until it is back.",
  ]);
  expect(control("Load the page again")).toBeTruthy();
});
