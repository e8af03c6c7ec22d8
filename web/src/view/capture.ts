// Pictures and movies of what is seen, as files.

import type { Viewer } from "./viewer";

export function keep(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** A picture of any size; a clear one has no wall, and is transparent there. */
export function still(viewer: Viewer, width: number, height: number, clear: boolean): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [width, height];
  const context = canvas.getContext("2d", { willReadFrequently: clear })!;
  if (!clear) {
    viewer.drawAt(width, height, (drawn) => context.drawImage(drawn, 0, 0));
    return canvas;
  }
  // What is before a wall differs from white to black by the light that passes.
  const [black, white] = ["#000000", "#ffffff"].map((wall) => {
    viewer.drawAt(width, height, (drawn) => context.drawImage(drawn, 0, 0), wall);
    return context.getImageData(0, 0, width, height);
  });
  const { data } = black;
  for (let i = 0; i < data.length; i += 4) {
    const passed = Math.max(...[0, 1, 2].map((c) => white.data[i + c] - data[i + c])) / 255;
    const alpha = Math.min(1, Math.max(0, 1 - passed));
    for (let c = 0; c < 3; c++) data[i + c] = alpha > 0 ? Math.min(255, data[i + c] / alpha) : 0;
    data[i + 3] = Math.round(255 * alpha);
  }
  context.putImageData(black, 0, 0);
  return canvas;
}

/** A small picture of the open look alone. */
export function thumbnail(viewer: Viewer): HTMLCanvasElement {
  let picture!: HTMLCanvasElement;
  viewer.withView(() => (picture = still(viewer, 400, 250, false)));
  return picture;
}

/** Records what is drawn until it is stopped. */
export class Recorder {
  private recorder: MediaRecorder | null = null;
  private parts: Blob[] = [];

  constructor(private readonly viewer: Viewer) {}

  get running(): boolean {
    return this.recorder !== null;
  }

  start(): void {
    const types = ["video/mp4;codecs=avc1", "video/webm;codecs=vp9", "video/webm"];
    const mimeType = types.find((type) => MediaRecorder.isTypeSupported(type));
    this.parts = [];
    this.recorder = new MediaRecorder(this.viewer.renderer.domElement.captureStream(30), {
      mimeType,
      videoBitsPerSecond: 12e6,
    });
    this.recorder.ondataavailable = (event) => this.parts.push(event.data);
    this.recorder.start(500);
    this.viewer.move();
  }

  stop(name: string): void {
    const recorder = this.recorder;
    this.recorder = null;
    if (!recorder) return;
    recorder.onstop = () => {
      const type = recorder.mimeType.split(";")[0];
      keep(new Blob(this.parts, { type }), `${name}.${type.endsWith("mp4") ? "mp4" : "webm"}`);
    };
    recorder.stop();
  }
}
