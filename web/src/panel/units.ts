// Lengths as they are shown: in the unit that the file gives them, or in that of the recipe.

import type { Json } from "../protocol";

const METRES: Record<string, number> = { m: 1, dm: 0.1, cm: 0.01, mm: 0.001, in: 0.0254 };

export interface Shown {
  unit: string;
  factor: number; // from SI to what is shown
  write: (shown: number) => Json; // as the file says it
}

/** How a value of a unit is shown; `said` is what the file says now. */
export function shownAs(unit: string, said: Json | undefined, recipeUnit: string): Shown {
  if (unit !== "m") return { unit: unit === "deg" ? "°" : unit, factor: 1, write: (x) => x };
  const own = typeof said === "string" ? (said.match(/[a-z]+\s*$/)?.[0].trim() ?? "") : "";
  if (METRES[own]) return { unit: own, factor: 1 / METRES[own], write: (x) => `${x} ${own}` };
  return { unit: recipeUnit, factor: 1 / (METRES[recipeUnit] ?? 1), write: (x) => x };
}
