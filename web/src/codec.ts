// Messages as bytes; the same as python/ringlet/viewer/wire.py, which says how.

import type { FromPage, FromServer } from "./protocol";

type Kind = "f4" | "f8" | "i2" | "i4" | "u4" | "u1";

const ARRAYS = {
  f4: Float32Array,
  f8: Float64Array,
  i2: Int16Array,
  i4: Int32Array,
  u4: Uint32Array,
  u1: Uint8Array,
};

export function encode(message: FromPage): ArrayBuffer {
  const text = new TextEncoder().encode(JSON.stringify(message));
  const data = new Uint8Array(4 + text.length);
  new DataView(data.buffer).setUint32(0, text.length, true);
  data.set(text, 4);
  return data.buffer;
}

/** The message; its arrays are views of the data. */
export function decode(data: ArrayBuffer): FromServer {
  const length = new DataView(data).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
  let at = 4 + length;
  for (const [name, kind, size] of header.arrays as [string, Kind, number][]) {
    const Type = ARRAYS[kind];
    header[name] = new Type(data, at, size);
    at += Math.ceil((size * Type.BYTES_PER_ELEMENT) / 8) * 8;
  }
  return header as FromServer;
}
