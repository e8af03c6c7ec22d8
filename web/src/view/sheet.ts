// A sheet of a look: five angles in a row, and below them what the open notes are about, with their lines and text.

import { Vector3 } from "three";
import type { Note } from "../protocol";
import type { Size } from "./box";
import { paintStrokes } from "./marks";
import { onScreen } from "./pick";
import type { Viewer } from "./viewer";

const ANGLES: [string, number, number][] = [
  ["Front", 0, 4],
  ["Three-quarter", 34, 6],
  ["Left", 90, 4],
  ["Right", -90, 4],
  ["Back", 180, 8],
];
const CELL: Size = { width: 480, height: 520 };
const NOTE: Size = { width: 480, height: 360 };
const GAP = 12;
const LINE = 22; // height of a line of text [pixels]
const LINES = 5; // of a note, at most; the rest is in its file
const FONT = "15px system-ui, sans-serif";

/** Draws the sheet. The camera and the arrangement of looks are as before when it is done. */
export function sheet(viewer: Viewer, notes: Note[], title: string, file: string): HTMLCanvasElement {
  const open = notes.filter(({ resolved }) => !resolved);
  const rows = Math.ceil(open.length / ANGLES.length);
  const canvas = document.createElement("canvas");
  canvas.width = GAP + ANGLES.length * (CELL.width + GAP);
  canvas.height = 60 + CELL.height + LINE + GAP + rows * (NOTE.height + (LINES + 1) * LINE + GAP);
  const context = canvas.getContext("2d")!;
  context.fillStyle = "#191817";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = "#ece7e0";
  context.font = `600 22px system-ui, sans-serif`;
  context.fillText(title, GAP, 38);
  context.font = FONT;
  context.fillStyle = "#a49d94";
  context.textAlign = "right";
  context.fillText(`${file} · ${new Date().toLocaleString()}`, canvas.width - GAP, 38);
  context.textAlign = "left";
  const x = (k: number) => GAP + (k % ANGLES.length) * (CELL.width + GAP);
  viewer.withView(() => {
    ANGLES.forEach(([label, azimuth, elevation], k) => {
      viewer.frame(azimuth, elevation, CELL);
      context.drawImage(viewer.drawAt(CELL.width, CELL.height, false), x(k), 60);
      context.fillText(label, x(k) + 4, 60 + CELL.height + LINE - 4);
    });
    open.forEach((note, k) => {
      const y = 60 + CELL.height + LINE + GAP + Math.floor(k / ANGLES.length) * (NOTE.height + (LINES + 1) * LINE + GAP);
      viewer.lookFrom(note.look.camera, note.look.focal_length);
      const picture = viewer.drawAt(NOTE.width, NOTE.height, false);
      mark(picture, viewer, note, String(notes.indexOf(note) + 1));
      context.drawImage(picture, x(k), y);
      context.fillStyle = "#a49d94";
      context.fillText([`${notes.indexOf(note) + 1}`, note.author, note.time.slice(0, 10)].filter(Boolean).join(" · "), x(k) + 4, y + NOTE.height + LINE - 4);
      context.fillStyle = "#ece7e0";
      wrap(context, note.text, NOTE.width - 8).slice(0, LINES).forEach((line, row) => {
        context.fillText(line, x(k) + 4, y + NOTE.height + (row + 2) * LINE - 4);
      });
    });
  });
  return canvas;
}

/** Draws the lines of a note, and the place that it is pinned to. */
function mark(picture: HTMLCanvasElement, viewer: Viewer, note: Note, number: string): void {
  const context = picture.getContext("2d")!;
  paintStrokes(context, note.strokes, { x: 0, y: 0, ...NOTE });
  if (!note.at) return;
  const { camera } = viewer;
  const aspect = camera.aspect;
  camera.clearViewOffset();
  camera.aspect = NOTE.width / NOTE.height;
  camera.updateProjectionMatrix();
  const { x, y } = onScreen(new Vector3(...note.at), camera, NOTE);
  camera.aspect = aspect;
  context.beginPath();
  context.arc(x, y, 11, 0, 2 * Math.PI);
  context.fillStyle = "rgb(28 27 26 / 0.93)";
  context.fill();
  context.strokeStyle = "#ffb45e";
  context.lineWidth = 2;
  context.stroke();
  context.fillStyle = "#ece7e0";
  context.font = FONT;
  context.textAlign = "center";
  context.fillText(number, x, y + 5);
}

/** Lines of a text that fit a width. */
function wrap(context: CanvasRenderingContext2D, text: string, width: number): string[] {
  const lines: string[] = [];
  for (const part of text.split("\n")) {
    let line = "";
    for (const word of part.split(" ")) {
      const longer = line ? `${line} ${word}` : word;
      if (line && context.measureText(longer).width > width) {
        lines.push(line);
        line = word;
      } else line = longer;
    }
    lines.push(line);
  }
  return lines;
}
