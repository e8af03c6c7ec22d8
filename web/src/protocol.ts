// Made by tools/make_protocol.py from python/ringlet/viewer/protocol.py; change it there.

export const VERSION = 6;
export type Json = string | number | boolean | null | Json[] | { [key: string]: Json };

/** A stage of the groom. place: where its settings are in the recipe. */
export interface Stage {
  name: string;
  op: string;
  place: (string | number)[];
  muted: boolean;
}

/** A line of the file that is not as it was saved. */
export interface Change {
  sign: "+" | "-" | " ";
  line: string;
}

/** The first message: who is there. ``client`` is a name that a page keeps when it comes back. */
export interface Hello {
  kind: "hello";
  version: number;
  client: string;
}

/** Asks to be the one who edits. */
export interface Lead {
  kind: "lead";
}

/** Gives settings new values, as TOML would say them; None takes a setting out, so that its default holds. */
export interface Set {
  kind: "set";
  file?: "recipe" | "shot";
  changes: ([(string | number)[], Json])[];
  gesture: number;
  resting?: boolean;
}

/** Adds, removes or moves an operator of the recipe's shape. */
export interface Arrange {
  kind: "arrange";
  action: "add" | "remove" | "move";
  at: number;
  to?: number;
  op?: string;
}

/** Says which stages have no effect for now: ``shape/0``, ``curl`` …; not kept in the file. */
export interface Mute {
  kind: "mute";
  stages: string[];
}

/** Goes back or forth in what was done. */
export interface Step {
  kind: "undo" | "redo" | "revert";
}

/** Writes a file. With a name it is a new one beside the old: a copy, or a variant that extends it. */
export interface Save {
  kind: "save";
  file?: "recipe" | "shot";
  name?: string;
  variant?: boolean;
}

/** Gives back a text that a page still had when the server was started anew, and that of its file of edits. */
export interface Restore {
  kind: "restore";
  file?: "recipe" | "shot";
  text: string;
  edits?: string;
}

/** Shows another look beside this one: as it is now, as saved, or another recipe of the project, or none. */
export interface Compare {
  kind: "compare";
  to: "now" | "saved" | "file" | "none";
  name?: string;
}

/** Moves points of an isolated lock by hand [m]. Its shape becomes the lock's own. */
export interface Drag {
  kind: "drag";
  lock: number;
  point: number;
  to: [number, number, number];
  reach?: number;
  gesture: number;
  resting?: boolean;
}

/** Takes locks out of the procedural to be edited by hand, or returns them. */
export interface Isolate {
  kind: "isolate";
  locks: number[];
  out?: boolean;
}

/** Moves a brush over the guides, or gives them back to the recipe. */
export interface Sculpt {
  kind: "sculpt";
  tool: "grab" | "comb" | "smooth" | "cut" | "lengthen" | "return";
  at: [number, number, number];
  by: [number, number, number];
  radius: number;
  mirrored?: boolean;
  gesture: number;
  resting?: boolean;
}

/** Gives all guides back to the recipe. */
export interface Unsculpt {
  kind: "unsculpt";
}

/** Runs the shot: from its start, on from where it was held, or again from a frame that is there already. */
export interface Play {
  kind: "play";
  action: "start" | "pause" | "go_on" | "again_from";
  frame?: number;
}

/** Lays the frames of another cache of the project under the shot, to compare; no name takes it away. */
export interface Against {
  kind: "against";
  name?: string;
}

/** Asks for frames, the one that is looked at first, in place of those that were asked for and have not come yet. */
export interface Watch {
  kind: "watch";
  shot?: number[];
  against?: number[];
}

/** What a page needs to know before anything else. */
export interface Welcome {
  kind: "welcome";
  version: number;
  session: string;
  heard: number;
  name: string;
  mode: "recipe" | "shot" | "stage";
  schemas: Record<string, Json>;
  operators: string[];
  pigments: Record<string, [number, number, number]>;
}

/** Who edits. ``others`` is the number of other pages that look at the session. */
export interface Role {
  kind: "role";
  leads: boolean;
  others: number;
}

/** What there is in the project to compare with, by name: recipes and caches. Told again when others are there. */
export interface Files {
  kind: "files";
  names: string[];
}

/** A file as it stands. */
export interface Document {
  kind: "document";
  file: "recipe" | "shot";
  name: string;
  revision: number;
  text: string;
  edits: string;
  said: Record<string, Json>;
  values: Record<string, Json>;
  stages: Stage[];
  dirty: boolean;
  undo: boolean;
  redo: boolean;
  changes: Change[];
}

/** A mesh of the scene, as the eye sees it. made_of: skin, eye, cloth or matte. */
export interface Body {
  kind: "body";
  index: number;
  name: string;
  made_of: string;
  color: [number, number, number];
  points: Float32Array;
  triangles: Uint32Array;
  colors: Float32Array;
}

/** Where the locks are. side: a, or b for the look beside it. */
export interface Locks {
  kind: "locks";
  side: "a" | "b";
  draft: boolean;
  points: Float32Array;
  offsets: Int32Array;
  ids: Float64Array;
  axis: Float32Array;
  marked: Uint8Array;
}

/** Where the guides are; ``changed`` is 1 for those that were sculpted by hand. */
export interface Guides {
  kind: "guides";
  middle: [number, number, number];
  points: Float32Array;
  offsets: Int32Array;
  changed: Uint8Array;
}

/** What settings may name: regions, maps and directions of the scalp, and helper curves. */
export interface Names {
  kind: "names";
  regions: string[];
  maps: string[];
  vectors: string[];
  curves: string[];
}

/** How hairs sit in their locks; see ``src/ringlet/groom/hairs.h`` for the formula. */
export interface Hairs {
  kind: "hairs";
  side: "a" | "b";
  count: number;
  points: number;
  knots: number;
  lock: Uint32Array;
  offset: Float32Array;
  tip: Float32Array;
  taper: Float32Array;
  other: Int32Array;
  share: Float32Array;
  frizz: Float32Array;
  root: Float32Array;
  profile: Float32Array;
  hold: Float32Array;
  blend: Float32Array;
  width: Float32Array;
  thinning: Float32Array;
}

/** What to keep in sight. revision: of the recipe that is shown; times: of the stages that were computed [ms]. */
export interface Numbers {
  kind: "numbers";
  revision: number;
  locks: number;
  hairs: number;
  groom_ms: number;
  times: Record<string, number>;
  draft: boolean;
}

/** What is only measured at rest. inside: points of locks that are in the head. */
export interface Measured {
  kind: "measured";
  inside: number;
  depth: Uint8Array;
  nail: Uint8Array;
}

/** A frame of the shot or of a cache. layer: ``shot``, or ``against`` for the cache that it is compared with. */
export interface Frame {
  kind: "frame";
  layer: "shot" | "against";
  frame: number;
  statistics: Record<string, Json>;
  points: Float32Array;
  axis: Float32Array;
  root: Float32Array;
  drawn: Uint32Array;
  left: Uint8Array;
  bodies: Float32Array;
  stretch: Uint8Array;
  contact: Uint8Array;
  depth: Uint8Array;
  curl: Uint8Array;
}

/** What the simulation does, and which frames there are to see: of the shot, and of the cache beside it. */
export interface Timeline {
  kind: "timeline";
  first: number;
  last: number;
  fps: number;
  state: "none" | "still" | "rolling" | "running" | "paused" | "done";
  rolled: number;
  preroll: number;
  key: number;
  against: string;
  frames: Float64Array;
  beside: Float64Array;
}

/** What is shown beside the look that is edited; nothing for no name. */
export interface Compared {
  kind: "compared";
  name: string;
}

/** How many messages of a page of this name were heard: what they asked for was done, begun or refused. */
export interface Heard {
  kind: "heard";
  count: number;
}

/** A file was written. */
export interface Saved {
  kind: "saved";
  name: string;
}

/** Something that cannot be, in one line. */
export interface Trouble {
  kind: "trouble";
  message: string;
}

export type FromPage =
  | Hello
  | Lead
  | Set
  | Arrange
  | Mute
  | Step
  | Save
  | Restore
  | Compare
  | Drag
  | Isolate
  | Sculpt
  | Unsculpt
  | Play
  | Against
  | Watch;

export type FromServer =
  | Welcome
  | Role
  | Files
  | Document
  | Body
  | Locks
  | Guides
  | Names
  | Hairs
  | Numbers
  | Measured
  | Frame
  | Timeline
  | Compared
  | Heard
  | Saved
  | Trouble;
