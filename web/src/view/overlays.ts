// What can be laid over the hair, and what its colours say.

import type { Frame, Measured } from "../protocol";

export type OverlayName = "depth" | "pin" | "stretch" | "contact" | "curl";

export interface Overlay {
  label: string;
  low: string;
  high: string;
  diverging: boolean;
  moving: boolean; // only frames have it
}

export const OVERLAYS: Record<OverlayName, Overlay> = {
  depth: { label: "inside the head", low: "outside", high: "2 mm deep", diverging: false, moving: false },
  pin: { label: "pins", low: "free", high: "held", diverging: false, moving: false },
  stretch: { label: "stretch", low: "2 % shorter", high: "2 % longer", diverging: true, moving: true },
  contact: { label: "contacts", low: "untouched", high: "pressed", diverging: false, moving: true },
  curl: { label: "curl loss", low: "as groomed", high: "straight", diverging: false, moving: true },
};

/** The values of an overlay: of the frame that is seen, or else of the groom at rest. */
export function overlayValues(name: OverlayName | "", frame: Frame | undefined, still: Measured | null) {
  if (name === "") return undefined;
  if (name === "pin") return still?.pin;
  if (name === "depth") return frame ? frame.depth : still?.depth;
  return frame?.[name];
}
