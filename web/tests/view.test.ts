// What the camera looks at before there is hair.

import { expect, test } from "vitest";
import { open } from "./page";

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
