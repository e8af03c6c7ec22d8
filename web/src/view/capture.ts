// Pictures and movies of what is seen, as files.

import type { Viewer } from "./viewer";

export function keep(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** A small picture of the open look alone. */
export function thumbnail(viewer: Viewer): HTMLCanvasElement {
  let picture!: HTMLCanvasElement;
  viewer.withView(() => (picture = viewer.drawAt(400, 250, false)));
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
    this.recorder = new MediaRecorder(this.viewer.canvas.captureStream(30), {
      mimeType,
      videoBitsPerSecond: 12e6,
    });
    this.recorder.ondataavailable = (event) => this.parts.push(event.data);
    this.recorder.start(500);
    this.viewer.compose(true);
  }

  stop(name: string): void {
    const recorder = this.recorder;
    this.recorder = null;
    if (!recorder) return;
    this.viewer.compose(false);
    recorder.onstop = () => {
      const type = recorder.mimeType.split(";")[0];
      keep(new Blob(this.parts, { type }), `${name}.${type.endsWith("mp4") ? "mp4" : "webm"}`);
    };
    recorder.stop();
  }
}
