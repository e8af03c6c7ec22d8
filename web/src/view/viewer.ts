// The picture: a stage, a camera and a painter. Drawn only when something has changed, so an idle page rests.

import type { BufferGeometry, PerspectiveCamera, Vector3, WebGLRenderer } from "three";
import type { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { h } from "../dom";
import type { Locks, Shared } from "../protocol";
import type { Pose } from "./body";
import { type Box, contains, type Size } from "./box";
import { contextOf, drawsInSoftware, NO_PICTURE, writeNoPicture } from "./context";
import type { Film } from "./film";
import type { Hair } from "./hair";
import type { Looks, Side } from "./looks";
import type { Rods } from "./rods";
import { OrbitCamera } from "./orbit_camera";
import { ALL_AT_ONCE, Clock, Pace, type Portion } from "./pace";
import { Painter } from "./painter";
import { complete, type Work } from "./slices";
import { onScreen } from "./pick";
import { Stage } from "./stage";

const REST_AFTER = 180; // time without a movement after which the picture rests [ms]
const TURN = 0.6; // of the turntable [radians per second]
const FACE = 0.3; // below the skin that hair grows on, as a part of its height
const VIEW: [number, number] = [34, 7]; // azimuth and elevation of the first view [degrees]

/** The camera, and what it is set to: as looks are stored. */
export type CameraState = Pick<Shared, "camera" | "focal_length" | "light_turn">;

export interface DrawStatistics {
  /** Time of the picture [ms], where it was measured. */
  drawMs?: number;
  shown: number;
}

/** A picture that is done, and the number of its hairs. */
interface Drawn {
  portion: Portion;
  shown: number;
}

export class Viewer {
  readonly stage: Stage;
  readonly painter: Painter;
  readonly view: OrbitCamera;
  readonly hair: Record<Side, Hair>;
  readonly guides: Stage["guides"];
  readonly painted: Stage["painted"];
  readonly canvas = h("canvas", { tabIndex: 0, role: "img" });
  readonly renderer: WebGLRenderer | null;
  readonly camera: PerspectiveCamera;
  readonly controls: OrbitControls;
  readonly looks: Looks;
  turntable = false;
  onPaint: () => void = () => {};
  /** The browser has lost the graphics card. */
  onLost: () => void = () => {};
  /** The camera has moved. */
  onLook: () => void = () => {};
  onDraw: (statistics: DrawStatistics) => void = () => {};

  private readonly film: Film;
  private readonly clock: Clock | null;
  private readonly pace: Pace;
  /** Whether the camera has its place: the subject was framed once, or a look was given. */
  private placed = false;
  private wanted = false;
  /** Whether a picture was drawn since the last change. */
  private fresh = false;
  private moved = 0;
  /** Whether the first picture of something is still to come. */
  private awaited = true;
  /** Whether the graphics card is at work: what is next waits for it. */
  private drawing = false;
  /** The rest of a picture that is drawn in slices. */
  private rest: Work<Drawn> | null = null;
  /** Time that its drawing has taken [ms]. */
  private spent = 0;
  /** Drawings that the picture at rest still lacks; what changes begins it again. */
  private lacking = 0;
  private resting = 0;
  private turned = 0;
  private drawn = 0;

  constructor(readonly element: HTMLElement) {
    const { canvas } = this;
    const context = contextOf(canvas);
    const software = !context || drawsInSoftware(context);
    this.pace = new Pace(software);
    const most: number = context?.getParameter(context.MAX_TEXTURE_SIZE) ?? Infinity;
    this.stage = new Stage(() => this.invalidate(), software, most);
    this.hair = this.stage.hair;
    this.guides = this.stage.guides;
    this.painted = this.stage.painted;
    this.painter = new Painter(this.stage, context, software);
    this.renderer = this.painter.renderer;
    this.looks = this.painter.looks;
    this.film = this.painter.film;
    element.append(canvas);
    if (!context) element.append(h("p", { class: "undrawn", role: "status" }, NO_PICTURE));
    canvas.addEventListener("webglcontextlost", () => this.onLost());
    canvas.setAttribute("aria-label", "The groom. Arrow keys orbit the camera, plus and minus zoom, F frames all hair.");
    this.view = new OrbitCamera(canvas);
    this.camera = this.view.camera;
    this.controls = this.view.controls;
    this.controls.addEventListener("change", () => this.move());
    this.clock = context && new Clock(context, software);
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
  }

  /** Removes what belongs to a file that is no longer open. */
  reset(): void {
    this.stage.clear();
    this.looks.order = ["a"];
    this.placed = false;
  }

  setLocks(message: Locks): void {
    this.stage.setLocks(message);
    if (message.draft) this.move();
    if (this.placed || message.side !== "a") return;
    this.frame();
    this.soon();
  }

  /** Moves all bodies on one side, whose points follow one another; nothing: to where they rest. */
  placeBodies(side: Side, points?: Float32Array): void {
    this.stage.placeBodies(side, points);
  }

  /** Rods carry a look, with bodies in a pose of the head; what the hair wears has its own points. */
  carry(rods: Rods, points: Float32Array, pose: Pose, worn: Float32Array, side: Side = "a"): void {
    this.hair[side].carryBy(rods, points, pose.head);
    this.stage.pose(side, pose, worn);
    this.moves();
  }

  /** Puts hair and bodies of a look where they are at rest. */
  putAtRest(side: Side = "a"): void {
    const hair = this.hair[side];
    hair.carryBy(null);
    if (hair.locks && hair.placed !== hair.locks.points) hair.place(hair.locks);
    this.placeBodies(side);
    this.moves();
  }

  /** Shows the hair, or leaves it out so that its guides are seen. */
  showHair(on: boolean): void {
    this.stage.showHair(on);
  }

  /** The bodies as they are seen, to be met by a ray. */
  get surfaces(): BufferGeometry[] {
    return this.stage.surfaces;
  }

  /** The middle of all hair. */
  get middle(): Vector3 {
    return this.stage.middle;
  }

  /** Shows another look too, or no more. */
  compare(side: Side, on: boolean): void {
    if (on) this.looks.add(side);
    else this.looks.remove(side);
    this.invalidate();
  }

  /** Whether several looks are in the picture. */
  get compared(): boolean {
    return this.looks.several;
  }

  setFocalLength(length: number): void {
    this.view.focalLength = length;
    this.onLook();
    this.invalidate();
  }

  /** The camera and the turn of the lights, to be stored. */
  get cameraState(): CameraState {
    const { place, focalLength } = this.view;
    return { camera: place, focal_length: Number(focalLength.toFixed(2)), light_turn: this.stage.lights.turn };
  }

  /** Looks at the skin that hair is to grow on, by its bounds, and at the face below it; until hair is there. */
  frameSkin(low: number[], high: number[]): void {
    if (this.placed) return;
    const down = FACE * (high[1]! - low[1]!);
    const ends = [[low[0], low[1]! - down, low[2]], high] as number[][];
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => [0, 1, 2].map((axis) => ends[(k >> axis) & 1]![axis]!));
    this.view.frame([new Float32Array(corners.flat())], ...VIEW, this.clear);
    this.soon();
  }

  /** Puts the camera before the subject so that all of it is in the picture. */
  frame(azimuth = VIEW[0], elevation = VIEW[1], picture: Size = this.clear): void {
    if (this.hair.a.box.isEmpty()) return;
    this.placed = true;
    this.view.frame(this.stage.subject(), azimuth, elevation, picture);
    this.onLook();
    this.invalidate();
  }

  /** Puts the camera: its place and its target, six numbers, and the focal length of its lens [mm]. */
  lookFrom(place: number[], focalLength = this.view.focalLength): void {
    this.placed = true;
    this.view.lookFrom(place, focalLength);
    this.onLook();
    this.invalidate();
  }

  /** Where a place of the open look, or of the one in its place, is seen [pixels]; null where it is not. */
  seenAt(place: Vector3): { x: number; y: number } | null {
    const { looks, view, painter, camera } = this;
    const cell = looks.cells(this.size, this.clear).find(({ side }) => side === "a" || looks.arrangement === "flip");
    if (!cell) return null;
    view.aim(cell);
    const { x, y } = onScreen(place, camera, cell.canvas);
    painter.aimAtAll(view);
    return { x: cell.canvas.x + x, y: cell.canvas.y + y };
  }

  /**
   * Does something with the open look as it is drawn: the camera is that of its part of the picture. at: a place in the
   * picture [pixels], which is handed on as one of that part; null where another look is there, unless it is held from
   * there on
   */
  onOpenLook<T>(at: { x: number; y: number }, does: (at: { x: number; y: number }, size: Size) => T, held = false): T | null {
    const { looks, view, painter } = this;
    const cell = looks.cells(this.size, this.clear).find(({ side }) => side === "a");
    if (!cell || !(held || contains(cell.box, at))) return null;
    view.aim(cell);
    this.camera.updateMatrixWorld();
    const done = does({ x: at.x - cell.canvas.x, y: at.y - cell.canvas.y }, cell.canvas);
    painter.aimAtAll(view);
    return done;
  }

  /** Does something with the open look alone, after which the camera is where it was. */
  withView(does: () => void): void {
    const { camera, focal_length } = this.cameraState;
    const { framed } = this.view;
    const { order } = this.looks;
    const moved = this.onLook;
    this.onLook = () => {};
    this.looks.order = ["a"];
    does();
    this.looks.order = order;
    this.lookFrom(camera, focal_length);
    this.view.framed = framed;
    this.onLook = moved;
  }

  /** Turns about the subject [radians]. */
  orbit(turn: number, lift: number): void {
    this.view.orbit(turn, lift);
  }

  /** Turns, approaches or frames by a key; whether it was one of these. */
  key(key: string): boolean {
    if (key.toLowerCase() === "f") this.frame();
    else if (!this.view.key(key)) return false;
    else this.move();
    return true;
  }

  /** Keeps the camera where it is when panels open and close. */
  stay(): void {
    this.view.framed = null;
  }

  /** The camera moves: speed counts more than detail for a moment. */
  move(): void {
    this.stay();
    this.onLook();
    this.moves();
  }

  /** Something in the picture moves. */
  private moves(): void {
    this.moved = performance.now();
    this.invalidate();
  }

  /** What is new is seen as soon as it can be, in less detail at first. */
  private soon(): void {
    this.awaited = true;
    this.invalidate();
  }

  /** The picture is another. What it cuts short at rest is first shown as what moves is: at once. */
  invalidate(): void {
    this.fresh = false;
    this.again();
  }

  private again(): void {
    if (this.rest) this.moved = performance.now();
    this.rest = null;
    this.film.drawings = 0;
    this.lacking = 1;
    this.request();
  }

  /** Size of the picture [pixels]. */
  get size(): Size {
    const { clientWidth, clientHeight } = this.element;
    return { width: clientWidth, height: clientHeight };
  }

  /** What panels leave clear of the picture. */
  get clear(): Box {
    return this.painter.clear;
  }

  /** Panels leave another part clear; a subject that was framed is framed again. */
  setClear(box: Box): void {
    this.painter.left = box;
    if (this.view.framed) this.frame(...this.view.framed);
    this.invalidate();
  }

  /** Composes the picture for all of the canvas, or for what panels leave clear. */
  compose(whole: boolean): void {
    this.painter.composed = whole;
    this.move();
  }

  /** Where a pointer is in the picture [pixels]. */
  at(event: MouseEvent): { x: number; y: number } {
    const box = this.element.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  /** Draws the picture at rest at once. */
  drawNow(): void {
    this.painter.scale(1);
    this.drawWhole();
  }

  private drawWhole(): void {
    const { painter, view, pace } = this;
    this.moved = 0;
    this.rest = null;
    Object.assign(painter.slices, ALL_AT_ONCE);
    [pace.resolved, pace.hairs] = [painter.resolved(view), Math.max(this.hair.a.count, 1)];
    complete(painter.prepare(view, false));
    this.film.drawings = 0;
    complete(painter.paint(view, { fraction: pace.resolved, drawings: pace.needed(pace.resolved) }, false));
    this.lacking = 0;
    this.onDraw({ shown: this.hair.a.count });
  }

  /** Draws at a size, for a picture that is kept; then as before. A clear one has no backdrop. */
  drawAt(width: number, height: number, clear: boolean): HTMLCanvasElement {
    const { renderer, painter } = this;
    const kept = h("canvas", { width, height });
    const context = kept.getContext("2d")!;
    painter.keep({ width, height }, () => {
      this.drawWhole();
      if (!renderer) writeNoPicture(context);
      else if (clear) context.putImageData(this.film.transparent(renderer), 0, 0);
      else context.drawImage(renderer.domElement, 0, 0);
    });
    this.invalidate();
    return kept;
  }

  get pictures(): number {
    return this.drawn;
  }

  /** Whether the picture shows the last change. */
  get current(): boolean {
    return this.fresh;
  }

  /** Whether the canvas has the size of its element. */
  get fitted(): boolean {
    const { size, painter } = this;
    return painter.canvas.width === size.width && painter.canvas.height === size.height;
  }

  /** Whether no picture is to come until something changes. */
  get idle(): boolean {
    return !this.wanted && !this.resting && !this.turntable && !this.drawing && !this.lacking;
  }

  private request(): void {
    if (this.wanted) return;
    this.wanted = true;
    if (!this.drawing) requestAnimationFrame(() => this.draw());
  }

  private draw(): void {
    const { painter, view, pace } = this;
    this.wanted = false;
    const now = performance.now();
    if (this.turntable) {
      const passed = this.turned ? Math.min(now - this.turned, 100) : 0;
      this.turned = now;
      view.orbit((passed / 1000) * TURN, 0);
      this.moved = now;
    } else this.turned = 0;
    const moving = this.awaited || now - this.moved < REST_AFTER;
    this.awaited = false;
    if (moving) this.film.drawings = 0;
    painter.scale(moving && !this.turntable && !painter.composed ? pace.scale : 1); // movies have their full size
    [pace.resolved, pace.hairs] = [painter.resolved(view), Math.max(this.hair.a.count, 1)];
    Object.assign(painter.slices, pace.slice(moving));
    this.spent = 0;
    if (moving) {
      clearTimeout(this.resting);
      this.resting = window.setTimeout(() => {
        this.resting = 0;
        this.again();
      }, REST_AFTER + 20);
    }
    this.advance(this.picture(moving), moving, 0);
  }

  private *picture(moving: boolean): Work<Drawn> {
    const { painter, view, pace } = this;
    yield* painter.prepare(view, moving);
    this.spent = 0;
    const portion = pace.next(moving);
    yield* painter.paint(view, portion, moving);
    this.lacking = moving ? 1 : Math.max(0, pace.needed(portion.fraction) - this.film.drawings);
    this.drawn++;
    this.fresh = true;
    this.onPaint();
    return { portion, shown: Math.round(this.hair.a.count * Math.min(1, portion.fraction * this.film.drawings)) };
  }

  /** Goes on with a picture. One of what moves is not cut: the camera is elsewhere in the next. took: the last slice [ms] */
  private advance(picture: Work<Drawn>, moving: boolean, took: number): void {
    const { clock, pace } = this;
    if (!clock) {
      complete(picture);
      this.lacking = 0;
      if (this.turntable) this.invalidate();
      return;
    }
    clock.begin();
    const step = moving ? { done: true as const, value: complete(picture) } : picture.next(took);
    this.rest = step.done ? null : picture;
    this.drawing = true;
    clock.end((ms) => {
      this.drawing = false;
      this.spent += ms;
      if (step.done) {
        pace.took(this.spent, step.value.portion, moving);
        this.onDraw({ drawMs: this.spent, shown: step.value.shown });
      } else if (this.rest === picture) {
        this.advance(picture, moving, ms);
        return;
      }
      if (this.wanted) requestAnimationFrame(() => this.draw());
      else if (this.turntable) this.invalidate();
      else if (!moving && this.lacking) this.request();
    });
  }

  private resize(): void {
    const { painter, view, pace, size } = this;
    if (!size.width || !size.height) return;
    painter.resize(size);
    painter.scale(pace.scale);
    [pace.resolved, pace.hairs] = [painter.resolved(view), Math.max(this.hair.a.count, 1)];
    Object.assign(painter.slices, ALL_AT_ONCE);
    complete(painter.prepare(view, true));
    complete(painter.paint(view, pace.next(true), true)); // before the browser shows the emptied canvas
    this.invalidate();
  }
}
