// The page: connects what the server says with the picture and the panels.

import "./base.css";
import "./page.css";
import "./controls.css";
import { h } from "./dom";
import { Link, type LinkState } from "./link";
import { Model } from "./model";
import { Bar } from "./panel/bar";
import { BrushTool } from "./panel/brush";
import { DrawTool } from "./panel/draw";
import { ClearArea } from "./panel/clear_area";
import { CompareBar } from "./panel/compare";
import { bindKey, plainKey } from "./panel/keys";
import { Lens } from "./panel/lens";
import { LockTool } from "./panel/lock";
import { Look } from "./panel/look";
import { Notes } from "./panel/notes";
import { ownName } from "./panel/author";
import { People } from "./panel/people";
import { PresenterPointer } from "./panel/pointer";
import { References } from "./panel/references";
import { RenderPanel } from "./panel/render";
import { Settings } from "./panel/settings";
import { Snapshots } from "./panel/snapshots";
import { Stack } from "./panel/stack";
import { PaintTool } from "./panel/paint";
import { PresetTool } from "./panel/presets";
import { ProblemBar } from "./panel/problems";
import { Notices, Status } from "./panel/status";
import { TimelineBar } from "./panel/timeline";
import { Tray } from "./panel/tray";
import { Viewbar } from "./panel/viewbar";
import { Sheets } from "./panel/sheets"; // the last of the panels, since its style places the others on a phone
import type { SharePage, Welcome } from "./protocol";
import { keep } from "./view/capture";
import { Viewer } from "./view/viewer";

class App {
  readonly model = new Model();
  readonly viewer: Viewer;
  readonly timeline: TimelineBar;
  readonly lock: LockTool;
  readonly brush: BrushTool;
  readonly paint: PaintTool;
  readonly draw: DrawTool;
  readonly look: Look;
  readonly tray: Tray;
  private readonly notes: Notes;
  private readonly pointer: PresenterPointer;
  readonly render: RenderPanel;
  private readonly notices = new Notices(this.model);
  private readonly problems: ProblemBar;
  private readonly status = new Status(this.model);
  private readonly clearArea: ClearArea;
  private session = "";
  /** What the page had when the connection was lost, to be given back to a server that was started anew. */
  private kept: Partial<Record<"recipe" | "shot", Unsaved>> = {};

  constructor(root: HTMLElement) {
    const picture = h("main", { class: "picture" });
    const people = new People(this.model, () => this.look);
    this.problems = new ProblemBar(this.model, people.questions);
    root.append(picture);
    this.viewer = new Viewer(picture);
    this.fillPicture();
    this.lock = new LockTool(this.model, this.viewer);
    this.timeline = new TimelineBar(this.model, this.viewer, (frame) => this.status.simulated(frame.statistics));
    this.brush = new BrushTool(this.model, this.viewer);
    this.paint = new PaintTool(this.model, this.viewer, this.brush.ring);
    this.model.paint = (place, label) => this.paint.paint(place, label);
    this.draw = new DrawTool(this.model, this.viewer);
    this.model.draw = (place, label) => this.draw.draw(place, label);
    const presets = new PresetTool(this.model, this.viewer);
    const sheets = new Sheets(this.model);
    const tools = [this.brush, this.paint, this.draw];
    for (const tool of tools)
      tool.changed.push((on) => {
        if (!on) return;
        for (const other of tools) if (other !== tool) other.show(false);
        this.lock.choose(-1);
        presets.show(false);
        sheets.open("stages");
      });
    presets.opened = () => tools.forEach((tool) => tool.show(false));
    this.lock.busy = () => tools.some(({ on }) => on);
    this.pointer = new PresenterPointer(this.model, this.viewer);
    picture.append(this.lock.handles, this.brush.ring, this.pointer.element);
    this.viewer.onPaint = () => {
      this.lock.place();
      this.pointer.place();
      this.notes?.place();
    };
    this.viewer.onDraw = (statistics) => this.status.drew(statistics);
    const keys = (names: string, does: string, ...all: string[]) =>
      bindKey({ section: "View", keys: names, does, on: plainKey(...all), run: (event) => void this.viewer.key(event.key) });
    keys("Arrows", "orbit the camera", "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown");
    keys("+ and -", "zoom in, zoom out", "+", "=", "-");
    keys("F", "frame all hair", "f");
    const name = () => (this.model.welcome?.name ?? "ringlet").split(".")[0];
    const stack = new Stack(this.model, () => presets.show(true));
    const left = h("div", { class: "left" }, stack.element, presets.element, this.lock.element, this.brush.element, this.paint.element, this.draw.element);
    const settings = new Settings(this.model).element;
    const viewbar = new Viewbar(this.model, this.viewer, this.brush, name);
    this.render = new RenderPanel(this.model, this.viewer, viewbar, name);
    picture.append(this.render.element);
    this.look = new Look(this.model, this.viewer, viewbar, this.lock, this.timeline, this.notices);
    this.tray = new Tray(() => this.look.introduce());
    const snapshots = new Snapshots(this.model, this.viewer, this.look, this.tray);
    this.notes = new Notes(this.model, this.viewer, this.look, this.tray);
    const references = new References(this.model, this.viewer, this.tray, this.notices);
    picture.append(references.element, this.notes.marks);
    const lens = new Lens(this.model, this.viewer, this.look, name);
    viewbar.element.append(lens.button, snapshots.button, this.tray.button);
    const bar = new Bar(this.model, () => this.setTheme(), people.element, () => this.endComparison()).element;
    this.tray.opened = () => sheets.open("");
    sheets.chosen = () => this.tray.show(false);
    const compare = new CompareBar(this.model, this.viewer, () => this.endComparison());
    root.append(
      bar,
      left,
      settings,
      viewbar.element,
      compare.element,
      this.tray.element,
      lens.element,
      this.timeline.element,
      this.status.element,
      this.notices.element,
      this.problems.element,
      sheets.element,
    );
    const below = [viewbar.element, this.timeline.element, this.status.element, sheets.element];
    const panels = [...left.children, settings] as HTMLElement[];
    this.clearArea = new ClearArea([bar, this.problems.element], [compare.bar], panels, below, this.tray.element, (clear) => {
      this.viewer.setClear(clear);
      this.model.tell("clear");
    });
    const preferred = matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";
    this.setTheme((localStorage.getItem("ringlet-theme") as "dark" | "light" | null) ?? preferred);
    this.model.link = new Link(
      (message) => this.model.take(message),
      (state, why) => this.connected(state, why),
      () => this.model.welcome !== null && this.model.role.leads,
      ownName,
    );
    this.model.hear("welcome", (message) => this.welcome(message));
    this.model.hear("share_page", (message) => this.sharePage(message));
    addEventListener("beforeunload", (event) => {
      (document.activeElement as HTMLElement | null)?.blur(); // what is typed counts
      if (document.documentElement.dataset["link"] !== "open" && this.model.link?.unanswered) event.preventDefault();
    });
    this.model.link.start();
  }

  /** Whether panels and picture have their sizes. */
  get laidOut(): boolean {
    return this.clearArea.settled && this.viewer.fitted;
  }

  /**
   * Whether nothing is to come until someone does something: all that was said is answered, the groom is what the recipe
   * says, panels have their places, and the picture shows all that. Finer drawings of the same may still come.
   */
  get settled(): boolean {
    const { model, viewer, look } = this;
    return Boolean(model.link?.answered) && model.settled && look.settled && this.laidOut && viewer.current;
  }

  private setTheme(theme?: "dark" | "light"): void {
    const now = document.documentElement.dataset["theme"];
    const next = theme ?? (now === "dark" ? "light" : "dark");
    document.documentElement.dataset["theme"] = next;
    localStorage.setItem("ringlet-theme", next);
  }

  private connected(state: LinkState, why: string): void {
    document.documentElement.dataset["link"] = state;
    this.problems.keep(state === "open" ? "" : why);
    if (state !== "lost") return;
    for (const [file, known] of Object.entries(this.model.documents))
      if (known.dirty && this.model.role.leads) {
        const { text, edits, saved, saved_edits } = known;
        this.kept[file as "recipe" | "shot"] = { text, edits, saved, saved_edits };
      }
  }

  /** The picture shows what comes before panels hear of it. */
  private fillPicture(): void {
    const { model, viewer } = this;
    model.hear("body", (message) => viewer.stage.setBody(message));
    model.hear("hairs", (message) => viewer.stage.setHairs(message));
    model.hear("colors", (message) => viewer.stage.setColors(message));
    model.hear("locks", (message) => viewer.setLocks(message));
    model.hear("guides", (message) => {
      model.guides = message;
      viewer.guides.set(message);
      model.tell("guides");
      viewer.invalidate();
    });
  }

  /** The server is there, for the first time or again. */
  private welcome(message: Welcome): void {
    const { model, viewer } = this;
    model.link?.met(message.heard);
    if (model.welcome && (model.welcome.name !== message.name || model.welcome.mode !== message.mode)) this.reset();
    else if (this.session && this.session !== message.session) {
      model.numbers = null;
      model.problems = [];
      for (const side of model.others) viewer.compare(side, false); // the new server compares nothing
      model.compared = {};
      model.tell("compared");
      if (!message.recovered) this.giveBack();
    }
    this.kept = {};
    this.session = message.session;
    model.welcome = message;
    if (message.mode === "shot" && !model.documents.shot) model.choose("shot", ["strands"]);
    model.tell("welcome");
    this.timeline.found();
  }

  private sharePage({ text, name, hairs, of }: SharePage): void {
    keep(new Blob([text as BlobPart], { type: "text/html" }), name);
    const fewer = hairs < of ? `, with ${hairs} of its ${of} hairs` : "";
    this.notices.show(`${name} is saved: ${(text.length / 1e6).toFixed(1)} MB${fewer}`);
  }

  private endComparison(): void {
    const { model } = this;
    if (model.timeline?.against) model.say({ kind: "against", name: "" });
    else for (const side of model.others) model.say({ kind: "compare", to: "none", side: side as "b" });
  }

  /** Another file is open. */
  private reset(): void {
    this.model.reset();
    this.lock.choose(-1);
    this.brush.show(false);
    this.paint.show(false);
    this.draw.show(false);
    this.viewer.reset();
    for (const topic of ["document", "timeline", "guides", "compared", "chosen"] as const) this.model.tell(topic);
  }

  /** The server was started anew: it gets what had not been saved, as one step that can be undone. */
  private giveBack(): void {
    for (const [file, kept] of Object.entries(this.kept))
      this.model.say({ kind: "restore", file: file as "recipe" | "shot", ...kept });
  }
}

/** Unsaved texts of a file, and those that were read or saved last. */
type Unsaved = Record<"text" | "edits" | "saved" | "saved_edits", string>;

const app = new App(document.getElementById("app")!);
Object.assign(window, { ringlet: app });
