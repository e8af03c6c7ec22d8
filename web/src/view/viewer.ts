// The picture: bodies and hair before a wall. Drawn only when something has changed, so an idle page rests.

import { type BufferGeometry, PerspectiveCamera, Scene, Vector2, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Body as BodyMessage, Colors, Hairs, Locks, Rig, Shared } from "../protocol";
import { Body } from "./body";
import type { Box, Size } from "./box";
import { Difference } from "./difference";
import { GuideLines } from "./guides";
import { type Colour, Hair } from "./hair";
import { Film } from "./film";
import { fieldOfView, FOCAL_LENGTH, type Portrait, portrait, SENSOR } from "./framing";
import { Lights } from "./lights";
import { type Cell, Looks, type Side } from "./looks";
import { Clock, Pace, type Portion } from "./pace";
import { PaintedMap } from "./painted";

const REST_AFTER = 180; // time without a movement after which the picture rests [ms]
const THINNEST = 0.9; // least width at which a hair is drawn [pixels]
const SUBJECT_POINTS = 6000; // of the subject, for the distance of the lamps

/** The camera, and what it is set to: as looks are stored. */
export type CameraState = Pick<Shared, "camera" | "focal_length" | "light_turn">;

export interface DrawStatistics {
  drawMs: number;
  shown: number;
}

export class Viewer {
  readonly renderer: WebGLRenderer;
  readonly camera = new PerspectiveCamera(fieldOfView(FOCAL_LENGTH), 1, 0.02, 20);
  readonly controls: OrbitControls;
  readonly lights = new Lights();
  readonly hair: Record<Side, Hair>;
  readonly guides = new GuideLines();
  readonly painted = new PaintedMap();
  readonly looks = new Looks();
  turntable = false;
  onPaint: () => void = () => {};
  /** The camera has moved. */
  onLook: () => void = () => {};
  onDraw: (statistics: DrawStatistics) => void = () => {};

  /** Whether there is no graphics card: then pictures are plainer, so that they come at all. */
  readonly software: boolean;

  private readonly film: Film;
  /** The second look while two are subtracted. */
  private readonly second: Film;
  private readonly difference = new Difference();
  private readonly clock: Clock;
  private readonly bodies = new Map<number, Body>();
  private readonly scene = new Scene();
  private readonly casters = new Scene();
  private framed = false;
  /** Azimuth and elevation from which the subject is framed, until the camera moves [degrees]. */
  private framedFrom: [number, number] | null = null;
  /** Whether the picture is composed for all of the canvas, as one that is kept: no panels cover it. */
  composed = false;
  private left: Box | null = null;
  private hairShown = true;
  private wanted = false;
  private moved = 0;
  private readonly pace: Pace;
  /** Whether the graphics card is at work on a picture: the next one waits for it. */
  private drawing = false;
  /** Drawings that the picture at rest still lacks; what changes begins it again. */
  private lacking = 0;
  private resting = 0;
  private turned = 0;
  private drawn = 0;

  constructor(readonly element: HTMLElement) {
    this.software = drawsInSoftware();
    this.pace = new Pace(this.software);
    this.renderer = new WebGLRenderer({ antialias: false, powerPreference: "high-performance" });
    this.renderer.autoClear = false;
    this.renderer.outputColorSpace = "srgb-linear"; // the shaders develop on their own
    this.renderer.setPixelRatio(this.software ? 1 : Math.min(devicePixelRatio, 2));
    element.append(this.renderer.domElement);
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "The groom. Arrow keys turn, plus and minus move nearer and away, F frames.");
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.minDistance = 0.08;
    this.controls.maxDistance = 6;
    this.controls.addEventListener("change", () => this.move());
    this.film = new Film(this.software ? 0 : 4);
    this.second = new Film(this.software ? 0 : 4);
    this.clock = new Clock(this.renderer.getContext() as WebGL2RenderingContext);
    const hair = () => new Hair(this.lights);
    this.hair = { a: hair(), b: hair(), c: hair(), d: hair() };
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
  }

  setBody(message: BodyMessage): void {
    this.bodies.get(message.index)?.dispose();
    for (const hair of Object.values(this.hair)) hair.relight();
    const { a, b, c, d } = this.hair;
    const volumes = { a: a.volume, b: b.volume, c: c.volume, d: d.volume };
    this.bodies.set(message.index, new Body(message, this.lights, volumes, [this.scene, this.casters]));
    this.invalidate();
  }

  /** Removes what belongs to a file that is no longer open. */
  reset(): void {
    for (const body of this.bodies.values()) body.dispose();
    this.bodies.clear();
    for (const hair of Object.values(this.hair)) hair.clear();
    this.looks.order = ["a"];
    this.framed = false;
  }

  /** Moves all bodies on one side, whose points follow one another; nothing: to where they rest. */
  placeBodies(side: Side, points?: Float32Array): void {
    let at = 0;
    for (const [, body] of [...this.bodies].sort(([i], [j]) => i - j)) {
      body.place(side, points?.length ? points.slice(3 * at, 3 * (at + body.points)) : undefined);
      at += body.points;
    }
    this.hair[side].relight();
    this.invalidate();
  }

  setHairs(message: Hairs): void {
    this.hair[message.side].setHairs(message);
    this.invalidate();
  }

  setLocks(message: Locks): void {
    this.hair[message.side].setLocks(message);
    this.placeBodies(message.side);
    if (message.draft) this.move();
    if (!this.framed && message.side === "a") this.frame();
    this.invalidate();
  }

  setColors(message: Colors): void {
    this.hair[message.side].setColors(message);
    this.invalidate();
  }

  setColour(named: Colour | null, otherwise: Colour): void {
    for (const hair of Object.values(this.hair)) hair.setColour(named, otherwise);
    this.invalidate();
  }

  setLights(rig: Rig): void {
    this.lights.rig = rig;
    this.invalidate();
  }

  /** Shows the hair, or leaves it out so that its guides are seen. */
  showHair(on: boolean): void {
    this.hairShown = on;
    this.invalidate();
  }

  /** Shows another look too, or no more. */
  compare(side: Side, on: boolean): void {
    if (on) this.looks.add(side);
    else this.looks.remove(side);
    this.invalidate();
  }

  /** The bodies as they are seen, to be met by a ray. */
  get surfaces(): BufferGeometry[] {
    return [...this.bodies.values()].map((body) => body.geometry("a"));
  }

  /** Whether several looks are in the picture. */
  get compared(): boolean {
    return this.looks.several;
  }

  /** Focal length of the lens, for a picture that is 36 mm high [mm]; the subject keeps its size. */
  get focalLength(): number {
    return (0.5 * SENSOR) / Math.tan((0.5 * this.camera.fov * Math.PI) / 180);
  }

  set focalLength(length: number) {
    const away = this.camera.position.clone().sub(this.controls.target).multiplyScalar(length / this.focalLength);
    this.camera.position.copy(this.controls.target).add(away);
    this.camera.fov = fieldOfView(length);
    this.onLook();
    this.invalidate();
  }

  /** Turns the lights about the vertical [degrees]. */
  setLightTurn(degrees: number): void {
    this.lights.turn = degrees;
    this.invalidate();
  }

  /** The camera and the turn of the lights, to be stored. */
  get cameraState(): CameraState {
    const { camera, controls } = this;
    return {
      camera: [...camera.position.toArray(), ...controls.target.toArray()],
      focal_length: Number(this.focalLength.toFixed(2)),
      light_turn: this.lights.turn,
    };
  }

  /** The middle of all hair. */
  get middle(): Vector3 {
    return this.hair.a.box.getCenter(new Vector3());
  }

  /** Puts the camera before the subject so that all of it is in the picture. */
  frame(azimuth = 34, elevation = 7, picture: Size = this.clear): void {
    if (this.hair.a.box.isEmpty()) return;
    this.framed = true;
    const [a, e] = [(azimuth * Math.PI) / 180, (elevation * Math.PI) / 180];
    const backward = new Vector3(Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e));
    const { target, distance } = portrait(this.subject(), backward, picture.width / Math.max(picture.height, 1));
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(backward, (distance * this.focalLength) / FOCAL_LENGTH);
    this.controls.update();
    this.onLook();
    this.framedFrom = [azimuth, elevation];
    this.invalidate();
  }

  /** What a portrait frames: the hair, and the points of bodies near it, without the shoulders. */
  private *subject(): Iterable<Float32Array> {
    const { box, locks } = this.hair.a;
    if (box.isEmpty() || !locks) return;
    yield thinned(locks.points);
    const extent = box.getSize(new Vector3());
    const near = box.clone();
    near.min.addScaledVector(extent, -0.05).y -= 0.05 * extent.y;
    near.max.addScaledVector(extent, 0.05);
    const place = new Vector3();
    for (const body of this.bodies.values()) {
      const points = thinned(body.surface("a").points);
      const inside: number[] = [];
      for (let i = 0; i < points.length; i += 3)
        if (near.containsPoint(place.fromArray(points, i))) inside.push(points[i], points[i + 1], points[i + 2]);
      if (inside.length) yield new Float32Array(inside);
    }
  }

  /** Where a portrait camera of this direction would be, which the lamps go by. */
  private get portrait(): Portrait {
    const backward = this.camera.position.clone().sub(this.controls.target).normalize();
    return portrait(this.subject(), backward);
  }

  /** Puts the camera: its place and its target, six numbers, and the focal length of its lens [mm]. */
  lookFrom(camera: number[], focalLength = this.focalLength): void {
    this.framed = true;
    this.framedFrom = null;
    this.camera.fov = fieldOfView(focalLength);
    this.camera.position.fromArray(camera);
    this.controls.target.fromArray(camera, 3);
    this.camera.lookAt(this.controls.target);
    this.onLook();
    this.invalidate();
  }

  /** Does something with the open look alone, after which the camera is where it was. */
  withView(does: () => void): void {
    const { camera, focal_length } = this.cameraState;
    const { order } = this.looks;
    const moved = this.onLook;
    this.onLook = () => {};
    this.looks.order = ["a"];
    does();
    this.looks.order = order;
    this.lookFrom(camera, focal_length);
    this.onLook = moved;
  }

  /** Keeps the camera where it is when panels open and close. */
  stay(): void {
    this.framedFrom = null;
  }

  /** Something moves: speed counts more than detail for a moment. */
  move(): void {
    this.framedFrom = null;
    this.onLook();
    this.moved = performance.now();
    this.invalidate();
  }

  invalidate(): void {
    this.film.drawings = 0;
    this.lacking = 1;
    this.request();
  }

  private request(): void {
    if (this.wanted) return;
    this.wanted = true;
    if (!this.drawing) requestAnimationFrame(() => this.draw());
  }

  /** Draws the picture at rest at once, for pictures that are kept. */
  drawNow(): void {
    this.moved = 0;
    const fraction = this.resolved();
    this.prepare(false);
    this.film.drawings = 0;
    this.paint({ fraction, drawings: this.pace.needed(fraction) }, false);
    this.lacking = 0;
  }

  /** Size of the picture [pixels]. */
  get size(): Size {
    const { clientWidth, clientHeight } = this.element;
    return { width: clientWidth, height: clientHeight };
  }

  /** What panels leave clear of the picture. */
  get clear(): Box {
    return this.composed || !this.left ? { x: 0, y: 0, ...this.canvas } : this.left;
  }

  private get canvas(): Size {
    const { x, y } = this.renderer.getSize(new Vector2());
    return { width: x, height: y };
  }

  /** Panels leave another part clear; a subject that was framed is framed again. */
  setClear(box: Box): void {
    this.left = box;
    if (this.framedFrom) this.frame(...this.framedFrom);
    this.invalidate();
  }

  /** Where a pointer is in the picture [pixels]. */
  at(event: MouseEvent): { x: number; y: number } {
    const box = this.element.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  /** Draws at a size, for a picture that is kept; then as before. A clear one has no backdrop. */
  drawAt(width: number, height: number, clear: boolean): HTMLCanvasElement {
    const { renderer, element } = this;
    const ratio = renderer.getPixelRatio();
    renderer.setPixelRatio(1);
    renderer.setSize(width, height, false);
    const { composed } = this;
    this.composed = true;
    this.drawNow();
    this.composed = composed;
    const kept = document.createElement("canvas");
    [kept.width, kept.height] = [width, height];
    const context = kept.getContext("2d")!;
    if (clear) context.putImageData(this.film.transparent(renderer), 0, 0);
    else context.drawImage(renderer.domElement, 0, 0);
    renderer.setPixelRatio(ratio);
    renderer.setSize(element.clientWidth, element.clientHeight);
    this.invalidate();
    return kept;
  }

  get pictures(): number {
    return this.drawn;
  }

  /** Whether no picture is to come until something changes. */
  get idle(): boolean {
    return !this.wanted && !this.resting && !this.turntable && !this.drawing && !this.lacking;
  }

  private draw(): void {
    this.wanted = false;
    const now = performance.now();
    if (this.turntable) {
      const passed = this.turned ? Math.min(now - this.turned, 100) : 0;
      this.turned = now;
      this.orbit((passed / 1000) * 0.6, 0);
      this.moved = now;
    } else this.turned = 0;
    const moving = now - this.moved < REST_AFTER;
    if (moving) this.film.drawings = 0;
    this.prepare(moving);
    const portion = this.pace.next(moving);
    this.clock.begin();
    this.paint(portion, moving);
    this.lacking = moving ? 1 : Math.max(0, this.pace.needed(portion.fraction) - this.film.drawings);
    this.onPaint();
    if (moving) {
      clearTimeout(this.resting);
      this.resting = window.setTimeout(() => {
        this.resting = 0;
        this.invalidate();
      }, REST_AFTER + 20);
    }
    this.drawn++;
    this.drawing = true;
    this.clock.end((took) => {
      this.drawing = false;
      this.pace.took(took, portion, moving);
      this.onDraw({ drawMs: took, shown: Math.round(this.hair.a.count * Math.min(1, portion.fraction * this.film.drawings)) });
      if (this.wanted) requestAnimationFrame(() => this.draw());
      else if (this.turntable) this.invalidate();
      else if (!moving && this.lacking) this.request();
    });
  }

  /** The fraction of the hairs that is about as wide as a pixel when it stands for all. */
  private resolved(): number {
    const hair = this.hair.a;
    const { clear } = this.cells[0];
    const away = this.camera.position.distanceTo(this.controls.target);
    const pixel = (2 * away * Math.tan((0.5 * this.camera.fov * Math.PI) / 180)) / (clear.height * this.renderer.getPixelRatio());
    this.pace.resolved = Math.min(1, Math.max(hair.width / (THINNEST * pixel), 1 / Math.max(hair.count, 1)));
    return this.pace.resolved;
  }

  /** Camera, lamps, and the light in the hair of each side. */
  private prepare(moving: boolean): void {
    const { renderer, camera, lights } = this;
    camera.updateMatrixWorld();
    this.resolved();
    lights.update(camera, this.portrait);
    for (const { side } of this.cells) {
      const hair = this.hair[side];
      hair.update(renderer);
      hair.light(renderer, () => [...this.bodies.values()].filter((body) => body.solid).map((body) => body.surface(side)), moving);
    }
  }

  /** Which looks are drawn, and where. */
  private get cells(): Cell[] {
    return this.looks.cells(this.canvas, this.clear);
  }

  /** Adds drawings to the film and develops it. */
  private paint({ fraction, drawings }: Portion, moving: boolean): void {
    const { renderer, film, looks } = this;
    const buffer = renderer.getDrawingBufferSize(new Vector2());
    const cells = this.cells;
    const pictures = looks.difference ? [cells.slice(0, 1), cells.slice(1)] : [cells];
    if (film.width !== buffer.x || film.height !== buffer.y) film.drawings = 0;
    const begun = film.drawings;
    const { clear } = this;
    const ratio = renderer.getPixelRatio();
    const seen = { x: ratio * clear.x, y: ratio * clear.y, width: ratio * clear.width, height: ratio * clear.height };
    pictures.forEach((some, k) => {
      const one = k ? this.second : film;
      one.drawings = begun;
      if (!begun) one.clear(buffer.x, buffer.y);
      for (let n = 0; n < drawings; n++) {
        one.open(renderer);
        this.expose(some, fraction, one.drawings, moving ? 2 : 1);
        one.expose(renderer);
      }
      one.show(renderer, seen, looks.difference ? this.difference.target(k, renderer) : null);
    });
    if (looks.difference) this.difference.draw(renderer);
    else this.drawOverlays(cells);
    this.aim({ canvas: { x: 0, y: 0, ...this.size }, clear: this.clear, zoom: 1 }); // what is over the picture goes by this camera
  }

  /** Draws looks once: a part of the hairs, another one in each drawing, and the pixels moved by a part of one. */
  private expose(cells: Cell[], fraction: number, number: number, stride: number): void {
    const { renderer, camera } = this;
    const size = renderer.getSize(new Vector2());
    // The sequence R2 of Roberts 2018 over a filter as wide as the path tracer's
    const ratio = renderer.getPixelRatio();
    const [x, y] = [0.7548776662, 0.5698402909].map((step) => ((((0.5 + step * number) % 1) - 0.5) * 1.2) / ratio);
    for (const body of this.bodies.values()) body.seenFrom(camera.position);
    renderer.setScissorTest(cells.length > 1);
    for (const cell of cells) {
      const hair = this.hair[cell.side];
      this.aim(cell, x, y);
      this.window(cell, size);
      for (const body of this.bodies.values()) body.turnTo(cell.side);
      hair.setDetail(fraction, stride, Math.round(number * fraction * hair.count) % Math.max(hair.count, 1));
      hair.seenFrom(camera.position);
      renderer.render(this.scene, camera);
      if (hair.table && this.hairShown) {
        renderer.render(hair.firstScene, camera);
        renderer.render(hair.scene, camera);
      }
    }
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, size.x, size.y);
  }

  private drawOverlays(cells: Cell[]): void {
    const { renderer, camera } = this;
    const cell = cells.find(({ side }) => side === "a");
    if (!cell || !(this.guides.shown || this.painted.shown)) return;
    const size = renderer.getSize(new Vector2());
    this.aim(cell);
    this.window(cell, size);
    for (const body of this.bodies.values()) body.turnTo("a");
    renderer.clearDepth();
    renderer.render(this.casters, camera);
    if (this.painted.shown) renderer.render(this.painted.scene, camera);
    if (this.guides.shown) renderer.render(this.guides.scene, camera);
    renderer.setViewport(0, 0, size.x, size.y);
  }

  /** Aims the camera at the middle of what is clear of a cell, moved by a part of a pixel. */
  private aim({ canvas, clear, zoom }: Pick<Cell, "canvas" | "clear" | "zoom">, x = 0, y = 0): void {
    const { camera } = this;
    camera.zoom = zoom;
    camera.aspect = clear.width / Math.max(clear.height, 1);
    camera.setViewOffset(clear.width, clear.height, canvas.x - clear.x + x, canvas.y - clear.y + y, canvas.width, canvas.height);
  }

  /** Sets the part of the canvas that a cell fills. */
  private window({ box, canvas }: Cell, size: Vector2): void {
    const { renderer } = this;
    renderer.setViewport(canvas.x, size.y - canvas.y - canvas.height, canvas.width, canvas.height);
    renderer.setScissor(box.x, size.y - box.y - box.height, box.width, box.height);
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.element;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.prepare(true);
    this.paint(this.pace.next(true), true); // before the browser shows the emptied canvas
    this.invalidate();
  }

  /** Turns about the subject [radians]. */
  orbit(turn: number, lift: number): void {
    const away = this.camera.position.clone().sub(this.controls.target);
    const radius = away.length();
    const azimuth = Math.atan2(away.x, away.z) + turn;
    const elevation = Math.min(1.45, Math.max(-1.45, Math.asin(away.y / radius) + lift));
    away.set(Math.sin(azimuth) * Math.cos(elevation), Math.sin(elevation), Math.cos(azimuth) * Math.cos(elevation));
    this.camera.position.copy(this.controls.target).addScaledVector(away, radius);
    this.camera.lookAt(this.controls.target);
  }

  /** Turns, approaches or frames by a key; whether it was one of these. */
  key(key: string): boolean {
    const step = 0.1;
    const turns: Record<string, [number, number]> = {
      ArrowLeft: [-step, 0],
      ArrowRight: [step, 0],
      ArrowUp: [0, step],
      ArrowDown: [0, -step],
    };
    const nearer: Record<string, number> = { "+": 0.9, "=": 0.9, "-": 1.1 };
    if (turns[key]) this.orbit(...turns[key]);
    else if (nearer[key]) {
      const away = this.camera.position.clone().sub(this.controls.target).multiplyScalar(nearer[key]);
      this.camera.position.copy(this.controls.target).add(away);
    } else if (key.toLowerCase() === "f") this.frame();
    else return false;
    this.move();
    return true;
  }
}

/** Some of the points, three numbers each. */
function thinned(points: Float32Array): Float32Array {
  const every = Math.ceil(points.length / (3 * SUBJECT_POINTS));
  if (every <= 1) return points;
  const kept = new Float32Array(3 * Math.floor(points.length / (3 * every)));
  for (let i = 0; i < kept.length; i += 3) kept.set(points.subarray(i * every, i * every + 3), i);
  return kept;
}

function drawsInSoftware(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) throw new Error("This browser has no WebGL 2; the review needs it.");
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}
