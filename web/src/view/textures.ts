// Numbers in textures, for the graphics card to look up.

import { DataTexture, FloatType, NearestFilter, RGBAFormat } from "three";

export const WIDTH = 2048;

/** Four numbers a texel, `WIDTH` texels a row. */
export class Numbers {
  readonly texture: DataTexture;

  constructor(values: Float32Array) {
    this.texture = new DataTexture(new Float32Array(4 * WIDTH), WIDTH, 1, RGBAFormat, FloatType);
    this.texture.magFilter = this.texture.minFilter = NearestFilter;
    this.update(values);
  }

  /** Takes other numbers; the memory on the card is kept where they are as many. */
  update(values: Float32Array): void {
    const height = Math.max(1, Math.ceil(values.length / (4 * WIDTH)));
    const image = this.texture.image as { data: Float32Array; width: number; height: number };
    if (image.height !== height) {
      this.texture.dispose();
      image.data = new Float32Array(4 * WIDTH * height);
      image.height = height;
    }
    image.data.set(values);
    this.texture.needsUpdate = true;
  }

  dispose(): void {
    this.texture.dispose();
  }
}
