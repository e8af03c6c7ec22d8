// Units as they are shown: lengths in the unit that the file gives them, or in that of the recipe; SI numbers scaled.

import type { Json } from "../protocol";

export const METRES: Record<string, number> = { m: 1, dm: 0.1, cm: 0.01, mm: 0.001, µm: 1e-6, in: 0.0254 };

/** Units that a file gives a length in. */
const IN_FILES = ["m", "dm", "cm", "mm", "in"];

/** SI units of a shot whose usual values are far from 1, and the units that they are shown in. */
const SCALED: Record<string, [string, number]> = { m: ["mm", 1e3], Pa: ["GPa", 1e-9] };

export interface Shown {
  unit: string;
  factor: number; // from SI to what is shown
  /** As the file says a number that is shown; `to`: the unit that it is to have in the file. */
  write: (shown: number, to?: string) => Json;
}

/** How a value of a unit is shown. said: what the file says now; si: whether the file's plain numbers are in SI. */
export function shownAs(unit: string, said: Json | undefined, recipeUnit: string, si = false): Shown {
  if (si) {
    const [scaled, factor] = SCALED[unit] ?? [unit, 1];
    return { unit: scaled, factor, write: (x) => tidy(x / factor) };
  }
  if (unit !== "m") return { unit: unit === "deg" ? "°" : unit, factor: 1, write: (x) => x };
  const own = typeof said === "string" ? (said.match(/[a-z]+\s*$/)?.[0].trim() ?? "") : "";
  const shown = IN_FILES.includes(own) ? own : recipeUnit;
  const factor = 1 / (METRES[shown] ?? 1);
  const write = (x: number, to = "") => {
    const unit = IN_FILES.includes(to) ? to : shown;
    const given = unit === shown ? x : tidy(x / factor / METRES[unit]);
    return unit === recipeUnit && unit !== own ? given : `${given} ${unit}`;
  };
  return { unit: shown, factor, write };
}

/** A message whose lengths in metres are in another unit. */
export function inUnit(message: string, unit: string): string {
  const metres = METRES[unit];
  if (!metres || unit === "m") return message;
  return message.replace(
    /(-?\d+(?:\.\d+)?(?:e[-+]?\d+)?) m(?![\w/²³^])/g,
    (_, number: string) => `${tidy(Number(number) / metres)} ${unit}`,
  );
}

/** A number without the digits that a change of units adds. */
function tidy(x: number): number {
  return Number(x.toPrecision(10));
}
