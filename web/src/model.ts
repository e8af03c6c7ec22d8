// What the page knows of the session, and whom it tells when that changes.

import type { Link } from "./link";
import { inUnit } from "./panel/units";
import type {
  Compared,
  Document,
  Followed,
  FromPage,
  FromServer,
  Guides,
  Json,
  Live,
  LockMotion,
  Measured,
  Names,
  Note,
  Numbers,
  Painted,
  Preset,
  Problem,
  Progress,
  Reference,
  Role,
  Shared,
  Snapshot,
  StageCamera,
  Timeline,
  Welcome,
} from "./protocol";
import type { Side } from "./view/looks";
import type { OverlayName } from "./view/overlays";

export type File = "recipe" | "shot";
export type Place = (string | number)[];
type Kind = FromServer["kind"];
type Of<K extends Kind> = Extract<FromServer, { kind: K }>;
type Topic =
  | "welcome"
  | "document"
  | "role"
  | "files"
  | "names"
  | "guides"
  | "numbers"
  | "lock_motion"
  | "measured"
  | "timeline"
  | "compared"
  | "arranged"
  | "chosen"
  | "problems"
  | "progress"
  | "presets"
  | "painted"
  | "look"
  | "followed"
  | "overlay"
  | "snapshots"
  | "pictures"
  | "notes"
  | "references"
  | "views"
  | "cameras"
  | "clear"
  | "live"
  | "frame"
  | "step";

const NOT_LIVE: Live = { kind: "live", on: false, fps: 0, goes_on: [], wind: "", contact: "" };

export class Model {
  welcome: Welcome | null = null;
  documents: Partial<Record<File, Document>> = {};
  role: Role = { kind: "role", leads: true, asked: false, asking: "", asks: false, people: [] };
  numbers: Numbers | null = null;
  lockMotion: LockMotion | null = null;
  names: Names = { kind: "names", regions: [], maps: [], vectors: [], curves: [] };
  guides: Guides | null = null;
  measured: Measured | null = null;
  overlay: OverlayName | "" = "";
  timeline: Timeline | null = null;
  /** Whether hair moves live. */
  live = NOT_LIVE;
  /** The looks that are compared, by side; that of the open recipe too, once there is another. */
  compared: Partial<Record<Side, Compared>> = {};
  /** Step at which the take that is compared stands; null: it plays. */
  step: number | null = null;
  snapshots: Snapshot[] = [];
  notes: Note[] = [];
  references: Reference[] = [];
  /** Bookmarks of the recipe by their number, and the look with which the review opens: 0. */
  views: Record<string, Shared> = {};
  /** Cameras of the scene. */
  cameras: StageCamera[] = [];
  /** Addresses of the pictures that are kept next to the recipe, by name. */
  readonly pictures = new Map<string, string>();
  /** What there is in the project to compare with. */
  files: string[] = [];
  /** The stage whose settings are shown, and the file that it belongs to. */
  chosen: { file: File; place: Place } = { file: "recipe", place: [] };
  /** The locks whose own values are edited, in place of those of all locks; empty: all. */
  locks: number[] = [];
  problems: Problem[] = [];
  presets: Preset[] = [];
  /** The map that was asked for or painted last. */
  painted: Painted | null = null;
  /** Paints the map that a setting names. */
  paint: (place: Place, label: string) => void = () => {};
  /** Draws the curve that a setting names. */
  draw: (place: Place, label: string) => void = () => {};
  /** How the leading page looks at the groom. */
  followed: Followed | null = null;
  /** Progress of a groom that takes long. */
  progress: Progress | null = null;
  link: Link | null = null;
  private gesture = Date.now() % 1e9;
  private readonly listeners = new Map<Topic, (() => void)[]>();
  private readonly hearers = new Map<Kind, ((message: never) => void)[]>();

  constructor() {
    this.hear("heard", ({ count }) => this.link?.noteHeard(count));
    this.hear("document", (message) => {
      this.documents[message.file] = message;
      this.tell("document");
    });
    this.hear("role", (message) => {
      this.role = message;
      this.tell("role");
      if (this.settled || this.stuck) this.link?.sayAgain();
    });
    this.hear("files", ({ names }) => {
      this.files = names;
      this.tell("files");
    });
    this.hear("numbers", (message) => {
      this.numbers = message;
      this.tell("numbers");
      if (this.settled) this.link?.sayAgain();
    });
    this.hear("problems", ({ problems }) => {
      this.problems = problems;
      this.tell("problems");
      this.tell("document");
      if (this.stuck) this.link?.sayAgain(); // what was not heard may be what makes the groom possible
    });
    this.hear("progress", (message) => {
      this.progress = message.stage ? message : null;
      this.tell("progress");
    });
    this.hear("picture", ({ name, data }) => {
      this.setPicture(name, data as Uint8Array<ArrayBuffer>);
      this.tell("pictures");
    });
    this.hear("trouble", () => this.tell("document")); // controls go back to what holds
    this.keepWhole("painted", "names", "measured", "timeline", "followed", "live");
    this.keepPart("presets", "snapshots", "notes", "references", "views", "cameras");
    this.hear("lock_motion", (message) => {
      this.lockMotion = message;
      this.tell("lock_motion");
    });
  }

  /** Calls a listener with each message of a kind that the server sends, after those that asked before. */
  hear<K extends Kind>(kind: K, listener: (message: Of<K>) => void): void {
    this.hearers.set(kind, [...(this.hearers.get(kind) ?? []), listener]);
  }

  /** Hands a message of the server to those that hear its kind. */
  take(message: FromServer): void {
    for (const listener of this.hearers.get(message.kind) ?? []) listener(message as never);
  }

  /** Keeps messages as they come, under the names of their kinds. */
  private keepWhole(...kinds: ("painted" | "names" | "measured" | "timeline" | "followed" | "live")[]): void {
    for (const kind of kinds)
      this.hear(kind, (message) => {
        Object.assign(this, { [kind]: message });
        this.tell(kind);
      });
  }

  /** Keeps of messages what has the name of their kind. */
  private keepPart(...kinds: ("presets" | "snapshots" | "notes" | "references" | "views" | "cameras")[]): void {
    for (const kind of kinds)
      this.hear(kind, (message) => {
        Object.assign(this, { [kind]: (message as unknown as Record<string, unknown>)[kind] });
        this.tell(kind);
      });
  }

  on(topic: Topic, listener: () => void): void {
    this.listeners.set(topic, [...(this.listeners.get(topic) ?? []), listener]);
  }

  tell(topic: Topic): void {
    for (const listener of this.listeners.get(topic) ?? []) listener();
  }

  choose(file: File, place: Place): void {
    this.chosen = { file, place };
    this.tell("chosen");
  }

  say(message: FromPage): void {
    this.link?.say(message);
  }

  /** Forgets the file that was open. */
  reset(): void {
    this.documents = {};
    this.numbers = this.guides = this.measured = this.timeline = null;
    this.compared = {};
    this.step = null;
    this.locks = [];
    this.followed = null;
    this.live = NOT_LIVE;
    this.chosen = { file: "recipe", place: [] };
  }

  /** Hair no longer moves live. */
  putAtRest(): void {
    this.live = NOT_LIVE;
    this.tell("live");
  }

  /** Keeps a picture of the server. */
  setPicture(name: string, data: Uint8Array<ArrayBuffer>): void {
    const before = this.pictures.get(name);
    if (before) URL.revokeObjectURL(before);
    this.pictures.set(name, URL.createObjectURL(new Blob([data])));
  }

  /** Whether a problem names a setting as wrong. */
  isWrong(file: File, place: Place): boolean {
    return this.problems.some((one) => one.setting && one.file === file && one.setting === place.join("."));
  }

  /** Sides of the looks that the open one is compared with. */
  get others(): Side[] {
    return (["b", "c", "d"] as const).filter((side) => this.compared[side]);
  }

  /** Whether the groom of the recipe as it is cannot be made, or is held. */
  get stuck(): boolean {
    return this.problems.some(({ subject }) => subject === "groom" || subject === "work");
  }

  /** A message with its lengths in the unit of the recipe. */
  words(message: string): string {
    return inUnit(message, String(this.value("recipe", ["unit"]) ?? "cm"));
  }

  /** A number for what one hand does from pressing to letting go: one step of undo. */
  newGesture(): number {
    return ++this.gesture;
  }

  /** What the file says at a place, or undefined. */
  said(file: File, place: Place): Json | undefined {
    return at(this.documents[file]?.said, place);
  }

  /** Whether what is seen is what the recipe says, in full. */
  get settled(): boolean {
    const { numbers, documents } = this;
    return numbers !== null && !numbers.draft && numbers.revision === (documents.recipe?.revision ?? 0);
  }

  /** What holds at a place, in SI units. */
  value(file: File, place: Place): Json | undefined {
    return at(this.documents[file]?.values, place);
  }
}

export function at(json: Json | undefined, place: Place): Json | undefined {
  let value = json;
  for (const part of place) {
    if (value === null || typeof value !== "object") return undefined;
    value = (value as Record<string | number, Json>)[part];
  }
  return value;
}
