// Lights around the subject. In the studio they turn with the camera, as a photographer's do.

import { type Camera, Color, Matrix4, Vector3 } from "three";

interface Lamp {
  azimuth: number; // from the camera, or from the front, to the right [degrees]
  elevation: number; // [degrees]
  strength: [number, number, number];
}

export interface Preset {
  label: string;
  withCamera: boolean;
  ambient: [number, number, number];
  exposure: number;
  lamps: [Lamp, Lamp, Lamp, Lamp]; // the first casts shadows
}

const lamp = (azimuth: number, elevation: number, r: number, g: number, b: number): Lamp => ({
  azimuth,
  elevation,
  strength: [r, g, b],
});

export const PRESETS: Record<string, Preset> = {
  studio: {
    label: "Studio",
    withCamera: true,
    ambient: [0.3, 0.31, 0.34],
    exposure: 1,
    lamps: [
      lamp(-36, 32, 4.6, 4.0, 3.35),
      lamp(64, 6, 0.75, 0.85, 1.0),
      lamp(142, 34, 4.2, 4.1, 4.0),
      lamp(-128, 50, 4.2, 4.1, 4.1),
    ],
  },
  daylight: {
    label: "Daylight",
    withCamera: false,
    ambient: [0.62, 0.72, 0.86],
    exposure: 1,
    lamps: [
      lamp(38, 52, 5.6, 5.1, 4.3),
      lamp(-70, 30, 0.8, 1.0, 1.35),
      lamp(180, 35, 1.2, 1.4, 1.7),
      lamp(100, 10, 0.5, 0.5, 0.45),
    ],
  },
  evening: {
    label: "Low sun",
    withCamera: false,
    ambient: [0.26, 0.27, 0.38],
    exposure: 1,
    lamps: [
      lamp(-152, 18, 9.0, 5.6, 2.9),
      lamp(40, 25, 0.8, 0.9, 1.3),
      lamp(-60, 20, 1.5, 1.0, 0.6),
      lamp(150, 40, 1.2, 1.1, 1.5),
    ],
  },
  flat: {
    label: "Even",
    withCamera: true,
    ambient: [1.1, 1.1, 1.1],
    exposure: 1,
    lamps: [
      lamp(-20, 40, 2.2, 2.2, 2.2),
      lamp(60, 20, 1.2, 1.2, 1.2),
      lamp(160, 30, 0.8, 0.8, 0.8),
      lamp(-160, 30, 0.8, 0.8, 0.8),
    ],
  },
};

export class Lights {
  preset: Preset = PRESETS["studio"];
  /** Angle by which all lamps are turned about the vertical, to the right [degrees]. */
  turn = 0;
  readonly uniforms = {
    lightFrom: { value: [0, 1, 2, 3].map(() => new Vector3()) },
    lightStrength: { value: [0, 1, 2, 3].map(() => new Vector3()) },
    ambient: { value: new Color() },
    exposure: { value: 1 },
  };

  /** Direction towards the light that casts shadows. */
  get key(): Vector3 {
    return this.uniforms.lightFrom.value[0];
  }

  update(camera: Camera): void {
    const { lamps, ambient, exposure, withCamera } = this.preset;
    // The camera's turn about the vertical and a part of its tilt: lamps stay above the floor.
    const turn = new Matrix4();
    if (withCamera) {
      const back = new Vector3().setFromMatrixColumn(camera.matrixWorld, 2);
      turn.makeRotationY(Math.atan2(back.x, back.z));
    }
    lamps.forEach((one, k) => {
      const [a, e] = [((one.azimuth + this.turn) * Math.PI) / 180, (one.elevation * Math.PI) / 180];
      this.uniforms.lightFrom.value[k]
        .set(Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e))
        .applyMatrix4(turn);
      this.uniforms.lightStrength.value[k].set(...one.strength);
    });
    this.uniforms.ambient.value.setRGB(...ambient);
    this.uniforms.exposure.value = exposure;
  }
}
