// The picture: bodies and hair before a wall. Drawn only when something has changed, so an idle page rests.

import { type Box3, PerspectiveCamera, Scene, Vector2, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Body as BodyMessage, Colors, Hairs, Locks, Shared } from "../protocol";
import { Backdrop } from "./backdrop";
import { Body } from "./body";
import { Difference } from "./difference";
import { GuideLines } from "./guides";
import { type Colour, Hair } from "./hair";
import { Lights, PRESETS } from "./lights";
import { type Cell, type Covered, Looks, type Side } from "./looks";
import { Pace, whenDrawn } from "./pace";
import { Shadow } from "./shadow";

export const FOCAL_LENGTH = 85; // of a portrait lens [mm]
const FILM = 36; // height of the picture that focal lengths refer to, as those of ringlet picture [mm]
const REST_AFTER = 180; // time without a movement after which all detail is drawn [ms]

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
  readonly looks = new Looks();
  private theme: "dark" | "light" = "dark";
  turntable = false;
  onPaint: () => void = () => {};
  /** The camera has moved. */
  onLook: () => void = () => {};
  onDraw: (statistics: DrawStatistics) => void = () => {};

  covered: () => Covered = () => [0, 0, 0, 0];

  /** Whether there is no graphics card: then pictures are plainer, so that they come at all. */
  readonly software: boolean;

  private readonly shadow: Shadow;
  private readonly backdrop = new Backdrop();
  private readonly difference: Difference;
  private readonly bodies = new Map<number, Body>();
  private readonly scene = new Scene();
  private readonly casters = new Scene();
  private framed = false;
  /** Whether a picture is drawn that is kept: no panels cover it. */
  private keeping = false;
  private hairShown = true;
  private wanted = false;
  private moved = 0;
  private readonly pace: Pace;
  /** Whether the graphics card is at work on a picture: the next one waits for it. */
  private drawing = false;
  private fresh = true;
  private resting = 0;
  private turned = 0;
  private drawn = 0;

  constructor(readonly element: HTMLElement) {
    this.software = drawsInSoftware();
    this.pace = new Pace(this.software);
    this.renderer = new WebGLRenderer({ antialias: !this.software, powerPreference: "high-performance" });
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
    this.shadow = new Shadow(this.software ? 384 : 1024);
    const hair = () => new Hair(this.lights, this.shadow);
    this.hair = { a: hair(), b: hair(), c: hair(), d: hair() };
    this.difference = new Difference(this.software ? 0 : 4);
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
  }

  setBody(message: BodyMessage): void {
    this.bodies.get(message.index)?.dispose();
    this.bodies.set(message.index, new Body(message, this.lights, this.shadow, [this.scene, this.casters]));
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

  setLights(name: string): void {
    this.lights.preset = PRESETS[name] ?? PRESETS["studio"];
    this.invalidate();
  }

  setTheme(theme: "dark" | "light"): void {
    this.theme = theme;
    this.backdrop.setTheme(theme);
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

  /** Whether several looks are in the picture. */
  get compared(): boolean {
    return this.looks.several;
  }

  /** Focal length of the lens, for a picture that is 36 mm high [mm]; the subject keeps its size. */
  get focalLength(): number {
    return FILM / 2 / Math.tan((0.5 * this.camera.fov * Math.PI) / 180);
  }

  set focalLength(length: number) {
    const away = this.camera.position.clone().sub(this.controls.target).multiplyScalar(length / this.focalLength);
    this.camera.position.copy(this.controls.target).add(away);
    this.camera.fov = fieldOfView(length);
    this.onLook();
    this.invalidate();
  }

  /** Angle by which the lights are turned about the vertical [degrees]. */
  setLightTurn(degrees: number): void {
    this.lights.turn = degrees;
    this.invalidate();
  }

  /** The camera and the turn of the lights, to be stored. */
  get cameraState(): CameraState {
    const { camera, controls } = this;
    return {
      camera: [...camera.position.toArray(), ...controls.target.toArray()],
      focal_length: round(this.focalLength, 2),
      light_turn: this.lights.turn,
    };
  }

  /** The middle of all hair. */
  get middle(): Vector3 {
    return this.hair.a.box.getCenter(new Vector3());
  }

  /** Puts the camera before the subject so that all hair is in the picture; without angles it keeps its direction. */
  frame(azimuth = 34, elevation = 6, picture = this.size): void {
    const box = this.hair.a.box;
    if (box.isEmpty()) return;
    this.framed = true;
    const size = box.getSize(new Vector3());
    const target = box.getCenter(new Vector3());
    target.y -= 0.06 * size.y;
    const radius = 0.5 * Math.max(size.x, size.z, 1.12 * size.y);
    const narrow = Math.min(1, picture.width / Math.max(picture.height, 1));
    const distance = (1.32 * radius) / Math.tan((0.5 * this.camera.fov * Math.PI) / 180) / narrow;
    const [a, e] = [(azimuth * Math.PI) / 180, (elevation * Math.PI) / 180];
    this.controls.target.copy(target);
    this.camera.position
      .set(Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e))
      .multiplyScalar(distance)
      .add(target);
    this.controls.update();
    this.onLook();
    this.invalidate();
  }

  /** Puts the camera: its place and its target, six numbers, and the focal length of its lens [mm]. */
  lookFrom(camera: number[], focalLength = this.focalLength): void {
    this.framed = true;
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
    this.drawNow();
  }

  /** Something moves: speed counts more than detail for a moment. */
  move(): void {
    this.onLook();
    this.moved = performance.now();
    this.invalidate();
  }

  invalidate(): void {
    this.fresh = true;
    this.request();
  }

  private request(): void {
    if (this.wanted) return;
    this.wanted = true;
    if (!this.drawing) requestAnimationFrame(() => this.draw());
  }

  /** Draws at once, with all detail: for pictures. */
  drawNow(): void {
    this.moved = 0;
    this.paint(1);
  }

  /** Size of the picture [pixels]. */
  get size(): { width: number; height: number } {
    const { clientWidth, clientHeight } = this.element;
    return { width: clientWidth, height: clientHeight };
  }

  /** Where a pointer is in the picture [pixels]. */
  at(event: MouseEvent): { x: number; y: number } {
    const box = this.element.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  /** Draws at a size and before a wall of one color, for a picture that is kept; then as before. */
  drawAt(width: number, height: number, taken: (drawn: HTMLCanvasElement) => void, wall?: string): void {
    const { renderer, element } = this;
    const ratio = renderer.getPixelRatio();
    renderer.setPixelRatio(1);
    renderer.setSize(width, height, false);
    if (wall) this.backdrop.setWall(wall, wall);
    this.keeping = true;
    this.drawNow();
    this.keeping = false;
    taken(renderer.domElement);
    this.backdrop.setTheme(this.theme);
    renderer.setPixelRatio(ratio);
    renderer.setSize(element.clientWidth, element.clientHeight);
    this.drawNow();
  }

  get pictures(): number {
    return this.drawn;
  }

  /** Whether no picture is to come until something changes. */
  get idle(): boolean {
    return !this.wanted && !this.resting && !this.turntable && !this.drawing;
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
    this.pace.hairs = this.hair.a.count;
    const detail = this.pace.next(moving, this.fresh);
    this.fresh = false;
    this.paint(detail);
    this.onPaint();
    if (moving) {
      clearTimeout(this.resting);
      this.resting = window.setTimeout(() => {
        this.resting = 0;
        this.request(); // goes on from the detail of the last picture
      }, REST_AFTER + 20);
    }
    this.drawn++;
    this.drawing = true;
    whenDrawn(this.renderer.getContext() as WebGL2RenderingContext, () => {
      const took = performance.now() - now;
      this.drawing = false;
      this.pace.took(took, detail, moving);
      this.onDraw({ drawMs: took, shown: Math.round(this.hair.a.count * detail) });
      if (this.wanted) requestAnimationFrame(() => this.draw());
      else if (this.turntable) this.invalidate();
      else if (!moving && this.pace.refines) this.request();
    });
  }

  private paint(detail: number): void {
    const { renderer, camera, lights } = this;
    const size = renderer.getSize(new Vector2());
    camera.updateMatrixWorld();
    lights.update(camera);
    this.backdrop.update(size.x / Math.max(size.y, 1));
    for (const body of this.bodies.values()) body.seenFrom(camera.position);
    const { difference, looks } = this;
    const cells = looks.cells(size.x, size.y, this.keeping ? [0, 0, 0, 0] : this.covered());
    cells.forEach((cell, k) => {
      if (looks.difference) renderer.setRenderTarget(difference.target(k, renderer));
      this.aim(cell, looks.zoom(cell));
      const { x, y, width, height } = cell.box;
      this.paintLook(cell.side, detail, size.y, () => {
        renderer.setScissorTest(cells.length > 1 && !looks.difference);
        // The view of a look next to others is that of its cell; else all are seen through one window.
        if (looks.split) renderer.setViewport(x, size.y - y - height, width, height);
        else renderer.setViewport(0, 0, size.x, size.y);
        renderer.setScissor(x, size.y - y - height, width, height);
      });
    });
    renderer.setRenderTarget(null);
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, size.x, size.y);
    if (looks.difference) difference.draw(renderer, camera);
    if (!looks.split) return;
    this.aim({ side: "a", box: { x: 0, y: 0, width: size.x, height: size.y }, clear: { x: 0, y: 0, width: size.x, height: size.y } }, 1);
  }

  /** Aims the camera at the middle of what is clear of a cell. */
  private aim({ box, clear }: Cell, zoom: number): void {
    const { camera, looks } = this;
    camera.zoom = zoom;
    camera.aspect = clear.width / Math.max(clear.height, 1);
    if (looks.split) camera.setViewOffset(clear.width, clear.height, box.x - clear.x, box.y - clear.y, box.width, box.height);
    else camera.setViewOffset(clear.width, clear.height, 0, 0, clear.width, clear.height);
  }

  /** Draws one look. window: sets what of the canvas it fills, after its shadows are drawn. */
  private paintLook(side: Side, detail: number, height: number, window: () => void): void {
    const { renderer, camera, lights } = this;
    const hair = this.hair[side];
    const full = camera.view?.fullHeight ?? height;
    const pixel = (2 * Math.tan((0.5 * camera.fov * Math.PI) / 180)) / (full * camera.zoom * renderer.getPixelRatio());
    for (const body of this.bodies.values()) body.turnTo(side);
    hair.setDetail(detail, detail < 0.5 ? 2 : 1);
    hair.update(renderer);
    hair.seenFrom(camera.position, pixel);
    hair.litFrom(lights.key, this.shadow.texel);
    const box = this.lit(hair);
    renderer.setScissorTest(false);
    if (!box.isEmpty() && this.hairShown) {
      const casters = { bodies: this.casters, hairDepth: hair.depthScene, hairLayers: hair.layersScene };
      this.shadow.update(renderer, lights.key, box, casters);
    }
    window();
    renderer.clear();
    renderer.render(this.backdrop.scene, camera);
    renderer.render(this.scene, camera);
    if (hair.table && this.hairShown) {
      renderer.render(hair.firstScene, camera);
      renderer.render(hair.scene, camera);
    }
    if (side === "a" && this.guides.shown) {
      renderer.clearDepth();
      renderer.render(this.casters, camera);
      renderer.render(this.guides.scene, camera);
    }
  }

  /** What the key light must cover: the hair, and what it throws shadows on. */
  private lit(hair: Hair): Box3 {
    const box = hair.box.clone();
    if (!box.isEmpty()) box.min.y -= 0.35 * (box.max.y - box.min.y);
    return box;
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.element;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.paint(this.pace.next(true, true)); // before the browser shows the emptied canvas
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

/** Vertical field of view of a lens [degrees]. */
function fieldOfView(focalLength: number): number {
  return (2 * Math.atan(FILM / 2 / focalLength) * 180) / Math.PI;
}

function round(value: number, digits: number): number {
  return Number(value.toFixed(digits));
}

function drawsInSoftware(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) throw new Error("This browser has no WebGL 2; the review needs it.");
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}
