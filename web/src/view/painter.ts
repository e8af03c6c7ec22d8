// Draws the looks of a stage: light in the hair, drawings on a film, and what is over the picture.

import { Vector2, WebGLRenderer } from "three";
import type { Box, Size } from "./box";
import { Difference } from "./difference";
import { Film } from "./film";
import { type Cell, Looks } from "./looks";
import type { OrbitCamera } from "./orbit_camera";
import type { Portion } from "./pace";
import type { Stage } from "./stage";

const THINNEST = 0.9; // least width at which a hair is drawn [pixels]

export class Painter {
  readonly renderer: WebGLRenderer;
  readonly film: Film;
  readonly looks = new Looks();
  /** Whether the picture is composed for all of the canvas, as one that is kept: no panels cover it. */
  composed = false;
  /** What panels leave clear of the canvas. */
  left: Box | null = null;
  private readonly finest: number;
  /** The second look while two are subtracted. */
  private readonly second: Film;
  private readonly difference = new Difference();

  /** software: whether there is no graphics card; then pictures are plainer, so that they come at all */
  constructor(
    private readonly stage: Stage,
    software: boolean,
  ) {
    this.renderer = new WebGLRenderer({ antialias: false, powerPreference: "high-performance" });
    this.renderer.autoClear = false;
    this.renderer.outputColorSpace = "srgb-linear"; // the shaders develop on their own
    this.finest = software ? 1 : Math.min(devicePixelRatio, 2);
    this.renderer.setPixelRatio(this.finest);
    this.film = new Film(software ? 0 : 4);
    this.second = new Film(software ? 0 : 4);
  }

  get canvas(): Size {
    const { x, y } = this.renderer.getSize(new Vector2());
    return { width: x, height: y };
  }

  /** What the camera aims at of the canvas. */
  get clear(): Box {
    return this.composed || !this.left ? { x: 0, y: 0, ...this.canvas } : this.left;
  }

  /** Draws at a fraction of the size of the canvas, to which the browser enlarges it. */
  scale(by: number): void {
    const ratio = by * this.finest;
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
  }

  /** Which looks are drawn, and where. */
  private get cells(): Cell[] {
    return this.looks.cells(this.canvas, this.clear);
  }

  /** The fraction of the hairs that is about as wide as a pixel when it stands for all. */
  resolved(view: OrbitCamera): number {
    const hair = this.stage.hair.a;
    const pixel = view.pixel(this.cells[0].clear.height * this.renderer.getPixelRatio());
    return Math.min(1, Math.max(hair.width / (THINNEST * pixel), 1 / Math.max(hair.count, 1)));
  }

  /** Camera, lamps, and the light in the hair of each side. */
  prepare(view: OrbitCamera, moving: boolean): void {
    const { renderer, stage } = this;
    view.camera.updateMatrixWorld();
    stage.lights.update(view.camera, view.portrait(stage.subject()));
    for (const { side } of this.cells) {
      const hair = stage.hair[side];
      hair.update(renderer);
      hair.light(renderer, () => [...stage.bodies.values()].filter((body) => body.solid).map((body) => body.surface(side)), moving);
    }
  }

  /** Adds drawings to the film and develops it. */
  paint(view: OrbitCamera, { fraction, drawings }: Portion, moving: boolean): void {
    const { renderer, film, looks, clear, cells } = this;
    const buffer = renderer.getDrawingBufferSize(new Vector2());
    const pictures = looks.difference ? [cells.slice(0, 1), cells.slice(1)] : [cells];
    if (film.width !== buffer.x || film.height !== buffer.y) film.drawings = 0;
    const begun = film.drawings;
    const ratio = renderer.getPixelRatio();
    const seen = { x: ratio * clear.x, y: ratio * clear.y, width: ratio * clear.width, height: ratio * clear.height };
    pictures.forEach((some, k) => {
      const one = k ? this.second : film;
      one.drawings = begun;
      if (!begun) one.clear(buffer.x, buffer.y);
      for (let n = 0; n < drawings; n++) {
        one.open(renderer);
        this.expose(view, some, fraction, one.drawings, moving ? 2 : 1);
        one.expose(renderer);
      }
      one.show(renderer, seen, looks.difference ? this.difference.target(k, renderer) : null);
    });
    if (looks.difference) this.difference.draw(renderer);
    else this.drawOverlays(view, cells);
    view.aim({ canvas: { x: 0, y: 0, ...this.canvas }, clear, zoom: 1 }); // what is over the picture goes by this camera
  }

  /** Draws looks once: a part of the hairs, another one in each drawing, and the pixels moved by a part of one. */
  private expose(view: OrbitCamera, cells: Cell[], fraction: number, number: number, stride: number): void {
    const { renderer, stage } = this;
    const { camera } = view;
    // The sequence R2 of Roberts 2018 over a filter as wide as the path tracer's
    const ratio = renderer.getPixelRatio();
    const [x, y] = [0.7548776662, 0.5698402909].map((step) => ((((0.5 + step * number) % 1) - 0.5) * 1.2) / ratio);
    for (const body of stage.bodies.values()) body.seenFrom(camera.position);
    renderer.setScissorTest(cells.length > 1);
    for (const cell of cells) {
      const hair = stage.hair[cell.side];
      view.aim(cell, x, y);
      this.window(cell);
      for (const body of stage.bodies.values()) body.turnTo(cell.side);
      hair.setDetail(fraction, stride, Math.round(number * fraction * hair.count) % Math.max(hair.count, 1));
      hair.seenFrom(camera.position);
      renderer.render(stage.scene, camera);
      if (hair.table && stage.hairShown) {
        renderer.render(hair.firstScene, camera);
        renderer.render(hair.scene, camera);
      }
    }
    this.wholeWindow();
  }

  private drawOverlays(view: OrbitCamera, cells: Cell[]): void {
    const { renderer, stage } = this;
    const cell = cells.find(({ side }) => side === "a");
    if (!cell || !(stage.guides.shown || stage.painted.shown)) return;
    view.aim(cell);
    this.window(cell);
    for (const body of stage.bodies.values()) body.turnTo("a");
    renderer.clearDepth();
    renderer.render(stage.casters, view.camera);
    if (stage.painted.shown) renderer.render(stage.painted.scene, view.camera);
    if (stage.guides.shown) renderer.render(stage.guides.scene, view.camera);
    this.wholeWindow();
  }

  /** Sets the part of the canvas that a cell fills. */
  private window({ box, canvas }: Cell): void {
    const { height } = this.canvas;
    this.renderer.setViewport(canvas.x, height - canvas.y - canvas.height, canvas.width, canvas.height);
    this.renderer.setScissor(box.x, height - box.y - box.height, box.width, box.height);
  }

  private wholeWindow(): void {
    const { width, height } = this.canvas;
    this.renderer.setScissorTest(false);
    this.renderer.setViewport(0, 0, width, height);
  }
}
