// The part of all allowed values that a slider offers, and how fine it moves.

import type { Setting } from "./schema";

export interface Range {
  least: number;
  most: number;
  step: number;
}

/** Within the bounds, and wide enough for what is usual: a few times the value or the default. In units as shown. */
export function sliderRange(setting: Setting, value: number, fallback: number, factor: number): Range {
  const [least, most] = [setting.least * factor, setting.most * factor];
  const whole = setting.kind === "integer";
  const usual = 3 * Math.max(Math.abs(value), Math.abs(fallback));
  const narrow = Number.isFinite(least) && Number.isFinite(most) && (setting.unit === "deg" || most - least <= 1);
  const top = narrow ? most : Math.min(most, nice(usual || (Number.isFinite(most) ? Math.min(most, 1) : 1)));
  const bottom = narrow || least >= 0 ? Math.max(least, Number.NEGATIVE_INFINITY) : Math.max(least, -top);
  const from = Number.isFinite(bottom) ? bottom : -top;
  const step = whole ? 1 : 10 ** Math.floor(Math.log10((top - from) / 200 + 1e-12));
  return { least: from, most: Math.max(top, from + step), step };
}

/** The next 1, 1.5, 2, 3, 5 or 7 times a power of ten. */
function nice(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  return power * ([1, 1.5, 2, 3, 5, 7, 10].find((k) => k * power >= x * 0.999) ?? 10);
}

/** A number with as many digits as a slider's step needs. */
export function rounded(x: number, step: number): number {
  const digits = Math.max(0, Math.ceil(-Math.log10(step)));
  return Number(x.toFixed(Math.min(digits, 8)));
}
