// The camera, which orbits what it looks at, and its lens.

import { PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Size } from "./box";
import { fieldOfView, FOCAL_LENGTH, type Portrait, portrait, SENSOR } from "./framing";
import type { Cell } from "./looks";

const STEEPEST = 1.45; // elevation [radians]
const STEP = 0.1; // of an arrow key [radians], and the fraction by which + and - change the distance

export class OrbitCamera {
  readonly camera = new PerspectiveCamera(fieldOfView(FOCAL_LENGTH), 1, 0.02, 20);
  readonly controls: OrbitControls;
  /** Azimuth and elevation from which the subject is framed, until the camera moves [degrees]. */
  framed: [number, number] | null = null;

  constructor(canvas: HTMLCanvasElement) {
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.minDistance = 0.08;
    this.controls.maxDistance = 6;
  }

  /** Focal length of the lens, for a picture that is 36 mm high [mm]; the subject keeps its size. */
  get focalLength(): number {
    return (0.5 * SENSOR) / Math.tan((0.5 * this.camera.fov * Math.PI) / 180);
  }

  set focalLength(length: number) {
    this.approach(length / this.focalLength);
    this.camera.fov = fieldOfView(length);
  }

  /** Its place and its target, six numbers [m]. */
  get place(): number[] {
    return [...this.camera.position.toArray(), ...this.controls.target.toArray()];
  }

  /** From the target to the camera [m]. */
  private get away(): Vector3 {
    return this.camera.position.clone().sub(this.controls.target);
  }

  /** place: of the camera and of its target, six numbers [m]; focalLength: of its lens [mm] */
  lookFrom(place: number[], focalLength = this.focalLength): void {
    this.framed = null;
    this.camera.fov = fieldOfView(focalLength);
    this.camera.position.fromArray(place);
    this.controls.target.fromArray(place, 3);
    this.camera.lookAt(this.controls.target);
  }

  /** Looks at a subject from a direction [degrees], so that all of it is in a picture of a size. */
  frame(subject: Iterable<Float32Array>, azimuth: number, elevation: number, picture: Size): void {
    const [a, e] = [(azimuth * Math.PI) / 180, (elevation * Math.PI) / 180];
    const backward = new Vector3(Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e));
    const { target, distance } = portrait(subject, backward, picture.width / picture.height);
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(backward, (distance * this.focalLength) / FOCAL_LENGTH);
    this.controls.update();
    this.framed = [azimuth, elevation];
  }

  /** Where a portrait camera of this direction would be, which the lamps go by. */
  portrait(subject: Iterable<Float32Array>): Portrait {
    return portrait(subject, this.away.normalize());
  }

  /** Turns about the target [radians]. */
  orbit(turn: number, lift: number): void {
    const { away } = this;
    const radius = away.length();
    const azimuth = Math.atan2(away.x, away.z) + turn;
    const elevation = Math.min(STEEPEST, Math.max(-STEEPEST, Math.asin(away.y / radius) + lift));
    away.set(Math.sin(azimuth) * Math.cos(elevation), Math.sin(elevation), Math.cos(azimuth) * Math.cos(elevation));
    this.camera.position.copy(this.controls.target).addScaledVector(away, radius);
    this.camera.lookAt(this.controls.target);
  }

  private approach(factor: number): void {
    const { away } = this; // before the camera moves
    this.camera.position.copy(this.controls.target).addScaledVector(away, factor);
  }

  /** Turns or approaches by a key; whether it was one of these. */
  key(key: string): boolean {
    const turns: Record<string, [number, number]> = {
      ArrowLeft: [-STEP, 0],
      ArrowRight: [STEP, 0],
      ArrowUp: [0, STEP],
      ArrowDown: [0, -STEP],
    };
    const nearer: Record<string, number> = { "+": 1 - STEP, "=": 1 - STEP, "-": 1 + STEP };
    if (turns[key]) this.orbit(...turns[key]);
    else if (nearer[key]) this.approach(nearer[key]);
    else return false;
    return true;
  }

  /** Aims at the middle of what is clear of a cell, moved by a part of a pixel. */
  aim({ canvas, clear, zoom }: Pick<Cell, "canvas" | "clear" | "zoom">, x = 0, y = 0): void {
    const { camera } = this;
    camera.zoom = zoom;
    camera.aspect = clear.width / Math.max(clear.height, 1);
    camera.setViewOffset(clear.width, clear.height, canvas.x - clear.x + x, canvas.y - clear.y + y, canvas.width, canvas.height);
  }

  /** Width of a pixel at the target in a picture of a height [m]. */
  pixel(height: number): number {
    return (2 * this.away.length() * Math.tan((0.5 * this.camera.fov * Math.PI) / 180)) / height;
  }
}
