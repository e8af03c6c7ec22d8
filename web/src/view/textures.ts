// Numbers in textures, for the graphics card to look up.

import { DataTexture, FloatType, NearestFilter, RedFormat, RGBAFormat } from "three";

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

/** A share from 0 to 1 for each of so many texels, `WIDTH` a row: all of it but in few rows of the same length. */
export class Shares {
  readonly texture: DataTexture;
  private readonly data: Uint8Array;
  private given: Uint32Array = new Uint32Array();

  constructor(texels: number) {
    const height = Math.max(1, Math.ceil(texels / WIDTH));
    this.data = new Uint8Array(WIDTH * height).fill(255);
    this.texture = new DataTexture(this.data, WIDTH, height, RedFormat);
    this.texture.magFilter = this.texture.minFilter = NearestFilter;
    this.texture.needsUpdate = true;
  }

  /** Gives some rows shares of 255, one after the other, and all others the whole. */
  update(rows: Uint32Array, shares: Uint8Array, length: number): void {
    if (!rows.length && !this.given.length) return;
    for (const row of this.given) this.data.fill(255, row * length, (row + 1) * length);
    rows.forEach((row, i) => {
      this.data.set(shares.subarray(i * length, (i + 1) * length), row * length);
    });
    this.given = rows;
    this.texture.needsUpdate = true;
  }

  dispose(): void {
    this.texture.dispose();
  }
}

/** A colour of three bytes a texel, `WIDTH` texels a row. */
export class Colours {
  readonly texture: DataTexture;

  constructor(values: Uint8Array) {
    const texels = values.length / 3;
    const height = Math.max(1, Math.ceil(texels / WIDTH));
    const data = new Uint8Array(4 * WIDTH * height);
    for (let i = 0; i < texels; i++) data.set(values.subarray(3 * i, 3 * i + 3), 4 * i);
    this.texture = new DataTexture(data, WIDTH, height, RGBAFormat);
    this.texture.magFilter = this.texture.minFilter = NearestFilter;
    this.texture.needsUpdate = true;
  }

  dispose(): void {
    this.texture.dispose();
  }
}
