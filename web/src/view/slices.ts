// Work in slices, between which the page hears input: what was given to the browser to draw cannot be taken back.
//
// A `Work` stops at each `yield`, after which the time that the slice took is given to it. Who drops it there has
// cancelled it. With a graphics card, a picture is one slice.

export type Work<T = void> = Generator<void, T, number>;

const FIRST = 1 / 512; // of a kind of work: what its first slice has, of all
const MOST = 64; // slices of one kind of work: however busy the machine is, the work comes to its end

export class Slices {
  /** Longest slice of drawing; infinite: all in one [ms]. */
  drawing = Infinity;
  /** Longest slice of computing [ms]. */
  computing = Infinity;
  /** Units that a slice has, by the kind of work. */
  private readonly sizes = new Map<string, number>();

  /** Draws so many units of one kind, some at a time. */
  *draw(kind: string, total: number, some: (first: number, count: number) => void): Work {
    for (let first = 0; first < total; ) {
      const size = this.drawing === Infinity ? total : this.size(kind, total);
      const count = Math.min(size, total - first);
      some(first, count);
      first += count;
      if (this.drawing === Infinity) continue;
      const took = yield;
      if (took > 0 && (count === size || took > this.drawing))
        this.sizes.set(kind, Math.floor(Math.min(2, this.drawing / Math.max(took, 1)) * count));
    }
  }

  /** Units that the next slice has. */
  private size(kind: string, total: number): number {
    const size = this.sizes.get(kind);
    return size === undefined ? Math.ceil(FIRST * total) : Math.max(size, Math.ceil(total / MOST));
  }

  /** Takes small steps, as many at a time as a slice is long. */
  *compute<T>(steps: Iterator<void, T>): Work<T> {
    let began = performance.now();
    for (let step = steps.next(); ; step = steps.next()) {
      if (step.done) return step.value;
      if (performance.now() - began < this.computing) continue;
      yield;
      began = performance.now();
    }
  }
}

/** Does all of a work at once. */
export function complete<T>(work: Work<T>): T {
  let step = work.next(0);
  while (!step.done) step = work.next(0);
  return step.value;
}
