// How much detail is drawn: as much as keeps pictures fluent while something moves, and all of it, bit by bit, at rest.

const MOVING = 16; // aim for a picture while something moves [ms]
const SOFTWARE = 60; // the same without a graphics card [ms]
const AT_REST = 33; // a picture that takes longer comes in steps of growing detail [ms]
const LEAST = 0.06; // fraction of the hairs that is drawn in any case
const FEW = 3000; // hairs that are drawn in any case: they are not what takes time
const GROWTH = 3; // of the detail from one step at rest to the next

export class Pace {
  private detail = 1;
  private step = 1;
  /** Time that a picture of all detail takes, by the last ones [ms]. */
  private whole = 0;

  /** Number of hairs of the groom. */
  hairs = Number.POSITIVE_INFINITY;

  constructor(private readonly software: boolean) {}

  private get least(): number {
    return Math.min(1, Math.max(LEAST, FEW / Math.max(this.hairs, 1)));
  }

  /** Detail of the next picture. fresh: whether something has changed since the last one. */
  next(moving: boolean, fresh: boolean): number {
    if (moving) {
      this.step = Math.max(this.detail, this.least);
      return this.step;
    }
    if (this.whole <= AT_REST) this.step = 1;
    else if (fresh) this.step = Math.min(1, Math.max(this.least, AT_REST / this.whole));
    else this.step = Math.min(1, GROWTH * this.step);
    return this.step;
  }

  /** Whether a picture at rest has not all detail yet. */
  get refines(): boolean {
    return this.step < 1;
  }

  /** A picture is done. */
  took(ms: number, detail: number, moving: boolean): void {
    this.whole = ms / detail;
    if (!moving) return;
    const aim = this.software ? SOFTWARE : MOVING;
    if (ms > 1.2 * aim) this.detail = Math.max(this.least, this.detail * Math.max(0.4, aim / ms));
    else if (ms < 0.7 * aim) this.detail = Math.min(1, this.detail * 1.15);
  }
}

/** Calls back when the graphics card has drawn what it was given so far: to submit takes a fraction of that time. */
export function whenDrawn(gl: WebGL2RenderingContext, done: () => void): void {
  const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  const look = () => {
    const state = fence ? gl.clientWaitSync(fence, 0, 0) : gl.CONDITION_SATISFIED;
    if (state === gl.TIMEOUT_EXPIRED) {
      setTimeout(look, 4);
      return;
    }
    gl.deleteSync(fence);
    done();
  };
  setTimeout(look, 0);
}
