// The pointer of the page that leads, on the pages of the others: at the place of the scene that it points to.

import { Vector3 } from "three";
import { h } from "../dom";
import type { Model } from "../model";
import { inPlane, onScreen, pick } from "../view/pick";
import type { Viewer } from "../view/viewer";
import { People } from "./people";

const SEND_AFTER = 50; // time between two places that are sent [ms]

export class PresenterPointer {
  readonly element = h("div", { class: "pointer", hidden: true, "aria-hidden": "true" });
  private readonly name = h("span", {});
  private at: Vector3 | null = null;
  private event: PointerEvent | null = null;
  private timer = 0;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
  ) {
    const arrow = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    arrow.setAttribute("viewBox", "0 0 18 18");
    const shape = document.createElementNS("http://www.w3.org/2000/svg", "path");
    shape.setAttribute("d", "M2 2l5 13 2.3-5.2L14.5 7.5z");
    arrow.append(shape);
    this.element.append(arrow, this.name);
    const canvas = viewer.canvas;
    canvas.addEventListener("pointermove", (event) => this.moved(event));
    canvas.addEventListener("pointerleave", () => this.moved(null));
    model.hear("pointer", ({ at }) => this.show(at && new Vector3(...at)));
    model.on("role", () => this.show(this.at));
  }

  /** The page that leads points to a place, or elsewhere. */
  show(at: Vector3 | null): void {
    this.at = this.model.role.leads ? null : at;
    this.name.textContent = People.leader(this.model)?.name ?? "";
    this.place();
  }

  /** Puts the pointer where its place is seen from this camera. */
  place(): void {
    this.element.hidden = !this.at;
    if (!this.at) return;
    const { camera, size } = this.viewer;
    const { x, y } = onScreen(this.at, camera, size);
    this.element.hidden = x < 0 || y < 0 || x > size.width || y > size.height;
    this.element.style.transform = `translate(${x - 2}px, ${y - 2}px)`;
  }

  private moved(event: PointerEvent | null): void {
    const { role, link } = this.model;
    if (!role.leads || role.people.length < 2) return;
    this.event = event;
    this.timer ||= window.setTimeout(() => {
      this.timer = 0;
      link?.whisper({ kind: "point", at: this.event && this.scenePlace(this.event) });
    }, SEND_AFTER);
  }

  /** The hair under the pointer; where there is none, the place as far away as the middle of the picture. */
  private scenePlace(event: PointerEvent): [number, number, number] {
    const { viewer } = this;
    const at = viewer.at(event);
    const { locks } = viewer.hair.a;
    const found = locks && pick(locks.points, locks.offsets, viewer.camera, viewer.size, at);
    const through = new Vector3().copy(viewer.controls.target);
    if (found) through.fromArray(locks.points, 3 * (locks.offsets[found.lock] + found.point));
    return inPlane(at, through, viewer.camera, viewer.size).toArray();
  }
}
