// How much is drawn for a picture. While something moves, it is as much as keeps pictures fluent, without a graphics card
// at a smaller size first. At rest, drawings are added up until all hairs are in them; without a graphics card, they are
// drawn in slices.
//
// A drawing has so many hairs that each is about a pixel wide, others in each drawing. `load` is the number of hairs that
// are drawn for a picture, as a fraction of all.

import type { Slices } from "./slices";

const MOVING = 16; // aim for a picture while something moves [ms]
const SOFTWARE = 60; // the same without a graphics card [ms]
const COARSEST = 0.25; // least scale of a picture while something moves
const FIRST = 0.5; // the first one without a graphics card
const AT_REST = 33; // longest drawing at rest [ms]
const SLICE = 30; // longest slice of one without a graphics card: input waits for the one that is on its way [ms]
const LIGHT = { card: 4, software: 15 }; // of a picture while something moves: what the light in the hair takes [ms]
const FEWEST = { card: 12, software: 5 }; // drawings of a picture at rest, so that its edges are smooth
const MOST = 48;
const LEAST = 1 / MOST; // least load at rest: all hairs are in the picture in the end
const BEGIN = { card: 25_000, software: 1000 }; // hairs of the first picture, at most
const SPARSEST = 250; // hairs of a picture while something moves, at least

/** For a picture that is awaited. */
export const ALL_AT_ONCE = { drawing: Infinity, computing: Infinity };

/** What one picture draws: so many drawings of a fraction of the hairs each. */
export interface Portion {
  drawings: number;
  fraction: number;
}

export class Pace {
  /** Load of a picture while something moves; 0: none was drawn. */
  private load = 0;
  /**
   * Size of a picture while something moves, over that of the canvas. Fewer hairs are wider and cover as much, so that
   * without a graphics card the time goes by the pixels.
   */
  scale: number;
  /** Time that all hairs take, by the last pictures [ms]. */
  private whole = 0;
  /** Fraction of the hairs that is wide enough for the pixels of a drawing. */
  resolved = 1;
  /** Number of all hairs. */
  hairs = 1;

  constructor(private readonly software: boolean) {
    this.scale = software ? FIRST : 1;
  }

  /** What the next picture draws. */
  next(moving: boolean): Portion {
    let load = this.load || Math.min(0.25, (this.software ? BEGIN.software : BEGIN.card) / this.hairs);
    if (!moving) load = this.software || !this.whole ? this.resolved : Math.max(LEAST, AT_REST / this.whole);
    const fraction = Math.min(this.resolved, load, 1);
    return { fraction, drawings: Math.min(this.needed(fraction), Math.max(1, Math.floor(load / fraction))) };
  }

  /** Longest slices of drawing and of computing for the next picture [ms]. */
  slice(moving: boolean): Pick<Slices, "drawing" | "computing"> {
    if (moving) return { drawing: Infinity, computing: this.software ? LIGHT.software : LIGHT.card };
    return this.software ? { drawing: SLICE, computing: SLICE } : ALL_AT_ONCE;
  }

  /** Drawings of a picture at rest. */
  needed(fraction: number): number {
    return Math.min(MOST, Math.max(this.software ? FEWEST.software : FEWEST.card, Math.ceil(1 / fraction)));
  }

  /** A picture is done. */
  took(ms: number, { drawings, fraction }: Portion, moving: boolean): void {
    const load = drawings * fraction;
    this.whole = ms / (load * (moving ? this.scale ** 2 : 1));
    if (!moving) return;
    this.load ||= load;
    const aim = this.software ? SOFTWARE : MOVING;
    const scaled = Math.min(1, Math.max(COARSEST, this.scale * Math.min(1.1, Math.max(0.5, Math.sqrt(aim / ms)))));
    if (this.software && (ms > 1.2 * aim || ms < 0.7 * aim) && scaled !== this.scale) this.scale = scaled;
    else if (ms > 1.2 * aim) this.load = Math.max(Math.min(load, SPARSEST / this.hairs), load * Math.max(0.4, aim / ms));
    else if (ms < 0.7 * aim) this.load = Math.min(MOST * this.resolved, Math.max(this.load, load) * 1.15);
  }
}

/** Time that the graphics card works on what it is given: by its own clock where it has one. */
export class Clock {
  private readonly extension: { TIME_ELAPSED_EXT: number; GPU_DISJOINT_EXT: number } | null;
  private query: WebGLQuery | null = null;
  private began = 0;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    software: boolean,
  ) {
    this.extension = software ? null : gl.getExtension("EXT_disjoint_timer_query_webgl2");
  }

  begin(): void {
    this.began = performance.now();
    if (!this.extension) return;
    this.query = this.gl.createQuery();
    if (this.query) this.gl.beginQuery(this.extension.TIME_ELAPSED_EXT, this.query);
  }

  /** Calls back with the time that it took [ms] when the card is done: to submit takes a fraction of that. */
  end(done: (ms: number) => void): void {
    const { gl, extension, query } = this;
    if (extension && query) gl.endQuery(extension.TIME_ELAPSED_EXT);
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const look = () => {
      if (fence && gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) {
        setTimeout(look, 4);
        return;
      }
      gl.deleteSync(fence);
      done(this.measured());
    };
    setTimeout(look, 0);
  }

  /** By the query of the card, if it is ready and nothing disturbed it; else by the wall clock. */
  private measured(): number {
    const { gl, extension, query } = this;
    const passed = performance.now() - this.began;
    this.query = null;
    if (!extension || !query) return passed;
    const ready = gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE) && !gl.getParameter(extension.GPU_DISJOINT_EXT);
    const own = ready ? (gl.getQueryParameter(query, gl.QUERY_RESULT) as number) / 1e6 : passed;
    gl.deleteQuery(query);
    return own;
  }
}
