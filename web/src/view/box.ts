/** Width and height [pixels]. */
export interface Size {
  width: number;
  height: number;
}

/** A part of the picture, from its top left [pixels]. */
export interface Box extends Size {
  x: number;
  y: number;
}

export function contains({ x, y, width, height }: Box, at: { x: number; y: number }): boolean {
  return at.x >= x && at.y >= y && at.x < x + width && at.y < y + height;
}
