// How much is drawn for a picture, and in which slices.

import { expect, test } from "vitest";
import { Pace } from "../src/view/pace";
import { Slices } from "../src/view/slices";

/** Times of pictures of 100 000 hairs, the first ones left out. perHair, allPixels: what hairs and pixels take [ms] */
function times(software: boolean, perHair: number, allPixels = 0): number[] {
  const [pace, hairs] = [new Pace(software), 100_000];
  Object.assign(pace, { resolved: 0.2, hairs });
  const took = Array.from({ length: 40 }, () => {
    const portion = pace.next(true);
    const time = portion.fraction * portion.drawings * hairs * perHair + pace.scale ** 2 * allPixels;
    pace.took(time, portion, true);
    return time;
  });
  return took.slice(20);
}

test("pictures are fluent while something moves", () => {
  expect(Math.max(...times(false, 0.001))).toBeLessThan(33); // a card that draws 1 000 hairs a millisecond
  expect(Math.max(...times(true, 0.02))).toBeLessThan(100); // a processor, which draws 50
  expect(Math.max(...times(true, 0.001, 800))).toBeLessThan(100); // hairs that cover many pixels, in software
});

test("slices cover the work once, and none is long", () => {
  const slices = Object.assign(new Slices(), new Pace(true).slice(false));
  const parts: [number, number][] = [];
  const took: number[] = [];
  const work = slices.draw("hairs", 100_000, (first, count) => parts.push([first, count]));
  for (let last = 0; !work.next(last).done; took.push(last)) last = 0.02 * parts.at(-1)![1];
  let covered = 0;
  for (const [first, count] of parts) {
    expect(first).toBe(covered);
    covered += count;
  }
  expect(covered).toBe(100_000);
  expect(parts.length).toBeLessThan(200);
  expect(Math.max(...took)).toBeLessThan(60);
});

test("slices of a busy machine come to their end", () => {
  const slices = Object.assign(new Slices(), { drawing: 30 });
  for (const _ of [1, 2]) {
    const drawn: number[] = [];
    const work = slices.draw("rows", 640, (_first, count) => drawn.push(count));
    while (!work.next(500).done); // each takes half a second there, however little it draws
    expect(drawn.reduce((sum, count) => sum + count)).toBe(640);
    expect(drawn.length).toBeLessThanOrEqual(65);
  }
});
