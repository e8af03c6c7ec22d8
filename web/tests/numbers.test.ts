// Numbers of settings: typed, scrubbed by their labels, dragged by their sliders, and their units.

import { expect, test, vi } from "vitest";
import { control, drag, enter, find, number, press, slide, slider } from "./controls";
import { open } from "./page";

// Typed in a field in cm whose value is 1.0, what the file is to say then; null is refused.
const TYPED: [string, string | number | null][] = [
  ["1.5 mm", "1.5 mm"],
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

test("shorter, tighter and parted on the left takes five clicks and three drags", async () => {
  const page = await open();
  const done = { clicks: 0, drags: 0 };
  const click = (part: HTMLElement) => {
    part.click();
    done.clicks++;
  };
  /** Drags a knob by a part of its slider; returns the value that the page says then. */
  const move = (setting: string, by: number): number => {
    const knob = slider(setting);
    slide(knob, Number(knob.value) + by * (Number(knob.max) - Number(knob.min)));
    done.drags++;
    const [place, value] = page.last("set").changes[0];
    expect(place.join(".")).toBe(setting);
    return value as number;
  };
  click(find('[data-stage="guides"]'));
  const length = Number(slider("guides.length").value);
  expect(move("guides.length", -0.1)).toBeLessThan(length);
  click(control("All settings"));
  click(find('[data-setting="guides.part_line"] > .field-head > .unfold'));
  click(find('[data-setting="guides.part_line"] summary'));
  expect(move("guides.part_line.offset", 0.02)).toBeGreaterThan(0); // the character's left is at +X
  click(find('[data-stage="curl"]'));
  const width = Number(slider("curl.width").value);
  expect(move("curl.width", -0.1)).toBeLessThan(width);
  expect(done).toEqual({ clicks: 5, drags: 3 }); // docs/review_settings.md says so
});
