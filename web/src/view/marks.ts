// Lines that are drawn over the picture. Their points are from the middle of what the camera sees, to the right and up,
// in heights of it, so that they are in place in a picture of any size.

import type { Box } from "./box";

export type Stroke = [number, number][];

const HEAD = 0.035; // length of the head of an arrow
const NEAREST = 0.003; // distance from which a point of a line is kept

/** The point of the pointer in heights of the picture. */
export function fromPixels(at: { x: number; y: number }, { x, y, width, height }: Box): [number, number] {
  const round = (value: number) => Number(value.toFixed(4));
  return [round((at.x - x - width / 2) / height), round((y + height / 2 - at.y) / height)];
}

export function toPixels([right, up]: [number, number], { x, y, width, height }: Box): { x: number; y: number } {
  return { x: x + width / 2 + right * height, y: y + height / 2 - up * height };
}

/** An arrow as one line: its shaft, and both sides of its head. */
export function arrow(from: [number, number], to: [number, number]): Stroke {
  const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
  const side = (turn: number): [number, number] => [
    Number((to[0] - HEAD * Math.cos(angle + turn)).toFixed(4)),
    Number((to[1] - HEAD * Math.sin(angle + turn)).toFixed(4)),
  ];
  return [from, to, side(0.45), to, side(-0.45)];
}

/** Whether a point is far enough from the last one of a line to be kept. */
export function isNew(stroke: Stroke, [x, y]: [number, number]): boolean {
  const last = stroke[stroke.length - 1];
  return !last || Math.hypot(x - last[0], y - last[1]) > NEAREST;
}

/** Draws lines into a picture. */
export function paintStrokes(context: CanvasRenderingContext2D, strokes: Stroke[], picture: Box): void {
  context.lineJoin = context.lineCap = "round";
  for (const [width, color] of [
    [0.01, "rgb(0 0 0 / 0.55)"],
    [0.006, "#ffb45e"],
  ] as const) {
    context.lineWidth = width * picture.height;
    context.strokeStyle = color;
    for (const stroke of strokes) {
      context.beginPath();
      stroke.forEach((point, k) => {
        const { x, y } = toPixels(point, picture);
        if (k) context.lineTo(x, y);
        else context.moveTo(x, y);
      });
      context.stroke();
    }
  }
}
