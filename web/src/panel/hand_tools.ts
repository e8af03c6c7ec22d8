// The tools in the hand: sculpting, painting and drawing, of which one is taken up at a time.

import type { Model } from "../model";
import type { Viewer } from "../view/viewer";
import { BrushTool } from "./brush";
import { DrawTool } from "./draw";
import type { HandTool } from "./hand_tool";
import { LiveHand } from "./live_hand";
import { PaintTool } from "./paint";

export class HandTools {
  readonly brush: BrushTool;
  readonly paint: PaintTool;
  readonly draw: DrawTool;
  readonly hand: LiveHand;
  private readonly all: HandTool[];

  /** taken: called when one is taken up */
  constructor(model: Model, viewer: Viewer, taken: () => void) {
    this.brush = new BrushTool(model, viewer);
    this.paint = new PaintTool(model, viewer, this.brush.ring);
    this.draw = new DrawTool(model, viewer);
    this.hand = new LiveHand(model, viewer, this.brush.ring);
    model.paint = (place, label) => this.paint.paint(place, label);
    model.draw = (place, label) => this.draw.draw(place, label);
    this.all = [this.brush, this.paint, this.draw, this.hand];
    for (const tool of this.all)
      tool.changed.push((on) => {
        if (!on) return;
        for (const other of this.all) if (other !== tool) other.show(false);
        taken();
      });
  }

  /** Their panels. */
  get elements(): HTMLElement[] {
    return this.all.map(({ element }) => element);
  }

  /** Whether one of them has the pointer. */
  get busy(): boolean {
    return this.all.some(({ on }) => on);
  }

  /** Lays down the one that is in the hand. */
  layDown(): void {
    for (const tool of this.all) tool.show(false);
  }
}
