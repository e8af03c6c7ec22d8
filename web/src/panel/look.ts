// How the groom is looked at: camera, light, color, overlay, stage, locks and frame. It is remembered by file, kept in
// bookmarks, and shared with the pages that follow.

import { addressOf, type View, viewOf } from "../address";
import { h } from "../dom";
import type { Model } from "../model";
import { openDialog } from "./dialog";
import type { Viewer } from "../view/viewer";
import { bindKey } from "./keys";
import type { LockTool } from "./lock";
import { ownName } from "./author";
import type { Notices } from "./status";
import type { TimelineBar } from "./timeline";
import type { Viewbar } from "./viewbar";

const KEEP_AFTER = 800; // time without a change of the light after which it is kept [ms]
const SHARE_AFTER = 50; // time between two looks that are shared [ms]
const SAME = 1e-4; // cameras that differ by less are the same [m]
const STORE = "ringlet-look:";

export class Look {
  /** Whether this page shows what the leading page looks at. */
  follows = true;
  private timer = 0;
  private applying = false;
  private restored = "";
  /** Light, color and lens as they are kept with the recipe. */
  private keptLight = "";
  private keeping = 0;
  /** What this page shows of the look of the leader. */
  private applied: View | null = null;

  constructor(
    private readonly model: Model,
    private readonly viewer: Viewer,
    private readonly bar: Viewbar,
    private readonly lock: LockTool,
    private readonly timeline: TimelineBar,
    private readonly notices: Notices,
  ) {
    addEventListener("hashchange", () => this.openLink());
    for (const topic of ["look", "chosen", "overlay"] as const)
      model.on(topic, () => {
        this.leaveLeader();
        this.changed();
      });
    model.on("role", () => this.changed()); // a page that has just joined sees it
    model.on("welcome", () => this.introduce());
    model.on("numbers", () => {
      this.restore();
      this.follow(); // locks that are chosen may be there now
    });
    for (const topic of ["followed", "compared"] as const) model.on(topic, () => this.follow());
    model.on("compared", () => this.changed());
    addEventListener("pagehide", () => this.store());
    const digit = (event: KeyboardEvent) => /^Digit[1-9]$/.test(event.code) && !event.ctrlKey && !event.metaKey;
    bindKey({
      section: "View",
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
  get state(): View {
    const { chosen, overlay } = this.model;
    return {
      ...this.viewer.cameraState,
      light: this.bar.light.value,
      color: this.bar.color.value,
      overlay,
      file: chosen.file,
      place: chosen.place,
      locks: this.lock.ids,
      frame: this.timeline.current,
      looks: this.viewer.looks.arranged,
      step: this.model.step,
    };
  }

  /** Looks at the groom as a state says; with `all` also at its stage, locks and frame. */
  apply(state: View, all: boolean): void {
    this.applying = true;
    this.viewer.lookFrom(state.camera, state.focal_length);
    this.viewer.stage.setLightTurn(state.light_turn ?? 0);
    this.bar.choose(state);
    if (all) {
      this.model.choose(state.file, state.place);
      if (state.frame !== null) this.timeline.goTo(state.frame);
      this.lock.chooseIds(state.locks);
      if (state.looks) {
        this.viewer.looks.arrangeAs(state.looks);
        this.model.tell("arranged");
      }
      this.model.step = state.step ?? null;
      this.model.tell("step");
    }
    this.applying = false;
  }

  /** Whether the look is shared and remembered. */
  get settled(): boolean {
    return !this.timer && !this.keeping;
  }

  /** Something of the look has changed: it is shared and remembered. */
  private changed(): void {
    if (this.applying || this.timer) return;
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      this.store();
      this.keepLight();
      const { role } = this.model;
      if (role.leads && role.people.length > 1) this.model.link?.whisper({ kind: "look", ...this.state });
    }, SHARE_AFTER);
  }

  private follow(): void {
    const { followed, role } = this.model;
    if (!followed || role.leads || !this.follows) return;
    this.apply(followed, true);
    this.applied = this.state;
  }

  /** A follower looks elsewhere than the leader: this page has a look of its own from now on. */
  private leaveLeader(): void {
    const { role, followed } = this.model;
    if (this.applying || role.leads || !this.follows || !followed || !this.applied) return;
    if (same(this.applied, this.state)) return;
    this.setFollows(false);
  }

  setFollows(on: boolean): void {
    this.follows = on;
    if (on) this.follow();
    this.introduce();
    this.model.tell("role");
  }

  /** Says to the others who is at this page, and whether it follows. */
  introduce(): void {
    this.model.link?.whisper({ kind: "introduce", person: ownName(), follows: this.follows });
  }

  /** Copies a link to what this page looks at; where the browser refuses, it is shown. */
  async copyLink(): Promise<void> {
    const address = addressOf(location.hash, { name: this.model.welcome?.name ?? "", view: this.state });
    history.replaceState(null, "", address);
    try {
      await navigator.clipboard.writeText(address);
      this.notices.show("The link to this view is copied");
    } catch {
      const text = h("input", { type: "text", readonly: true, value: address, "aria-label": "Link to this view" });
      openDialog("Link to this view", text);
      text.select();
    }
  }

  /** Opens the view that the address holds. */
  private openLink(): boolean {
    const link = viewOf(location.hash);
    if (!link) return false;
    if (link.name && link.name !== this.model.welcome?.name) {
      this.notices.show(`The link is of ${link.name}; open that file to see its view`);
      return false;
    }
    this.apply(link.view, true);
    this.setFollows(false);
    if (this.model.role.leads) this.changed();
    return true;
  }

  private store(): void {
    if (this.model.role.leads && this.restored === this.key) localStorage.setItem(this.key, JSON.stringify(this.state));
  }

  /** Looks at a file as it was looked at last. */
  private restore(): void {
    if (this.restored === this.key) return;
    this.restored = this.key;
    this.keptLight = lightOf(this.state);
    if (this.openLink()) return;
    const stored = localStorage.getItem(this.key);
    const last = stored ? (JSON.parse(stored) as View) : undefined;
    const kept = this.model.views["0"]; // light, color and lens are those of the recipe, the camera is this browser's
    const view = kept ? { ...kept, camera: last?.camera ?? kept.camera } : last;
    if (view && this.model.role.leads) this.apply(view, false);
    this.keptLight = lightOf(this.state);
  }

  /** Recalls a bookmark of the recipe, or keeps one. */
  bookmark(slot: string, keep: boolean): void {
    const { model } = this;
    const kept = model.views[slot];
    if (keep) {
      model.views[slot] = this.state; // the server says it again
      model.say({ kind: "keep_view", slot: Number(slot), look: this.state });
      this.notices.show(`Bookmark ${slot} is stored`);
      model.tell("views");
    } else if (kept) {
      this.apply(kept, false);
      this.changed();
    } else this.notices.show(`There is no bookmark ${slot}; Shift+${slot} stores one`);
  }

  /** Keeps light, color and lens with the recipe, once the page that leads has changed them. */
  private keepLight(): void {
    clearTimeout(this.keeping);
    this.keeping = 0;
    if (!this.model.role.leads || this.restored !== this.key || lightOf(this.state) === this.keptLight) return;
    this.keeping = window.setTimeout(() => {
      this.keeping = 0;
      this.keptLight = lightOf(this.state);
      this.model.say({ kind: "keep_view", slot: 0, look: this.state });
    }, KEEP_AFTER);
  }
}

/** What a recipe is lit and seen with. */
function lightOf({ light, light_turn, color, focal_length }: View): string {
  return JSON.stringify([light, light_turn, color, focal_length]);
}

/** Whether two views show the same. */
function same(a: View, b: View): boolean {
  const rest = ({ focal_length, light_turn, light, color, overlay, file, place, locks, frame, looks, step }: View) =>
    JSON.stringify([focal_length, light_turn, light, color, overlay, file, place, locks, frame, looks, step]);
  return rest(a) === rest(b) && a.camera.every((value, k) => Math.abs(value - b.camera[k]) < SAME);
}
