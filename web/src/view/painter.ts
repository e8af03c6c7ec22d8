// Draws the looks of a stage: light in the hair, drawings on a film, and what is over the picture.

import { type Scene, WebGLRenderer, type WebGLRenderTarget } from "three";
import type { Box, Size } from "./box";
import { Difference } from "./difference";
import { Film } from "./film";
import { type Cell, Looks } from "./looks";
import type { OrbitCamera } from "./orbit_camera";
import type { Portion } from "./pace";
import { Slices, type Work } from "./slices";
import type { Stage } from "./stage";

const THINNEST = 0.9; // least width at which a hair is drawn [pixels]

export class Painter {
  /** null: there is no WebGL 2, and nothing is drawn. */
  readonly renderer: WebGLRenderer | null;
  readonly film: Film;
  readonly looks = new Looks();
  readonly slices = new Slices();
  /** Whether the picture is composed for all of the canvas, as one that is kept: no panels cover it. */
  composed = false;
  /** What panels leave clear of the canvas. */
  left: Box | null = null;
  /** Size of the canvas [pixels of the page]. */
  canvas: Size = { width: 0, height: 0 };
  private readonly finest: number;
  /** Pixels of the film over those of the page. */
  private ratio: number;
  /** The second look while two are subtracted. */
  private readonly second: Film;
  private readonly difference = new Difference();

  /** software: whether there is no graphics card; then pictures are plainer, so that they come at all */
  constructor(
    private readonly stage: Stage,
    context: WebGL2RenderingContext | null,
    software: boolean,
  ) {
    this.finest = this.ratio = Math.min(devicePixelRatio, software ? 1 : 2);
    this.renderer = context && new WebGLRenderer({ canvas: context.canvas, context });
    if (this.renderer) {
      this.renderer.autoClear = false;
      this.renderer.outputColorSpace = "srgb-linear"; // the shaders develop on their own
      this.renderer.setPixelRatio(this.finest);
    }
    this.film = new Film(software ? 0 : 4, software);
    this.second = new Film(software ? 0 : 4, software);
  }

  /** What the camera aims at of the canvas. */
  get clear(): Box {
    return this.composed || !this.left ? { x: 0, y: 0, ...this.canvas } : this.left;
  }

  /** The canvas has another size on the page. */
  resize(size: Size): void {
    this.canvas = size;
    this.renderer?.setSize(size.width, size.height);
  }

  /** Draws at a fraction of the size of the canvas, to which the browser enlarges it. */
  scale(by: number): void {
    this.ratio = by * this.finest;
  }

  /** Draws a picture that is kept: all of a canvas that has as many pixels. */
  keep(size: Size, draw: () => void): void {
    const { renderer, canvas, composed } = this;
    const ratio = renderer?.getPixelRatio() ?? 1;
    renderer?.setPixelRatio(1);
    renderer?.setSize(size.width, size.height, false);
    [this.canvas, this.composed, this.ratio] = [size, true, 1];
    draw();
    this.composed = composed;
    renderer?.setPixelRatio(ratio);
    this.resize(canvas);
  }

  /** Which looks are drawn, and where. */
  private get cells(): Cell[] {
    return this.looks.cells(this.canvas, this.clear);
  }

  /** The fraction of the hairs that is about as wide as a pixel when it stands for all. */
  resolved(view: OrbitCamera): number {
    const hair = this.stage.hair.a;
    const pixel = view.pixel(this.cells[0].clear.height * this.ratio);
    return Math.min(1, Math.max(hair.width / (THINNEST * pixel), 1 / Math.max(hair.count, 1)));
  }

  /** Camera, lamps, and the light in the hair of each side. */
  *prepare(view: OrbitCamera, moving: boolean): Work {
    const { renderer, stage, slices } = this;
    view.camera.updateMatrixWorld();
    stage.lights.update(view.camera, view.portrait(stage.subject()));
    if (!renderer) return;
    for (const { side } of this.cells) {
      const hair = stage.hair[side];
      const surfaces = () => [...stage.bodies.values()].filter((body) => body.solid).map((body) => body.surface(side));
      yield* hair.light(renderer, surfaces, moving, slices);
    }
  }

  /** Adds drawings to the film and develops it. */
  *paint(view: OrbitCamera, { fraction, drawings }: Portion, moving: boolean): Work {
    const { renderer, film, looks, clear, cells, ratio } = this;
    if (!renderer) {
      this.aimAtAll(view);
      return;
    }
    const [width, height] = [this.canvas.width, this.canvas.height].map((length) => Math.floor(ratio * length));
    const pictures = looks.difference ? [cells.slice(0, 1), cells.slice(1)] : [cells];
    if (film.width !== width || film.height !== height) film.drawings = 0;
    const begun = film.drawings;
    for (const [k, some] of pictures.entries()) {
      const one = k ? this.second : film;
      one.drawings = begun;
      if (!begun) one.clear(width, height);
      for (let n = 0; n < drawings; n++) {
        one.open(renderer);
        for (const cell of some) yield* this.expose(renderer, view, one, cell, fraction, moving ? 2 : 1);
        yield* one.expose(renderer, this.slices);
      }
    }
    if (renderer.getPixelRatio() !== ratio) renderer.setPixelRatio(ratio); // empties the canvas
    const seen = { x: ratio * clear.x, y: ratio * clear.y, width: ratio * clear.width, height: ratio * clear.height };
    pictures.forEach((_, k) => {
      (k ? this.second : film).show(renderer, seen, looks.difference ? this.difference.target(k, renderer) : null);
    });
    if (looks.difference) this.difference.draw(renderer);
    else this.drawOverlays(renderer, view, cells);
    this.aimAtAll(view);
  }

  /** Draws a look once: a part of the hairs, another one in each drawing, and the pixels moved by a part of one. */
  private *expose(renderer: WebGLRenderer, view: OrbitCamera, film: Film, cell: Cell, fraction: number, stride: number): Work {
    const { stage, slices, ratio } = this;
    const { camera } = view;
    const number = film.drawings;
    // The sequence R2 of Roberts 2018 over a filter as wide as the path tracer's
    const [x, y] = [0.7548776662, 0.5698402909].map((step) => ((((0.5 + step * number) % 1) - 0.5) * 1.2) / ratio);
    const hair = stage.hair[cell.side];
    const bodies = [...stage.bodies.values()];
    const triangles = bodies.reduce((sum, body) => sum + body.triangles, 0);
    /** Renders into a target, or some rows of it. Others use renderer and camera between slices. */
    const into = (target: WebGLRenderTarget, scenes: Scene[], first = 0, count = target.height) => {
      view.aim(cell, x, y);
      for (const body of bodies) {
        body.seenFrom(camera.position);
        body.turnTo(cell.side);
      }
      hair.seenFrom(camera.position);
      this.restrict(target, cell, first, count);
      renderer.setRenderTarget(target);
      for (const scene of scenes) renderer.render(scene, camera);
      renderer.setRenderTarget(null);
      this.aimAtAll(view);
    };
    yield* slices.draw("bodies", triangles, (first, count) => {
      let before = 0;
      for (const body of bodies) {
        const [from, to] = [first - before, first + count - before].map((at) => Math.min(Math.max(at, 0), body.triangles));
        body.turnTo(cell.side);
        body.restrict(from, to - from);
        before += body.triangles;
      }
      into(film.drawing, [stage.scene]);
      for (const body of bodies) body.restrict();
    });
    if (!hair.table || !stage.hairShown) return;
    yield* hair.update(renderer, fraction, number + 1, slices);
    const { seen } = film;
    if (!seen) {
      yield* hair.draw(fraction, stride, number, slices, () => into(film.drawing, [hair.firstScene, hair.scene]));
      return;
    }
    yield* hair.draw(fraction, stride, number, slices, () => into(seen, [hair.firstScene]));
    hair.seen = seen.texture;
    yield* slices.draw("shading", film.height, (first, count) => into(film.drawing, [hair.scene], first, count));
  }

  /** What is over the picture goes by this camera. */
  aimAtAll(view: OrbitCamera): void {
    view.aim({ canvas: { x: 0, y: 0, ...this.canvas }, clear: this.clear, zoom: 1 });
  }

  /** Restricts a target of the film to the part that a cell fills, and there to some rows. */
  private restrict(target: WebGLRenderTarget, { box, canvas }: Cell, first: number, count: number): void {
    const { height } = this.canvas;
    const scaled = ({ x, y, width, height: rows }: Box) =>
      [x, height - y - rows, width, rows].map((length) => Math.round(this.ratio * length));
    target.viewport.fromArray(scaled(canvas));
    const [left, bottom, width, rows] = scaled(box);
    const from = Math.max(bottom, first);
    target.scissor.set(left, from, width, Math.max(0, Math.min(bottom + rows, first + count) - from));
    target.scissorTest = true;
  }

  private drawOverlays(renderer: WebGLRenderer, view: OrbitCamera, cells: Cell[]): void {
    const { stage } = this;
    const cell = cells.find(({ side }) => side === "a");
    if (!cell || !(stage.guides.shown || stage.painted.shown)) return;
    view.aim(cell);
    this.window(renderer, cell);
    for (const body of stage.bodies.values()) body.turnTo("a");
    renderer.clearDepth();
    renderer.render(stage.casters, view.camera);
    if (stage.painted.shown) renderer.render(stage.painted.scene, view.camera);
    if (stage.guides.shown) renderer.render(stage.guides.scene, view.camera);
    this.wholeWindow(renderer);
  }

  /** Sets the part of the canvas that a cell fills. */
  private window(renderer: WebGLRenderer, { box, canvas }: Cell): void {
    const { height } = this.canvas;
    renderer.setViewport(canvas.x, height - canvas.y - canvas.height, canvas.width, canvas.height);
    renderer.setScissor(box.x, height - box.y - box.height, box.width, box.height);
  }

  private wholeWindow(renderer: WebGLRenderer): void {
    const { width, height } = this.canvas;
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, width, height);
  }
}
