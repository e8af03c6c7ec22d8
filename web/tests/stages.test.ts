// The stages of a groom: chosen, added, muted, moved and removed.

import { expect, test } from "vitest";
import { choose, control, find, texts } from "./controls";
import { open } from "./page";

test("operators are added, muted, moved and removed", async () => {
  const page = await open();
  const { stages } = page.model.documents.recipe!;
  choose(control("Add an operator"), "scraggle");
  expect(page.last("arrange")).toEqual({ kind: "arrange", action: "add", at: 0, op: "scraggle", values: {} });
  const shape = (op: string, at: number, muted = false) => ({ name: op, op, place: ["shape", at], muted, solo: false });
  const others = stages.filter(({ place }) => place[0] !== "shape");
  page.document({ stages: [...others, shape("scraggle", 0), shape("volume", 1)] });
  expect(texts(".stage-name").slice(-2)).toEqual(["scraggle", "volume"]);
  control("Move volume up").click();
  expect(page.last("arrange")).toEqual({ kind: "arrange", action: "move", at: 1, to: 0 });
  expect(page.model.chosen.place).toEqual(["shape", 0]);
  control("Mute scraggle").click();
  expect(page.last("mute")).toEqual({ kind: "mute", stages: ["shape/0"], solo: "" });
  page.document({ stages: [...others, shape("volume", 0), shape("scraggle", 1, true)] });
  expect(control("Mute scraggle").getAttribute("aria-pressed")).toBe("true");
  expect(find('[data-stage="shape/1"]').closest(".stage")!.classList).toContain("muted");
  control("Remove volume").click();
  expect(page.last("arrange")).toEqual({ kind: "arrange", action: "remove", at: 0 });
});
