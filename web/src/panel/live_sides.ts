// Looks that are compared while hair moves live: the rods of each come from the server, which moves all heads alike.

import { Vector3 } from "three";
import type { Model } from "../model";
import type { LiveStep } from "../protocol";
import type { Side } from "../view/looks";
import { headOf, Rods, sameStep } from "../view/rods";
import type { Viewer } from "../view/viewer";

/** One look in live motion. */
interface Moving {
  rods: Rods;
  step: LiveStep | null;
  shown: LiveStep | null;
}

export class LiveSides {
  private readonly moving = new Map<Side, Moving>();
  private waiting = false;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
  ) {
    model.hear("rods", (message) => {
      if (message.side !== "a") this.moving.set(message.side, { rods: new Rods(message), step: null, shown: null });
    });
    model.hear("live_step", (step) => this.take(step));
    for (const topic of ["live", "compared"] as const) model.on(topic, () => this.forget());
    for (const kind of ["locks", "hairs", "body"] as const)
      model.hear(kind, () => {
        for (const one of this.moving.values()) one.shown = null; // they came at rest
        this.show();
      });
  }

  /** Looks that are no longer compared, or no longer move. */
  private forget(): void {
    const { live, compared } = this.model;
    for (const side of [...this.moving.keys()])
      if (!live.on || !compared[side] || compared[side].take) {
        this.moving.delete(side);
        if (!compared[side]?.take) this.viewer.putAtRest(side);
      }
  }

  private take(step: LiveStep): void {
    const one = this.moving.get(step.side);
    if (!one || one.rods.message.key !== step.key) return;
    one.step = step;
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.show();
    });
  }

  private show(): void {
    for (const [side, one] of this.moving) {
      const { rods, step, shown } = one;
      if (!step || (shown && sameStep(step, shown))) continue;
      one.shown = step;
      const pose = { head: headOf(step), trunk: new Vector3(...step.trunk), pivot: new Vector3(...rods.message.pivot) };
      this.viewer.carry(rods, step.points, pose, step.worn, side);
    }
  }
}
