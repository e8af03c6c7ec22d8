// What draws the picture: WebGL 2, on a graphics card or in software. A browser without it shows a line in its place.

export const NO_PICTURE =
  "No picture: this browser has no WebGL 2. Turn on graphics acceleration in its settings, or use another browser. All else works.";

export const LOST_PICTURE =
  "The picture stands still: the browser has lost the graphics card. Load the page again; the groom and all edits stay.";

/** The context of a canvas; null: there is none. */
export function contextOf(canvas: HTMLCanvasElement): WebGL2RenderingContext | null {
  return canvas.getContext("webgl2", { antialias: false, powerPreference: "high-performance" });
}

export function drawsInSoftware(gl: WebGL2RenderingContext): boolean {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  return /swiftshader|llvmpipe|software/i.test(name);
}

/** Writes on a picture that is kept why there is none. */
export function writeNoPicture(context: CanvasRenderingContext2D): void {
  const { width, height } = context.canvas;
  context.fillStyle = "#191817";
  context.fillRect(0, 0, width, height);
  context.fillStyle = "#ece7e0";
  context.font = `${0.04 * width}px system-ui, sans-serif`;
  context.textAlign = "center";
  context.fillText(NO_PICTURE.split(".")[0], width / 2, height / 2);
}
