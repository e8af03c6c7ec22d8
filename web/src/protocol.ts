// Made by tools/make_protocol.py from python/ringlet/viewer/protocol; change it there.

export const VERSION = 15;
export type Json = string | number | boolean | null | Json[] | { [key: string]: Json };

/** A stage of the groom. place: path of its settings in the recipe. */
export interface Stage {
  name: string;
  op: string;
  place: (string | number)[];
  muted: boolean;
  solo: boolean;
}

/** An earlier take of the shot, by the number of its last run. */
export interface KeptRun {
  number: number;
  first: number;
  last: number;
  contact: boolean;
  same_groom: boolean;
  changes: string[];
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

/** A person at a connected page. */
export interface Person {
  name: string;
  hue: number;
  leads: boolean;
  follows: boolean;
  you: boolean;
}

/** A round lamp that faces the subject. */
export interface Lamp {
  azimuth: number;
  elevation: number;
  size: number;
  strength: [number, number, number];
  distance: number;
}

/** A light rig: its lamps, around the camera or the subject, and the radiance of the surroundings. */
export interface Rig {
  label: string;
  with_camera: boolean;
  ambient: [number, number, number];
  lamps: Lamp[];
}

/** How the looks that are compared are arranged. */
export interface Arranged {
  arrangement: "split" | "wipe" | "flip" | "difference";
  order: ("a" | "b" | "c" | "d")[];
  front: "a" | "b" | "c" | "d";
  wipe: number;
}

/** How the leading page looks at the groom. */
export interface Shared {
  camera: number[];
  focal_length: number;
  light: string;
  light_turn: number;
  color: string;
  overlay: string;
  file: "recipe" | "shot";
  place: (string | number)[];
  locks: number[];
  frame: number | null;
  looks: Arranged | null;
  step: number | null;
}

/** A snapshot. */
export interface Snapshot {
  id: string;
  author: string;
  note: string;
  time: string;
  look: Shared;
  seconds: number;
}

/** A note; see ``WriteNote``. time: when it was written, in ISO 8601. */
export interface Note {
  id: string;
  author: string;
  text: string;
  time: string;
  resolved: boolean;
  look: Shared;
  at: [number, number, number] | null;
  lock: number | null;
  point: number;
  strokes: [number, number][][];
}

/** Where a reference picture is. */
export interface Placement {
  mode: "off" | "next" | "over";
  opacity: number;
  x: number;
  y: number;
  scale: number;
}

/** A reference picture; ``references/ID`` is its ``Picture``. */
export interface Reference {
  mode: "off" | "next" | "over";
  opacity: number;
  x: number;
  y: number;
  scale: number;
  id: string;
  name: string;
}

/** A camera of the scene: position and target at its first frame [m], and focal length for 36 mm of height [mm]. */
export interface StageCamera {
  name: string;
  camera: number[];
  focal_length: number;
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
  person?: string;
}

/** Names the person of a page. follows: whether the page shows what the leading page looks at. */
export interface Introduce {
  kind: "introduce";
  person?: string;
  follows?: boolean;
}

/** Position of the leading page's pointer in the scene [m]; None where it is elsewhere. */
export interface Point {
  kind: "point";
  at: [number, number, number] | null;
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
  with_copy?: boolean;
}

/** Opens another recipe, shot or USD file of the project in the session. */
export interface Open {
  kind: "open";
  name: string;
  discard?: boolean;
}

/** Lets the shot name the copy of its recipe that was saved last, saves the shot, and goes on with both. */
export interface UseCopy {
  kind: "use_copy";
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

/** Shows another groom on a side: as it is now, as saved, a snapshot, another recipe of the project, or none. */
export interface Compare {
  kind: "compare";
  to: "now" | "saved" | "snapshot" | "file" | "none";
  name?: string;
  side?: "b" | "c" | "d";
}

/** Drags a point of an isolated lock to a position [m]; the move fades over a fraction of the lock, ``falloff``. */
export interface Drag {
  kind: "drag";
  lock: number;
  point: number;
  to: [number, number, number];
  falloff?: number;
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
  at: [number, number, number];
  by: [number, number, number];
  radius: number;
  mirrored?: boolean;
  strength?: number;
  falloff?: "smooth" | "sharp" | "flat";
  gesture: number;
  resting?: boolean;
  tool: "grab" | "comb" | "smooth" | "cut" | "lengthen" | "return" | "freeze" | "thaw";
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
  at: [number, number, number];
  by: [number, number, number];
  radius: number;
  mirrored?: boolean;
  strength?: number;
  falloff?: "smooth" | "sharp" | "flat";
  gesture: number;
  resting?: boolean;
  place: (string | number)[];
  tool: "add" | "remove" | "smooth" | "comb";
}

/** Draws the helper curve that a setting names; a setting without one gets a new curve, a list one more. */
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
  focal_length?: number;
  light: string;
  light_turn?: number;
  color: string;
  overlay: string;
  file: "recipe" | "shot";
  place: (string | number)[];
  locks: number[];
  frame?: number | null;
  looks?: Arranged | null;
  step?: number | null;
}

/** Requests a share page: one file with the look to turn. */
export interface Share {
  kind: "share";
  camera: number[];
  light: string;
  color: string;
  theme?: "dark" | "light";
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

/** Compares the shot with a cache of the project or an earlier take; without a name and a run with nothing. */
export interface Against {
  kind: "against";
  name?: string;
  run?: number;
}

/** Gives the shot the settings of an earlier take, as one undo step. */
export interface UseRun {
  kind: "use_run";
  run: number;
}

/** Path-traces what is seen, in place of the last render of the page; ``Rendered`` answers, step by step. */
export interface Render {
  kind: "render";
  number: number;
  camera: number[];
  width: number;
  height: number;
  samples?: number;
  focal_length?: number;
  light?: string;
  light_turn?: number;
  color?: string;
}

/** Cancels the render of the page. */
export interface StopRender {
  kind: "stop_render";
}

/** Requests the words of motion of a lock in the shot; replaces an earlier request that is still pending. */
export interface AskMotion {
  kind: "ask_motion";
  lock: number;
}

/** Requests frames, the current one first; replaces earlier requests that are still pending. */
export interface Watch {
  kind: "watch";
  shot?: number[];
  against?: number[];
}

/** Lets the displayed groom move live, or puts it at rest. */
export interface GoLive {
  kind: "go_live";
  on: boolean;
}

/** A hand holds the head of live hair, or lets go. */
export interface HoldHead {
  kind: "hold_head";
  turn: [number, number, number] | null;
  shift?: [number, number, number];
}

/** A hand touches live hair, or lets go. */
export interface TouchHair {
  kind: "touch_hair";
  does: "pull" | "comb" | "pat" | null;
  at?: [number, number, number];
  radius?: number;
}

/** Plays a motion of the head of live hair; ``walk`` and ``clip``, that of the shot, stop where they play. */
export interface MoveHead {
  kind: "move_head";
  motion: "nod" | "turn" | "shake" | "hop" | "walk" | "clip";
}

/** Lets wind blow from a side of the head, or ends it. */
export interface Blow {
  kind: "blow";
  side: "" | "left" | "right" | "front" | "back";
}

/** Keeps the last seconds of live hair as a snapshot. picture: PNG or JPEG in base64. */
export interface KeepTake {
  kind: "keep_take";
  author?: string;
  note?: string;
  look: Shared;
  picture: string;
}

/** Writes a shot with the motion of a take, opens it and starts it, compared with the take. */
export interface MakeShot {
  kind: "make_shot";
  id: string;
  name?: string;
}

/** Takes a snapshot of the current look. picture: PNG or JPEG in base64. */
export interface TakeSnapshot {
  kind: "take_snapshot";
  author?: string;
  note?: string;
  look: Shared;
  picture: string;
}

/** Changes the note of a snapshot. */
export interface EditSnapshot {
  kind: "edit_snapshot";
  id: string;
  note: string;
}

/** Deletes the files of a snapshot. */
export interface DeleteSnapshot {
  kind: "delete_snapshot";
  id: string;
}

/** Writes a note about what is seen. */
export interface WriteNote {
  kind: "write_note";
  author?: string;
  text: string;
  look: Shared;
  at?: [number, number, number] | null;
  lock?: number | null;
  point?: number;
  strokes?: [number, number][][];
}

/** Changes the text of a note, or whether it is resolved; None leaves it as it is. */
export interface EditNote {
  kind: "edit_note";
  id: string;
  text?: string | null;
  resolved?: boolean | null;
}

/** Deletes a note. */
export interface DeleteNote {
  kind: "delete_note";
  id: string;
}

/** Keeps a reference picture. picture: PNG or JPEG in base64. */
export interface AddReference {
  kind: "add_reference";
  name: string;
  picture: string;
}

/** Shows a reference picture next to the look, over it, or not. */
export interface PlaceReference {
  kind: "place_reference";
  mode?: "off" | "next" | "over";
  opacity?: number;
  x?: number;
  y?: number;
  scale?: number;
  id: string;
}

/** Deletes a reference picture. */
export interface DeleteReference {
  kind: "delete_reference";
  id: string;
}

/** Keeps a look for the recipe: in bookmark 1 to 9, or as the one with which the review opens (0). */
export interface KeepView {
  kind: "keep_view";
  slot: number;
  look: Shared;
}

/** Sets the recipe to a snapshot, as one undo step. */
export interface LoadSnapshot {
  kind: "load_snapshot";
  id: string;
}

/** Sets melanin and redness of the recipe so that its hair has a color. color: sRGB, ``#rrggbb``. */
export interface PickColor {
  kind: "pick_color";
  color: string;
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
  colors: Record<string, [number, number, number, number, number]>;
  rigs: Record<string, Rig>;
}

/** Holder of the edit lock, and the people at the connected pages. */
export interface Role {
  kind: "role";
  leads: boolean;
  asked: boolean;
  asking: string;
  asks: boolean;
  people: Person[];
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

/** Bounds of the skin that hair is to grow on [m]: known before the groom, so that the picture shows them first. */
export interface Subject {
  kind: "subject";
  low: [number, number, number];
  high: [number, number, number];
}

/** A mesh of the scene, the one of ``index`` among ``of``, which come one after another and are shown together. */
export interface Body {
  kind: "body";
  index: number;
  of: number;
  name: string;
  made_of: string;
  color: [number, number, number];
  points: Float32Array;
  triangles: Uint32Array;
  colors: Float32Array;
}

/** Positions of the locks. side: a, or another for a groom to compare with. */
export interface Locks {
  kind: "locks";
  side: "a" | "b" | "c" | "d";
  draft: boolean;
  points: Float32Array;
  offsets: Int32Array;
  ids: Float64Array;
  axis: Float32Array;
  marked: Uint8Array;
  window: Int32Array;
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
  side: "a" | "b" | "c" | "d";
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
  side: "a" | "b" | "c" | "d";
  stations: number;
  roughness: number;
  azimuthal_roughness: number;
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
  pin: Uint8Array;
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

/** State of the simulation, and the existing frames of the shot and of what it is compared with. */
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
  kept: KeptRun[];
  frames: Float64Array;
  against_frames: Float64Array;
  runs: Int32Array;
  stale: Uint8Array;
  swings: Float32Array;
  against_swings: Float32Array;
}

/** A look that is compared; ``a`` is the open recipe. */
export interface Compared {
  kind: "compared";
  side: "a" | "b" | "c" | "d";
  name: string;
  detail: string;
  take: string;
  settings: Record<string, string>;
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

/** A share page, as UTF-8, to be kept as a file. hairs: number of its hairs, of the ``of`` of the look. */
export interface SharePage {
  kind: "share_page";
  name: string;
  hairs: number;
  of: number;
  text: Uint8Array;
}

/** A short message of what has happened. */
export interface Notice {
  kind: "notice";
  message: string;
}

/** Words of motion of a lock, by its id, or why it has none. */
export interface LockMotion {
  kind: "lock_motion";
  lock: number;
  text: string;
}

/** The look of the leading page. */
export interface Followed {
  kind: "followed";
  camera: number[];
  focal_length: number;
  light: string;
  light_turn: number;
  color: string;
  overlay: string;
  file: "recipe" | "shot";
  place: (string | number)[];
  locks: number[];
  frame: number | null;
  looks: Arranged | null;
  step: number | null;
}

/** Position of the leading page's pointer in the scene [m]; None where it is elsewhere. */
export interface Pointer {
  kind: "pointer";
  at: [number, number, number] | null;
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
  directions: Float32Array;
}

/** All snapshots of the recipe, the oldest first. */
export interface Snapshots {
  kind: "snapshots";
  snapshots: Snapshot[];
}

/** A picture that is kept next to the recipe, such as ``snapshots/20260131-101530``: a PNG or JPEG file. */
export interface Picture {
  kind: "picture";
  name: string;
  data: Uint8Array;
}

/** All notes about the recipe, the oldest first. */
export interface Notes {
  kind: "notes";
  notes: Note[];
}

/** All reference pictures, the oldest first. */
export interface References {
  kind: "references";
  references: Reference[];
}

/** Kept looks by their bookmarks; ``0`` is the one with which the review opens. */
export interface Views {
  kind: "views";
  views: Record<string, Shared>;
}

/** Cameras in the files of the scene. */
export interface Cameras {
  kind: "cameras";
  cameras: StageCamera[];
}

/** A render as it grows, a PNG. samples: per pixel so far, ``of`` so many; it is done with all of them. */
export interface Rendered {
  kind: "rendered";
  number: number;
  samples: number;
  of: number;
  png: Uint8Array;
}

/** Whether hair moves live. */
export interface Live {
  kind: "live";
  on: boolean;
  fps: number;
  goes_on: string[];
  wind: string;
  contact: string;
}

/** The rods that carry locks in live motion, as groomed. */
export interface Rods {
  kind: "rods";
  side: "a" | "b" | "c" | "d";
  key: number;
  pivot: [number, number, number];
  points: Float32Array;
  along: Float32Array;
  axis: Float32Array;
  rise: Float32Array;
  ids: Float64Array;
  carrier: Uint32Array;
}

/** A step of live hair: where the vertices of its rods are. */
export interface LiveStep {
  kind: "live_step";
  side: "a" | "b" | "c" | "d";
  key: number;
  step: number;
  head: number[];
  trunk: [number, number, number];
  note: string;
  points: Float32Array;
  worn: Float32Array;
}

/** A take of live hair that is compared, which pages play; see ``ringlet.viewer.show.live_take``. */
export interface LiveTake {
  kind: "live_take";
  side: "a" | "b" | "c" | "d";
  id: string;
  fps: number;
  first: number | null;
  pivot: [number, number, number];
  unit: number;
  points: Float32Array;
  along: Float32Array;
  axis: Float32Array;
  rise: Float32Array;
  ids: Float64Array;
  carrier: Uint32Array;
  steps: Int32Array;
  heads: Float32Array;
  trunks: Float32Array;
  moved: Int16Array;
  worn: Int16Array;
}

export type FromPage =
  | Hello
  | Introduce
  | Point
  | Lead
  | Set
  | Arrange
  | Choose
  | Mute
  | Step
  | Save
  | Open
  | UseCopy
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
  | Share
  | Hand
  | Play
  | Against
  | UseRun
  | Render
  | StopRender
  | AskMotion
  | Watch
  | GoLive
  | HoldHead
  | TouchHair
  | MoveHead
  | Blow
  | KeepTake
  | MakeShot
  | TakeSnapshot
  | EditSnapshot
  | DeleteSnapshot
  | WriteNote
  | EditNote
  | DeleteNote
  | AddReference
  | PlaceReference
  | DeleteReference
  | KeepView
  | LoadSnapshot
  | PickColor;

export type FromServer =
  | Welcome
  | Role
  | Files
  | Document
  | Subject
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
  | SharePage
  | Notice
  | LockMotion
  | Followed
  | Pointer
  | Trouble
  | Problems
  | Progress
  | Presets
  | Painted
  | Snapshots
  | Picture
  | Notes
  | References
  | Views
  | Cameras
  | Rendered
  | Live
  | Rods
  | LiveStep
  | LiveTake;
