// Numbers of settings: typed, scrubbed by their labels, dragged by their sliders, and their units.

import { expect, test, vi } from "vitest";
import { drag, enter, find, number, press, slide, slider } from "./controls";
import { open } from "./page";

// Typed in a field in cm whose value is 1.0, what the file is to say then; null is refused.
const TYPED: [string, string | number | null][] = [
  ["1.5 mm", 0.15],
  ["mm", "10 mm"],
  ["1,5", 1.5],
  ["*1.1", 1.1],
  ["+10%", 1.1],
  ["-50 %", 0.5],
  ["(1 + 2) / 4", 0.75],
  ["1 cm + 2 mm", 1.2],
  ["1,500", null],
  ["1.5.2", null],
  ["2 furlongs", null],
  ["1 + 2 mm", null],
  ["-1", null],
  ["50 cm", null],
  ["", null],
  ["wide", null],
];

test("typed numbers are taken as meant or refused", async () => {
  const page = await open();
  const field = number("curl.width");
  for (const [typed, expected] of TYPED) {
    const before = page.said("set").length;
    enter(field, typed);
    if (expected === null) {
      expect(field.getAttribute("aria-invalid"), typed).toBe("true");
      expect(field.value).toBe(typed);
      expect(page.said("set").length).toBe(before);
      expect(find('[data-setting="curl.width"] .refusal').textContent).not.toBe("");
      press("Escape", {}, field);
    } else {
      const set = page.last("set");
      expect(set, typed).toMatchObject({ file: "recipe", changes: [[["curl", "width"], expected]], resting: true });
      field.blur();
      page.setting(["curl", "width"], 1, 0.01); // undone
    }
    expect(field.getAttribute("aria-invalid")).toBeNull();
    expect(field.value).toBe("1");
  }
});

test("the label of a number scrubs it", async () => {
  const page = await open();
  const label = find('[data-setting="curl.width"] > .field-head > label');
  const moved = [false, true].map((shiftKey) => {
    drag(label, [10, 5], [[30, 5], [50, 5], [70, 5]], { shiftKey });
    const { changes, resting } = page.last("set");
    expect(resting).toBe(true);
    page.setting(["curl", "width"], 1, 0.01); // undone
    return (changes[0][1] as number) - 1;
  });
  expect(moved[0]).toBeCloseTo(10 * moved[1], 9);
  expect(moved[1]).toBeGreaterThan(0);
});

test("a slider that is dragged out and back rests where it began", async () => {
  const page = await open();
  const width = slider("curl.width");
  slide(width, 1.5, 1.2, 1);
  expect(page.said("set").map(({ resting }) => resting)).toEqual([true]);
  width.dispatchEvent(new PointerEvent("pointerdown", { bubbles: true }));
  width.value = "2";
  width.dispatchEvent(new Event("input", { bubbles: true }));
  vi.advanceTimersByTime(20);
  expect(page.last("set")).toMatchObject({ changes: [[["curl", "width"], 2]], resting: false });
  width.value = "1";
  width.dispatchEvent(new Event("input", { bubbles: true }));
  width.dispatchEvent(new PointerEvent("pointerup", { bubbles: true })); // and no `change`
  const { gesture } = page.said("set")[1];
  expect(page.last("set")).toEqual({ kind: "set", file: "recipe", changes: [[["curl", "width"], 1]], gesture, resting: true });
});

test("numbers of a shot have units", async () => {
  const page = await open("small.shot");
  find('[data-stage="shot:strands"]').click();
  expect(find(".settings h2").textContent).toBe("Hair material");
  expect(find('[data-setting="strands.youngs_modulus"] .unit').textContent).toBe("GPa");
  enter(number("strands.youngs_modulus"), "3");
  expect(page.last("set")).toMatchObject({ file: "shot", changes: [[["strands", "youngs_modulus"], 3e9]] });
  expect(page.model.words("curl.width is 0.3 m; must be at most 0.2 m")).toBe("curl.width is 30 cm; must be at most 20 cm");
});

test("shorter, tighter, parted on the left and redder are four drags on the first panel", async () => {
  const page = await open();
  for (const [setting, by] of [["guides.length", -0.1], ["curl.width", -0.1], ["guides.part_line.offset", 0.02], ["color.redness", 0.1]] as const) {
    const knob = slider(setting); // the character's left is at +X
    const before = Number(knob.value);
    slide(knob, before + by * (Number(knob.max) - Number(knob.min)));
    const [place, value] = page.last("set").changes[0];
    expect(place.join(".")).toBe(setting);
    expect(Math.sign((value as number) - before)).toBe(Math.sign(by));
  }
});

test("a slider is dragged from where its value is, ten times finer with Shift, and a click goes to its place", async () => {
  const page = await open();
  const knob = slider("curl.width");
  vi.spyOn(knob, "clientWidth", "get").mockReturnValue(62);
  vi.spyOn(knob, "getBoundingClientRect").mockReturnValue(new DOMRect(10, 0, 62, 18));
  const whole = Number(knob.max) - Number(knob.min);
  const moved = (to: [number, number][], more = {}) => {
    page.setting(["curl", "width"], 1, 0.01);
    drag(knob, [60, 5], to, more);
    const { changes, resting } = page.last("set");
    expect(resting).toBe(true);
    return (changes[0][1] as number) - 1;
  };
  expect(moved([[80, 5], [90, 5]])).toBeCloseTo((30 / 300) * whole, 2); // not a jump to the pointer
  expect(moved([[80, 5], [90, 5]], { shiftKey: true })).toBeCloseTo((3 / 300) * whole, 3);
  expect(moved([[60, 5]])).toBeCloseTo((50 / 62) * whole - 1, 1);
});

test("a number is shown without powers of ten up to a milliard", async () => {
  const page = await open();
  page.setting(["hairs", "per_lock"], 1_000_000);
  expect(number("hairs.per_lock").value).toBe("1000000");
});

test("a unit that is typed alone stays, and one after a number does not", async () => {
  const page = await open();
  const unit = () => find('[data-setting="curl.width"] .unit').textContent;
  enter(number("curl.width"), "mm");
  expect(page.last("set").changes).toEqual([[["curl", "width"], "10 mm"]]);
  page.setting(["curl", "width"], "10 mm", 0.01);
  expect([number("curl.width").value, unit()]).toEqual(["10", "mm"]);
  enter(number("curl.width"), "2 cm");
  expect(page.last("set").changes).toEqual([[["curl", "width"], "20 mm"]]);
  page.setting(["curl", "width"], "20 mm", 0.02);
  enter(number("curl.width"), "cm");
  expect(page.last("set").changes).toEqual([[["curl", "width"], 2]]);
});
