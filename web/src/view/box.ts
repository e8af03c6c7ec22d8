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
