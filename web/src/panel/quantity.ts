// What is typed into a number field: arithmetic with units. What has two readings is refused, never guessed.

import { METRES } from "./units";

/** Turns per unit of an angle in degrees. */
const DEGREES: Record<string, number> = { "°": 1, deg: 1, rad: 180 / Math.PI };

/** What a number field holds: the unit that it shows, and what it accepts in its place. */
export interface Kind {
  unit: string; // as it is shown; empty for a plain number
  whole: boolean;
  /** A part of a whole: a percentage is a hundredth. */
  part: boolean;
}

/** A number in the unit that is shown; `unit` is the one that the setting is to have, if one was typed alone. */
export interface Typed {
  value: number;
  unit: string;
}

export class Refusal extends Error {}

/**
 * Reads what was typed: `1.5 mm`, `1,5`, `2*(3+1) cm`, of the value that is there `*1.1`, `/2`, `+10%`, and a unit alone, in
 * which the setting is from then on. A unit after a number is that of the number alone.
 */
export function parseQuantity(text: string, kind: Kind, current: number | null): Typed {
  const alone = text.trim();
  if (current !== null && alone in METRES && kind.unit in METRES) return { value: current, unit: alone };
  const reader = new Reader(text, kind);
  const relative = reader.take(/^([*/])/) ?? (/^\s*[-+]\s*[\d.,]+\s*%\s*$/.test(text) ? "%" : null);
  let typed: Term;
  if (relative === null) typed = reader.sum();
  else {
    if (current === null) throw new Refusal(`'${text.trim()}' changes a value, and there is none; type a number`);
    const by = relative === "%" ? { ...plain(1), value: 1 + reader.percentage() } : reader.sum();
    if (by.unit) throw new Refusal(`'${text.trim()}' has a unit; a factor has none`);
    if (relative === "/" && by.value === 0) throw new Refusal("division by 0");
    typed = plain(relative === "/" ? current / by.value : current * by.value);
  }
  reader.end();
  const value = Number(typed.value.toPrecision(10));
  if (!Number.isFinite(value)) throw new Refusal(`'${text.trim()}' is not a number`);
  if (kind.whole && !Number.isInteger(value)) {
    if (relative) return { value: Math.round(value), unit: "" };
    throw new Refusal(`${value} is not a whole number`);
  }
  return { value, unit: "" };
}

/** A number in the unit that is shown, and the unit that was typed; a plain number has none. */
interface Term {
  value: number;
  unit: string;
}

const plain = (value: number): Term => ({ value, unit: "" });

class Reader {
  private at = 0;

  constructor(
    private readonly text: string,
    private readonly kind: Kind,
  ) {}

  take(pattern: RegExp): string | null {
    const rest = this.text.slice(this.at).replace(/^\s+/, "");
    const found = pattern.exec(rest);
    if (!found) return null;
    this.at = this.text.length - rest.length + found[0].length;
    return found[1] ?? found[0];
  }

  end(): void {
    const rest = this.text.slice(this.at).trim();
    if (rest) throw new Refusal(`'${rest}' is not understood`);
  }

  percentage(): number {
    const sign = this.take(/^[-+]/) === "-" ? -1 : 1;
    const value = this.number();
    this.take(/^%/);
    return (sign * value) / 100;
  }

  sum(): Term {
    let total = this.product();
    for (let sign = this.take(/^[-+−]/); sign; sign = this.take(/^[-+−]/)) {
      const term = this.product();
      if (Boolean(term.unit) !== Boolean(total.unit)) throw new Refusal("give every term of a sum a unit, or none");
      total = { value: sign === "+" ? total.value + term.value : total.value - term.value, unit: total.unit };
    }
    return total;
  }

  private product(): Term {
    let total = this.factor();
    for (let sign = this.take(/^[*×/÷](?!cm)/); sign; sign = this.take(/^[*×/÷](?!cm)/)) {
      const term = this.factor();
      const divides = sign === "/" || sign === "÷";
      if (term.unit && (total.unit || divides)) throw new Refusal("only one factor of a product has a unit");
      if (divides && term.value === 0) throw new Refusal("division by 0");
      total = {
        value: divides ? total.value / term.value : total.value * term.value,
        unit: total.unit || term.unit,
      };
    }
    return total;
  }

  private factor(): Term {
    const sign = this.take(/^[-+−]/);
    if (sign) {
      const term = this.factor();
      return sign === "+" ? term : { ...term, value: -term.value };
    }
    if (this.take(/^\(/)) {
      const inner = this.sum();
      if (!this.take(/^\)/)) throw new Refusal("a bracket is not closed");
      return inner.unit ? inner : this.measured(inner.value);
    }
    return this.measured(this.number());
  }

  private number(): number {
    const digits = this.take(/^[\d.,]+(?:[eE][-+]?\d+)?/);
    if (digits === null) {
      const rest = this.text.slice(this.at).trim();
      throw new Refusal(rest ? `'${rest}' is not a number` : "a number is missing");
    }
    return decimal(digits);
  }

  /** A number with the unit that follows it, if one does, in the unit that is shown. */
  private measured(value: number): Term {
    const { unit: shown, part } = this.kind;
    const unit = this.take(/^(%|°|\/cm2|\/cm²|[A-Za-zµ][A-Za-zµ/²³0-9]*)/);
    if (unit === null) return plain(value);
    if (unit === "%" && part) return plain(value / 100);
    const [from, to] = unit in METRES && shown in METRES ? [METRES[unit], METRES[shown]] : [DEGREES[unit], DEGREES[shown]];
    if (from && to) return { value: (value * from) / to, unit };
    if (unit.replace("²", "2") === shown.replace("²", "2")) return { value, unit: shown };
    throw new Refusal(shown ? `'${unit}' is not a unit of this setting; the value is in ${shown}` : `'${unit}': the value has no unit`);
  }
}

/** A decimal number with a point or a comma. A comma before three digits could also separate thousands. */
function decimal(digits: string): number {
  const separators = digits.match(/[.,]/g) ?? [];
  if (separators.length > 1) throw new Refusal(`'${digits}' has ${separators.length} separators; write one, or none`);
  if (/^[1-9]\d{0,2},\d{3}$/.test(digits)) {
    const [a, b] = digits.split(",");
    throw new Refusal(`'${digits}' may be ${a}.${b} or ${a}${b}; write one of them`);
  }
  const value = Number(digits.replace(",", "."));
  if (Number.isNaN(value)) throw new Refusal(`'${digits}' is not a number`);
  return value;
}
