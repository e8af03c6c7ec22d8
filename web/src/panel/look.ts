// How the groom is looked at: camera, light, color, overlay, stage, locks and frame. It is remembered by file, kept in
// bookmarks, and shared with the pages that follow.

import type { Model } from "../model";
import type { Followed } from "../protocol";
import type { Viewer } from "../view/viewer";
import { bindKey } from "./keys";
import type { LockTool } from "./lock";
import type { Notices } from "./status";
import type { TimelineBar } from "./timeline";
import type { Viewbar } from "./viewbar";

type State = Omit<Followed, "kind">;

const SHARE_AFTER = 120; // time between two looks that are shared [ms]
const STORE = "ringlet-look:";

export class Look {
  /** Whether this page shows what the leading page looks at. */
  follows = true;
  private timer = 0;
  private applying = false;
  private restored = "";

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly bar: Viewbar,
    private readonly lock: LockTool,
    private readonly timeline: TimelineBar,
    private readonly notices: Notices,
  ) {
    viewer.controls.addEventListener("start", () => this.leaveLeader());
    for (const topic of ["look", "chosen", "overlay"] as const) model.on(topic, () => this.changed());
    model.on("role", () => this.changed()); // a page that has just joined sees it
    model.on("numbers", () => this.restore());
    model.on("followed", () => this.follow());
    addEventListener("pagehide", () => this.store());
    const digit = (event: KeyboardEvent) => /^Digit[1-9]$/.test(event.code) && !event.ctrlKey && !event.metaKey;
    bindKey({
      keys: "1 … 9, Shift with 1 … 9",
      does: "recall a bookmark of camera, light and color; store one",
      on: digit,
      run: (event) => this.bookmark(event.code.slice(5), event.shiftKey),
    });
  }

  private get key(): string {
    return STORE + (this.model.welcome?.name ?? "");
  }

  /** How the groom is looked at now. */
  get state(): State {
    const { chosen, locks, overlay } = this.model;
    return {
      ...this.viewer.cameraState,
      light: this.bar.light.value,
      color: this.bar.color.value,
      overlay,
      file: chosen.file,
      place: chosen.place,
      locks,
      frame: this.timeline.current,
    };
  }

  /** Looks at the groom as a state says; with `all` also at its stage, locks and frame. */
  apply(state: State, all: boolean): void {
    this.applying = true;
    this.viewer.lookFrom(state.camera, state.focal_length);
    this.viewer.setLightTurn(state.light_turn ?? 0);
    this.bar.choose(state);
    if (all) {
      this.model.choose(state.file, state.place);
      if (state.frame !== null) this.timeline.show(state.frame);
      this.lock.chooseIds(state.locks);
    }
    this.applying = false;
  }

  /** Something of the look has changed: it is shared and remembered. */
  private changed(): void {
    if (this.applying || this.timer) return;
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      this.store();
      const { role } = this.model;
      if (role.leads && role.others) this.model.say({ kind: "look", ...this.state });
    }, SHARE_AFTER);
  }

  private follow(): void {
    const { followed, role } = this.model;
    if (followed && !role.leads && this.follows) this.apply(followed, true);
  }

  /** The hand turns the head: this page has a look of its own from now on. */
  private leaveLeader(): void {
    if (this.model.role.leads || !this.follows) return;
    this.setFollows(false);
  }

  setFollows(on: boolean): void {
    this.follows = on;
    this.model.tell("role");
    if (on) this.follow();
  }

  private store(): void {
    if (this.model.role.leads && this.restored === this.key) localStorage.setItem(this.key, JSON.stringify(this.state));
  }

  /** Looks at a file as it was looked at last. */
  private restore(): void {
    if (this.restored === this.key) return;
    this.restored = this.key;
    const stored = localStorage.getItem(this.key);
    if (stored && this.model.role.leads) this.apply(JSON.parse(stored) as State, false);
  }

  private bookmark(number: string, keep: boolean): void {
    const key = `${this.key}:${number}`;
    if (keep) {
      localStorage.setItem(key, JSON.stringify(this.state));
      this.notices.show(`Bookmark ${number} is kept`);
      return;
    }
    const stored = localStorage.getItem(key);
    if (stored) this.apply(JSON.parse(stored) as State, false);
    else this.notices.show(`There is no bookmark ${number}; Shift+${number} keeps one`);
    if (stored) this.changed();
  }
}
