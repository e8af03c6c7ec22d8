// The connection to the server. It comes back on its own when it is lost.

import { tokenOf } from "./address";
import type { Client } from "./client";
import { decode, encode } from "./codec";
import { type FromPage, type FromServer, VERSION } from "./protocol";

export type Presence = Extract<FromPage, { kind: "introduce" | "look" | "point" | "hold_head" | "touch_hair" }>;

const FIRST_WAIT = 300;
const LONGEST_WAIT = 5000;
const REFUSED = 4403;
const WRONG = 4400;

// What changes something: it is said again to a server that has not heard it.
const CHANGES = [
  ...["set", "arrange", "mute", "save", "use_copy", "resolve", "restore", "isolate", "drag", "sculpt", "unsculpt", "pick_color"],
  ...["take_snapshot", "edit_snapshot", "delete_snapshot", "load_snapshot", "write_note", "edit_note", "delete_note"],
  ...["place_reference", "delete_reference", "keep_view", "take", "keep", "paint", "draw", "use_run"],
];
const STORE = "ringlet-owed"; // what this tab has not been answered when it is left

export type LinkState = "open" | "lost" | "refused";

/** Who hears what the server says, and how the connection is. */
export interface Listener {
  hear: (message: FromServer) => void;
  changed: (state: LinkState, why: string) => void;
  /** Whether this page holds the edit lock. */
  leads: () => boolean;
}

export class Link {
  private socket: WebSocket | null = null;
  private wait = FIRST_WAIT;
  /** What was said and not heard yet, oldest first; also what was said while nobody was there. */
  private owed: FromPage[] = [];
  private heard = 0;
  /** Whether this tab held the edit lock before it was loaded again. */
  private led = false;
  /** What was said before and has to be said again. */
  private again: FromPage[] = [];
  private listener: Listener | null = null;
  private state: [LinkState, string] | null = null;
  private readonly came: ArrayBuffer[] = []; // before there was a listener, oldest first

  constructor(
    private readonly client: Client,
    private readonly person: () => string,
  ) {
    const stored = client.copied ? null : sessionStorage.getItem(STORE); // the tab that this one is a copy of sends it
    if (stored) {
      sessionStorage.removeItem(STORE);
      const { heard, owed, led } = JSON.parse(stored) as Stored;
      [this.heard, this.owed, this.led] = [heard, owed, led];
    }
    addEventListener("pagehide", () => this.store());
  }

  /** Tells a listener what has come so far, one message a task so that the page is drawn meanwhile, and what comes. */
  tell(listener: Listener): void {
    this.listener = listener;
    if (this.state) listener.changed(...this.state);
    this.tellNext();
  }

  private tellNext(): void {
    const data = this.came.shift();
    if (!data) return;
    setTimeout(() => this.tellNext());
    this.listener!.hear(decode(data));
  }

  private take(data: ArrayBuffer): void {
    if (this.listener && !this.came.length) this.listener.hear(decode(data));
    else this.came.push(data);
  }

  private turn(...state: [LinkState, string]): void {
    this.state = state;
    this.listener?.changed(...state);
  }

  private leads(): boolean {
    return this.listener?.leads() ?? false;
  }

  /** Keeps what was not answered for when this tab is loaded again. */
  private store(): void {
    const owed = [...this.owed, ...this.again];
    const led = this.leads();
    if (owed.length || led) sessionStorage.setItem(STORE, JSON.stringify({ heard: this.heard, owed, led }));
  }

  /** Whether something was said that nobody has heard. */
  get unanswered(): boolean {
    return this.owed.some(({ kind }) => CHANGES.includes(kind)) || this.again.length > 0;
  }

  /** Whether all that was said has been heard by the server that is there, and here what it has said so far. */
  get answered(): boolean {
    return this.socket?.readyState === WebSocket.OPEN && !this.owed.length && !this.again.length && !this.came.length;
  }

  /** Connects, and keeps at it. */
  start(): void {
    const token = tokenOf(location.hash);
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const folder = location.pathname.replace(/[^/]*$/, "");
    const socket = new WebSocket(`${scheme}://${location.host}${folder}session?token=${encodeURIComponent(token)}`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.socket = socket;
      this.wait = FIRST_WAIT;
      this.send({ kind: "hello", version: VERSION, client: this.client.name, leads: this.led || this.leads(), person: this.person() });
      this.led = false;
      this.turn("open", "");
    };
    socket.onmessage = (event) => this.take(event.data as ArrayBuffer);
    socket.onclose = (event) => {
      this.socket = null;
      if (event.code === REFUSED || event.code === WRONG) {
        this.turn("refused", event.reason);
        return;
      }
      this.turn("lost", "The server does not answer. Your edits are kept here until it is back.");
      setTimeout(() => this.start(), this.wait);
      this.wait = Math.min(2 * this.wait, LONGEST_WAIT);
    };
  }

  /** Sends a message; it is kept as long as nobody has heard it. */
  say(message: FromPage): void {
    this.owed.push(message);
    this.send(message);
  }

  /** Sends a message of presence: it is not answered, and the next one of its kind makes up for a lost one. */
  whisper(message: Presence): void {
    this.send(message);
  }

  /** A server is there, which has heard so many messages of this page. */
  met(heard: number): void {
    this.noteHeard(heard);
    this.again = [...this.owed.filter(({ kind }) => CHANGES.includes(kind)), ...this.again];
    this.owed = [];
  }

  /** The server has heard so many messages of this page, in the order in which they were said. */
  noteHeard(count: number): void {
    this.owed.splice(0, Math.max(0, count - this.heard));
    this.heard = count;
  }

  /** Says again what the server before has not heard; a page that follows keeps it until it leads. */
  sayAgain(): void {
    if (!this.leads()) return;
    for (const message of this.again.splice(0)) this.say(message);
  }

  private send(message: FromPage): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(encode(message));
  }

  /** How many bytes have not left yet: while there are some, dragging can wait. */
  get pending(): number {
    return this.socket?.bufferedAmount ?? 0;
  }
}

interface Stored {
  heard: number;
  owed: FromPage[];
  led: boolean;
}
