// The page without a browser: its panels in a DOM that has no layout, and no picture, with a server that says what the
// real one has said about the small example, and remembers what it hears.

import { afterEach, inject, vi } from "vitest";
import { decode } from "../src/codec";
import type { App } from "../src/app";
import { at, type File, type Place } from "../src/model";
import type { FromPage, FromServer, Json } from "../src/protocol";
import type { Example } from "./messages";

/** Size of the picture, which a DOM without a layout does not know. */
const [WIDTH, HEIGHT] = [1000, 640];
const SETTLED = 1000; // after which nothing of an opened page is under way [ms]

type Of<K extends FromServer["kind"]> = Extract<FromServer, { kind: K }>;

/** The other end of the connection. */
export class Socket {
  static readonly OPEN = 1;
  static latest: Socket;
  readyState = 0;
  bufferedAmount = 0;
  binaryType = "";
  onopen = (): void => {};
  onmessage = (_: { data: ArrayBuffer }): void => {};
  onclose = (_: { code: number; reason: string }): void => {};
  /** What the page has said, oldest first. */
  readonly heard: FromPage[] = [];

  constructor(readonly address: string) {
    Socket.latest = this;
  }

  open(): void {
    this.readyState = Socket.OPEN;
    this.onopen();
  }

  send(data: ArrayBuffer): void {
    this.heard.push(JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4))));
  }

  close(): void {
    this.readyState = 3;
    this.onclose({ code: 1006, reason: "" });
  }
}

/** A message of the server, decoded anew for each page. */
export function recorded(example: Example): ArrayBuffer[] {
  return inject("messages")[example].map((text) => Uint8Array.from(Buffer.from(text, "base64")).buffer);
}

export class Page {
  constructor(
    readonly app: App,
    private readonly example: Example,
  ) {}

  get model(): App["model"] {
    return this.app.model;
  }

  /** What the page has said of a kind. */
  said<K extends FromPage["kind"]>(kind: K): Extract<FromPage, { kind: K }>[] {
    return Socket.latest.heard.filter((message) => message.kind === kind) as Extract<FromPage, { kind: K }>[];
  }

  /** What the page said last of a kind. */
  last<K extends FromPage["kind"]>(kind: K): Extract<FromPage, { kind: K }> {
    return this.said(kind).at(-1)!;
  }

  /** The server says something. */
  hear(message: FromServer): void {
    this.model.take(message);
  }

  /** The message of a kind that the server said when the file was opened. */
  first<K extends FromServer["kind"]>(kind: K): Of<K> {
    return recorded(this.example).map(decode).find((message) => message.kind === kind) as Of<K>;
  }

  /** The server says a file again, with what has changed in it. */
  document(change: Partial<Of<"document">>): void {
    const before = this.model.documents[change.file ?? "recipe"]!;
    this.hear({ ...before, dirty: true, undo: true, ...change });
  }

  /** The server says a file again in which a setting has another value; si: the value as it holds, in SI units. */
  setting(place: Place, said: Json | undefined, si = said, file: File = "recipe"): void {
    const before = this.model.documents[file]!;
    const varies = at(before.values, [...place, "value"]) !== undefined && typeof si !== "object"; // along hair, or by lock
    const values = changed(before.values, varies ? [...place, "value"] : place, si);
    this.document({ file, said: changed(before.said, place, said), values });
  }

  /** The server says who is there, and which of them this page is. */
  role(change: Partial<Of<"role">>): void {
    this.hear({ ...this.model.role, ...change });
  }
}

/** A table with another value at a place; undefined: with none. */
function changed(table: Record<string, Json>, place: Place, value: Json | undefined): Record<string, Json> {
  const copy = structuredClone(table);
  let at = copy as Record<string | number, Json>;
  for (const part of place.slice(0, -1)) {
    at[part] ??= {};
    at = at[part] as Record<string | number, Json>;
  }
  if (value === undefined) delete at[place.at(-1)!];
  else at[place.at(-1)!] = value;
  return copy;
}

/** Listeners of the window, which outlive a page. */
const listening: (() => void)[] = [];

/** Opens a file of the small example in a page of its own. change: of what the server says; copied: in a copy of a tab */
export async function open(example: Example = "small.recipe", change = (message: FromServer) => message, copied = false): Promise<Page> {
  leave();
  vi.resetModules();
  vi.stubGlobal("WebSocket", Socket);
  const add = window.addEventListener;
  vi.spyOn(window, "addEventListener").mockImplementation((...listener: Parameters<typeof add>) => {
    add.apply(window, listener);
    listening.push(() => window.removeEventListener(listener[0], listener[1], listener[2]));
  });
  vi.spyOn(HTMLElement.prototype, "clientWidth", "get").mockReturnValue(WIDTH);
  vi.spyOn(HTMLElement.prototype, "clientHeight", "get").mockReturnValue(HEIGHT);
  const root = document.createElement("div");
  document.body.append(root);
  const [{ App }, { Link }] = await Promise.all([import("../src/app"), import("../src/link")]);
  vi.useFakeTimers();
  const link = new Link({ name: "tab", copied }, () => localStorage.getItem("ringlet-person") ?? "");
  link.start();
  const app = new App(root, link);
  Socket.latest.open();
  for (const message of recorded(example)) app.model.take(change(decode(message)));
  vi.advanceTimersByTime(SETTLED);
  return new Page(app, example);
}

/** Leaves the page, as when it is loaded again. */
function leave(): void {
  window.dispatchEvent(new Event("pagehide"));
  for (const stop of listening.splice(0)) stop();
  vi.restoreAllMocks();
  vi.useRealTimers();
  document.documentElement.removeAttribute("data-sheet");
  document.body.replaceChildren();
}

afterEach(() => {
  leave();
  localStorage.clear();
  sessionStorage.clear();
});
