// The handle of the head while hair moves live: dragged, it turns and nods the head, with Shift it moves the body.

import { Vector3 } from "three";
import { h } from "../dom";
import type { Model } from "../model";
import { pixelsPerMetre } from "../view/pick";
import type { Viewer } from "../view/viewer";

const ABOVE = 18; // of the hair [pixels]
const SEND_AFTER = 16; // time between two poses that are sent [ms]
const TURN = 0.008; // of a pixel [radians]
const FARTHEST = { turn: 1.5, shift: 0.5 }; // [radians], [m]
const BY_KEY = 60; // pixels that an arrow key stands for
const ARROWS: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

type Triple = [number, number, number];

export class HeadHandle {
  readonly element = h("button", {
    ...{ type: "button", class: "head-handle", hidden: true, "aria-label": "Head: drag to turn and nod it, with Shift to move it" },
    title: "Drag to turn and nod the head, with Shift to move it; let go, it springs back. Arrow keys turn it too.",
  });
  private from: { x: number; y: number } | null = null;
  private pose: { turn: Triple; shift: Triple } | null = null;
  private sent: unknown = null;
  private timer = 0;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    /** Whether a tool has the pointer: the handle would be in its way. */
    private readonly busy: () => boolean,
  ) {
    const { element } = this;
    element.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      element.setPointerCapture(event.pointerId);
      this.from = { x: event.clientX, y: event.clientY };
      element.classList.add("held");
      event.stopPropagation();
    });
    element.addEventListener("pointermove", (event) => {
      if (this.from) this.drag(event.clientX - this.from.x, event.clientY - this.from.y, event.shiftKey);
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"] as const) element.addEventListener(end, () => this.letGo());
    element.addEventListener("keydown", (event) => {
      const arrow = ARROWS[event.key];
      if (!arrow) return;
      event.preventDefault();
      event.stopPropagation();
      this.drag(BY_KEY * arrow[0], BY_KEY * arrow[1], event.shiftKey);
    });
    element.addEventListener("keyup", (event) => ARROWS[event.key] && this.letGo());
    for (const topic of ["live", "role"] as const) model.on(topic, () => this.place());
  }

  /** Puts the handle over the head. */
  place(): void {
    const { element, viewer, model } = this;
    const { box } = viewer.hair.a;
    const at = box.isEmpty() ? null : viewer.seenAt(box.getCenter(new Vector3()).setY(box.max.y));
    element.hidden = !model.live.fps || !model.role.leads || !at || this.busy();
    if (!at || element.hidden) {
      this.letGo();
      return;
    }
    element.style.translate = `${at.x}px ${Math.max(at.y - ABOVE, ABOVE)}px`;
  }

  /** The head goes with the hand, as it is seen from the camera. */
  private drag(right: number, down: number, moves: boolean): void {
    const { camera, size, controls } = this.viewer;
    const [across, up] = [0, 1].map((k) => new Vector3().setFromMatrixColumn(camera.matrixWorld, k));
    const metre = pixelsPerMetre(controls.target, camera, size.height);
    const none: Triple = [0, 0, 0];
    const turn = up.clone().multiplyScalar(TURN * right).addScaledVector(across, TURN * down).clampLength(0, FARTHEST.turn);
    const shift = across.clone().multiplyScalar(right / metre).addScaledVector(up, -down / metre).clampLength(0, FARTHEST.shift);
    this.pose = moves ? { turn: none, shift: shift.toArray() } : { turn: turn.toArray(), shift: none };
    if (!this.timer) this.send();
  }

  /** The newest pose, at most one in some time. */
  private send(): void {
    if (!this.pose) return;
    this.model.link?.whisper({ kind: "hold_head", ...this.pose });
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      const { pose } = this;
      if (pose && pose !== this.sent) this.send();
    }, SEND_AFTER);
    this.sent = this.pose;
  }

  private letGo(): void {
    this.from = null;
    this.element.classList.remove("held");
    if (!this.pose) return;
    this.pose = null;
    this.model.link?.whisper({ kind: "hold_head", turn: null });
  }
}
