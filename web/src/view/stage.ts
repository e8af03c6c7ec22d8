// What is before the camera: bodies, the hair of each look, guides, painted maps and lights.

import { type BufferGeometry, Scene, Vector3 } from "three";
import type { Body as BodyMessage, Colors, Hairs, Locks, Rig } from "../protocol";
import { Body, type Pose } from "./body";
import { GuideLines } from "./guides";
import { type Colour, Hair } from "./hair";
import { Lights } from "./lights";
import type { Side } from "./looks";
import { PaintedMap } from "./painted";

const SUBJECT_POINTS = 6000; // of the subject, for the distance of camera and lamps

export class Stage {
  readonly lights = new Lights();
  readonly hair: Record<Side, Hair>;
  readonly guides = new GuideLines();
  readonly painted = new PaintedMap();
  readonly bodies = new Map<number, Body>();
  private readonly coming: BodyMessage[] = []; // bodies of a scene of which others are still to come
  /** The bodies as they are seen, and without color, to hide what is behind them. */
  readonly scene = new Scene();
  readonly casters = new Scene();
  /** Whether the hair is shown; its guides are seen without it. */
  hairShown = true;

  /** changed: hears that the picture is another; deferred, most: see `Hair` */
  constructor(
    private readonly changed: () => void,
    deferred: boolean,
    most: number,
  ) {
    const hair = () => new Hair(this.lights, deferred, most);
    this.hair = { a: hair(), b: hair(), c: hair(), d: hair() };
  }

  /** Takes a body of a scene, in order. All are shown with the last: an eye is none without its iris. */
  setBody(message: BodyMessage): void {
    const { coming } = this;
    if (message.index === 0) coming.length = 0;
    coming.push(message);
    if (coming.length === message.of) this.setBodies(coming.splice(0));
  }

  private setBodies(messages: BodyMessage[]): void {
    for (const body of this.bodies.values()) body.dispose();
    this.bodies.clear();
    for (const hair of Object.values(this.hair)) hair.relight();
    const { a, b, c, d } = this.hair;
    const volumes = { a: a.volume, b: b.volume, c: c.volume, d: d.volume };
    for (const message of messages)
      this.bodies.set(message.index, new Body(message, this.lights, volumes, [this.scene, this.casters]));
    this.changed();
  }

  /** Removes what belongs to a file that is no longer open. */
  clear(): void {
    for (const body of this.bodies.values()) body.dispose();
    this.bodies.clear();
    for (const hair of Object.values(this.hair)) hair.clear();
  }

  /** Moves all bodies on one side, whose points follow one another; nothing: to where they rest. */
  placeBodies(side: Side, points?: Float32Array): void {
    let at = 0;
    for (const [, body] of [...this.bodies].sort(([i], [j]) => i - j)) {
      body.place(side, points?.length ? points.slice(3 * at, 3 * (at + body.points)) : undefined);
      at += body.points;
    }
    this.hair[side].relight();
    this.changed();
  }

  /** Moves all bodies on one side by a pose of the head, but for the last ones, whose points what the hair wears has. */
  pose(side: Side, pose: Pose, worn: Float32Array): void {
    const bodies = [...this.bodies].sort(([i], [j]) => j - i).map(([, body]) => body);
    let end = worn.length;
    const ends = bodies.map((_, k) => 3 * bodies.slice(0, k + 1).reduce((sum, body) => sum + body.points, 0));
    const fits = !end || ends.includes(end);
    if (!fits) end = 0; // the hair of another groom wears something else
    for (const body of bodies) {
      if (end) body.place(side, worn.slice(end - 3 * body.points, end));
      else body.pose(side, pose);
      end = Math.max(0, end - 3 * body.points);
    }
    this.hair[side].relight();
    this.changed();
  }

  setHairs(message: Hairs): void {
    this.hair[message.side].setHairs(message);
    this.changed();
  }

  setLocks(message: Locks): void {
    this.hair[message.side].setLocks(message);
    this.placeBodies(message.side);
  }

  setColors(message: Colors): void {
    this.hair[message.side].setColors(message);
    this.changed();
  }

  setColour(named: Colour | null, otherwise: Colour): void {
    for (const hair of Object.values(this.hair)) hair.setColour(named, otherwise);
    this.changed();
  }

  setLights(rig: Rig): void {
    this.lights.rig = rig;
    this.changed();
  }

  /** Turns the lights about the vertical [degrees]. */
  setLightTurn(degrees: number): void {
    this.lights.turn = degrees;
    this.changed();
  }

  showHair(on: boolean): void {
    this.hairShown = on;
    this.changed();
  }

  /** The bodies as they are seen, to be met by a ray. */
  get surfaces(): BufferGeometry[] {
    return [...this.bodies.values()].map((body) => body.geometry("a"));
  }

  /** The middle of all hair. */
  get middle(): Vector3 {
    return this.hair.a.box.getCenter(new Vector3());
  }

  /** What a portrait frames: the hair, and the points of bodies near it, without the shoulders. */
  *subject(): Iterable<Float32Array> {
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
}

/** Some of the points, three numbers each. */
function thinned(points: Float32Array): Float32Array {
  const every = Math.ceil(points.length / (3 * SUBJECT_POINTS));
  if (every <= 1) return points;
  const kept = new Float32Array(3 * Math.floor(points.length / (3 * every)));
  for (let i = 0; i < kept.length; i += 3) kept.set(points.subarray(i * every, i * every + 3), i);
  return kept;
}
