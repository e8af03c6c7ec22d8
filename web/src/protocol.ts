// Made by tools/make_protocol.py from python/ringlet/viewer/protocol; change it there.

export const VERSION = 8;
export type Json = string | number | boolean | null | Json[] | { [key: string]: Json };

/** A stage of the groom. place: path of its settings in the recipe. */
export interface Stage {
  name: string;
  op: string;
  place: (string | number)[];
  muted: boolean;
  solo: boolean;
}

/** A line of the diff against the saved file. */
export interface Change {
  sign: "+" | "-" | " ";
  line: string;
}

/** A remedy of a problem: a button, and the message of the page that it sends. */
export interface Fix {
  label: string;
  message: Record<string, Json>;
}

/** A setting of a file whose value on disk (theirs) differs from that of the session (mine). */
export interface Difference {
  name: string;
  base: string;
  mine: string;
  theirs: string;
  both: boolean;
}

/** What stands in the way, until it is gone. */
export interface Problem {
  subject: string;
  message: string;
  file: "recipe" | "shot";
  setting: string;
  fixes: Fix[];
  differences: Difference[];
}

/** A preset. whole: whether it is a look, which replaces all tables; picture: data URL, empty for none */
export interface Preset {
  name: string;
  title: string;
  about: string;
  whole: boolean;
  picture: string;
}

/** First message of a page. */
export interface Hello {
  kind: "hello";
  version: number;
  client: string;
  leads?: boolean;
}

/** Requests the edit lock; a page that holds it is asked, and hands it over after a while without an answer. */
export interface Lead {
  kind: "lead";
}

/** Sets values of settings, in TOML notation; None removes a setting, so that its default applies. */
export interface Set {
  kind: "set";
  file?: "recipe" | "shot";
  changes: ([(string | number)[], Json])[];
  gesture: number;
  resting?: boolean;
}

/** Adds, removes or moves a shape operator of the recipe. */
export interface Arrange {
  kind: "arrange";
  action: "add" | "remove" | "move";
  at: number;
  to?: number;
  op?: string;
  values?: Record<string, string>;
}

/** Chooses the one of several grooms whose settings are shown and changed. */
export interface Choose {
  kind: "choose";
  groom: string;
}

/** Mutes stages such as ``shape/0`` or ``curl``; not stored in the file. */
export interface Mute {
  kind: "mute";
  stages: string[];
  solo?: string;
}

/** Undoes, redoes or reverts changes. */
export interface Step {
  kind: "undo" | "redo" | "revert";
}

/** Saves a file; with a name, a copy beside it, or a variant that extends it, which the session then goes on with. */
export interface Save {
  kind: "save";
  file?: "recipe" | "shot";
  name?: string;
  variant?: boolean;
  anyway?: boolean;
}

/** Opens another recipe, shot or USD file of the project in the session. */
export interface Open {
  kind: "open";
  name: string;
  discard?: boolean;
}

/** Resolves a conflict with the version of a file on disk. */
export interface Resolve {
  kind: "resolve";
  file?: "recipe" | "shot";
  choice: "mine" | "theirs" | "merge";
  mine?: string[];
  theirs?: string[];
}

/** Removes a problem that needs no remedy. */
export interface Dismiss {
  kind: "dismiss";
  subject: string;
}

/** Makes a groom that takes much longer than the displayed one. */
export interface Proceed {
  kind: "proceed";
}

/** Cancels the groom that is being made; the displayed one stays. */
export interface Cancel {
  kind: "cancel";
}

/** Restores unsaved text of a page, and of its file of edits, after a restart of the server. */
export interface Restore {
  kind: "restore";
  file?: "recipe" | "shot";
  text: string;
  edits?: string;
  saved?: string;
  saved_edits?: string;
}

/** Shows a second groom for comparison: a snapshot, the saved one, another recipe of the project, or none. */
export interface Compare {
  kind: "compare";
  to: "now" | "saved" | "file" | "none";
  name?: string;
}

/** Drags a point of an isolated lock to a position [m]. */
export interface Drag {
  kind: "drag";
  lock: number;
  point: number;
  to: [number, number, number];
  reach?: number;
  gesture: number;
  resting?: boolean;
}

/** Isolates locks from the procedural groom for manual edits, or returns them. */
export interface Isolate {
  kind: "isolate";
  locks: number[];
  out?: boolean;
}

/** Moves a brush over the guides, or returns guides to the recipe. */
export interface Sculpt {
  kind: "sculpt";
  tool: "grab" | "comb" | "smooth" | "cut" | "lengthen" | "return" | "freeze" | "thaw";
  at: [number, number, number];
  by: [number, number, number];
  radius: number;
  mirrored?: boolean;
  strength?: number;
  falloff?: "smooth" | "sharp" | "flat";
  gesture: number;
  resting?: boolean;
}

/** Removes the sculpts of all guides. */
export interface Unsculpt {
  kind: "unsculpt";
}

/** Requests the map that a setting names, as painted values on the scalp. */
export interface ShowMap {
  kind: "show_map";
  place: (string | number)[];
}

/** Moves a brush over the scalp, which changes the map that a setting names; a setting without one gets a new map. */
export interface Paint {
  kind: "paint";
  place: (string | number)[];
  tool: "add" | "remove" | "smooth";
  at: [number, number, number];
  by: [number, number, number];
  radius: number;
  mirrored?: boolean;
  strength?: number;
  falloff?: "smooth" | "sharp" | "flat";
  gesture: number;
  resting?: boolean;
}

/** Draws the helper curve that a setting names; a setting without one gets a new curve. */
export interface Draw {
  kind: "draw";
  place: (string | number)[];
  points: [number, number, number][];
  gesture: number;
}

/** Requests the presets, which the page then receives. */
export interface ListPresets {
  kind: "list_presets";
}

/** Shows the groom with a preset, which leaves no trace in the file or in undo; without a name, as it was. */
export interface Try {
  kind: "try";
  name?: string;
  part?: number;
}

/** Takes a preset; all messages of a gesture are one undo step, each relative to the state before it. */
export interface Take {
  kind: "take";
  name: string;
  part?: number;
  gesture: number;
  resting?: boolean;
}

/** Keeps tables of the recipe as a preset of the project. picture: data URL of a JPEG; empty for none */
export interface Keep {
  kind: "keep";
  name: string;
  tables: string[];
  picture?: string;
}

/** Shares the look of the leading page with those that follow. */
export interface Look {
  kind: "look";
  camera: number[];
  light: string;
  color: string;
  overlay: string;
  file: "recipe" | "shot";
  place: (string | number)[];
  locks: number[];
  frame: number | null;
}

/** Answers another page that asks for the edit lock. */
export interface Hand {
  kind: "hand";
  over: boolean;
}

/** Starts, pauses or resumes the simulation, or restarts it from an existing frame. */
export interface Play {
  kind: "play";
  action: "start" | "pause" | "go_on" | "again_from";
  frame?: number;
}

/** Shows the frames of another cache of the project for comparison; an empty name removes them. */
export interface Against {
  kind: "against";
  name?: string;
}

/** Requests frames, the current one first; replaces earlier requests that are still pending. */
export interface Watch {
  kind: "watch";
  shot?: number[];
  against?: number[];
}

/** First message of the server. */
export interface Welcome {
  kind: "welcome";
  version: number;
  session: string;
  heard: number;
  name: string;
  mode: "recipe" | "shot" | "stage";
  schemas: Record<string, Json>;
  operators: string[];
  recovered: boolean;
  colors: Record<string, [number, number, number, number]>;
}

/** Holder of the edit lock. */
export interface Role {
  kind: "role";
  leads: boolean;
  others: number;
  asked: boolean;
  asks: boolean;
}

/** Names of the recipes and caches of the project; sent again when they change. */
export interface Files {
  kind: "files";
  names: string[];
}

/** Current state of a file. */
export interface Document {
  kind: "document";
  file: "recipe" | "shot";
  name: string;
  revision: number;
  text: string;
  edits: string;
  saved: string;
  saved_edits: string;
  said: Record<string, Json>;
  values: Record<string, Json>;
  stages: Stage[];
  grooms: string[];
  groom: string;
  dirty: boolean;
  undo: boolean;
  redo: boolean;
  changes: Change[];
}

/** A mesh of the scene. made_of: its material: skin, eye, cloth or matte. */
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

/** Positions of the locks. side: a, or b for the groom to compare with. */
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

/** Positions of the guides; ``changed`` is 1 for sculpted ones, ``frozen`` for those that brushes leave. */
export interface Guides {
  kind: "guides";
  middle: [number, number, number];
  points: Float32Array;
  offsets: Int32Array;
  changed: Uint8Array;
  frozen: Uint8Array;
}

/** Valid names in settings: regions, maps and directions of the scalp, and helper curves. */
export interface Names {
  kind: "names";
  regions: string[];
  maps: string[];
  vectors: string[];
  curves: string[];
}

/** Hairs relative to their locks; see ``src/ringlet/groom/hairs.h`` for the formula. */
export interface Hairs {
  kind: "hairs";
  side: "a" | "b";
  count: number;
  points: number;
  knots: number;
  lock: Uint32Array;
  group: Uint8Array;
  offset: Float32Array;
  tip: Float32Array;
  join: Float32Array;
  flat: Float32Array;
  taper: Float32Array;
  other: Int32Array;
  share: Float32Array;
  frizz: Float32Array;
  root: Float32Array;
  profile: Float32Array;
  hold: Float32Array;
  pace: Float32Array;
  blend: Float32Array;
  width: Float32Array;
  thinning: Float32Array;
  window: Int32Array;
  slip: Float32Array;
  escape: Float32Array;
  relax: Float32Array;
  family: Float32Array;
  coil: Float32Array;
  phase: Float32Array;
  escaping: Float32Array;
  relaxing: Float32Array;
  tight: Float32Array;
  opening: Float32Array;
}

/** Colours of the hairs, in the order of ``Hairs``; none where the groom has no colour. */
export interface Colors {
  kind: "colors";
  side: "a" | "b";
  stations: number;
  roughness: number;
  tilt: number;
  reflectance: Uint8Array;
}

/** Statistics of the groom. revision: of the displayed recipe; times: times of the computed stages [ms]. */
export interface Numbers {
  kind: "numbers";
  revision: number;
  locks: number;
  hairs: number;
  groom_ms: number;
  times: Record<string, number>;
  draft: boolean;
}

/** Measurements of a groom that is not a draft. inside: number of lock points in the head. */
export interface Measured {
  kind: "measured";
  inside: number;
  depth: Uint8Array;
  nail: Uint8Array;
}

/** A frame of the shot or of a cache. layer: ``shot``, or ``against`` for the cache to compare with. */
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

/** State of the simulation, and the existing frames of the shot and of the cache to compare with. */
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
  runs: Int32Array;
  stale: Uint8Array;
}

/** Name of the groom or cache to compare with; empty for none. */
export interface Compared {
  kind: "compared";
  name: string;
}

/** Number of messages that the server has handled for pages of this name. */
export interface Heard {
  kind: "heard";
  count: number;
}

/** A file was written. */
export interface Saved {
  kind: "saved";
  name: string;
}

/** A short message of what has happened. */
export interface Notice {
  kind: "notice";
  message: string;
}

/** The look of the leading page. */
export interface Followed {
  kind: "followed";
  camera: number[];
  light: string;
  color: string;
  overlay: string;
  file: "recipe" | "shot";
  place: (string | number)[];
  locks: number[];
  frame: number | null;
}

/** An error message of one line, for a request that was refused. */
export interface Trouble {
  kind: "trouble";
  message: string;
}

/** All problems of the session. */
export interface Problems {
  kind: "problems";
  problems: Problem[];
}

/** Progress of a groom that takes long. done: fraction of the stage; an empty stage ends it. */
export interface Progress {
  kind: "progress";
  stage: string;
  done: number;
}

/** The presets of the project, then the looks that come with Ringlet. */
export interface Presets {
  kind: "presets";
  presets: Preset[];
}

/** A map on the scalp: its value at each point of the mesh of the region, 255 for white. */
export interface Painted {
  kind: "painted";
  map: string;
  points: Float32Array;
  triangles: Uint32Array;
  values: Uint8Array;
}

export type FromPage =
  | Hello
  | Lead
  | Set
  | Arrange
  | Choose
  | Mute
  | Step
  | Save
  | Open
  | Resolve
  | Dismiss
  | Proceed
  | Cancel
  | Restore
  | Compare
  | Drag
  | Isolate
  | Sculpt
  | Unsculpt
  | ShowMap
  | Paint
  | Draw
  | ListPresets
  | Try
  | Take
  | Keep
  | Look
  | Hand
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
  | Colors
  | Numbers
  | Measured
  | Frame
  | Timeline
  | Compared
  | Heard
  | Saved
  | Notice
  | Followed
  | Trouble
  | Problems
  | Progress
  | Presets
  | Painted;
