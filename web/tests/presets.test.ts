// Looks and presets: shown while the pointer rests on them, taken by a click, mixed by a slider, and kept.

import { expect, test, vi } from "vitest";
import type { Preset } from "../src/protocol";
import { control, dialog, fill, find, slide, texts } from "./controls";
import { open } from "./page";

const preset = (name: string, title: string, whole: boolean): Preset => ({ name, title, about: title, whole, picture: whole ? "data:image/jpeg;base64,AAAA" : "" });

test("a preset is shown while the pointer rests on it, and taken by a click", async () => {
  const page = await open();
  page.hear({ kind: "presets", presets: [preset("wide.preset.toml", "Wide curls", false), preset("looks/bob", "Bob", true)] });
  control("Looks and presets").click();
  expect(texts(".presets h3").length).toBe(2);
  expect(document.querySelectorAll('[data-preset="looks/bob"] img').length).toBe(1);
  const card = find('[data-preset="wide.preset.toml"]');
  card.dispatchEvent(new PointerEvent("pointerenter", { pointerType: "mouse" }));
  expect(page.said("try")).toEqual([]);
  vi.advanceTimersByTime(1000);
  expect(page.said("try")).toEqual([{ kind: "try", name: "wide.preset.toml" }]);
  card.dispatchEvent(new PointerEvent("pointerleave"));
  vi.advanceTimersByTime(1000);
  expect(page.last("try")).toEqual({ kind: "try", name: "" });
  expect(page.said("take")).toEqual([]);
  card.click();
  expect(page.last("take")).toMatchObject({ name: "wide.preset.toml", part: 1, resting: true });
  slide(find("#preset-part"), 0.7, 0.5);
  const { gesture } = page.said("take")[0];
  expect(page.last("take")).toEqual({ kind: "take", name: "wide.preset.toml", part: 0.5, gesture, resting: true }); // one step of undo
  vi.spyOn(page.app.viewer, "drawAt").mockReturnValue(document.createElement("canvas"));
  vi.spyOn(HTMLCanvasElement.prototype, "toDataURL").mockReturnValue("data:image/jpeg;base64,BBBB");
  page.model.choose("recipe", ["curl"]);
  control("Keep a preset").click();
  fill(find("#preset-name"), "mine");
  find<HTMLFormElement>("form", dialog()).requestSubmit();
  expect(page.last("keep")).toEqual({ kind: "keep", name: "mine", tables: ["curl"], picture: "data:image/jpeg;base64,BBBB" });
});
