// Light rigs of the path-traced pictures. The studio turns with the camera, as a photographer's does.

import { type Camera, Matrix4, Vector3 } from "three";
import type { Lamp, Rig } from "../protocol";
import type { Portrait } from "./framing";
import type { Beam } from "./beam";

const LAMPS = 4;
const UP = new Vector3(0, 1, 0);
const NONE: Lamp = { azimuth: 0, elevation: 0, size: 0.1, strength: [0, 0, 0], distance: 1 };

const OFF: Rig = { label: "", with_camera: true, ambient: [0, 0, 0], lamps: [] };

export class Lights {
  rig: Rig = OFF;
  /** Angle by which the rig is turned about the vertical, counter-clockwise from above [degrees]. */
  turn = 0;
  readonly uniforms = {
    lampAt: { value: Array.from({ length: LAMPS }, () => new Vector3()) },
    lampStrength: { value: Array.from({ length: LAMPS }, () => new Vector3()) },
    lampSpread: { value: [0, 0, 0, 0] },
    lampReach: { value: [1, 1, 1, 1] },
    ambient: { value: 0 },
  };
  /** Directions from the middle of the subject towards the lamps. */
  private readonly from = Array.from({ length: LAMPS }, () => new Vector3(0, 0, 1));

  /** Mean variance of the direction to a lamp, by its size: that of a disk is a quarter of its squared radius [rad²]. */
  get spread(): number {
    const { lamps } = this.rig;
    return lamps.reduce((sum, { size }) => sum + size ** 2 / 16, 0) / Math.max(lamps.length, 1);
  }

  /** Puts the lamps around what the camera looks at. */
  update(camera: Camera, portrait: Portrait): void {
    const { rig, from } = this;
    const { lampAt, lampStrength, lampSpread, lampReach } = this.uniforms;
    const withCamera = new Matrix4();
    if (rig.with_camera) withCamera.extractRotation(camera.matrixWorld);
    this.uniforms.ambient.value = rig.ambient[1];
    for (let k = 0; k < LAMPS; k++) {
      const lamp = rig.lamps[k] ?? NONE;
      const [a, e] = [(lamp.azimuth * Math.PI) / 180, (lamp.elevation * Math.PI) / 180];
      from[k].set(Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)).applyMatrix4(withCamera);
      from[k].applyAxisAngle(UP, (this.turn * Math.PI) / 180);
      lampAt.value[k].copy(portrait.target).addScaledVector(from[k], lamp.distance * portrait.distance);
      lampStrength.value[k].set(...lamp.strength);
      lampSpread.value[k] = lamp.size / 2;
      lampReach.value[k] = lamp.distance * portrait.distance;
    }
  }

  get ambient(): Vector3 {
    return new Vector3(...this.rig.ambient);
  }

  /** The lamps as the light in the mass of the hair needs them. */
  get beams(): Beam[] {
    const { lampAt, lampStrength, lampSpread, lampReach } = this.uniforms;
    return this.from.map((from, k) => ({
      from,
      place: lampAt.value[k],
      reach: lampReach.value[k],
      radius: lampSpread.value[k] * lampReach.value[k],
      strength: lampStrength.value[k],
    }));
  }
}
