// The page: connects what the server says with the picture and the panels.

import { h } from "./dom";
import { keepFocus } from "./focus";
import type { Link, LinkState } from "./link";
import { Model } from "./model";
import { Bar } from "./panel/bar";
import { HandTools } from "./panel/hand_tools";
import { ClearArea } from "./panel/clear_area";
import { CompareBar } from "./panel/compare";
import { bindKey, plainKey } from "./panel/keys";
import { Dock } from "./panel/dock";
import { HeadHandle } from "./panel/head_handle";
import { Lens } from "./panel/lens";
import { LiveHair } from "./panel/live";
import { LiveSides } from "./panel/live_sides";
import { LockTool } from "./panel/lock";
import { Look } from "./panel/look";
import { Notes } from "./panel/notes";
import { People } from "./panel/people";
import { PresenterPointer } from "./panel/pointer";
import { References } from "./panel/references";
import { RenderPanel } from "./panel/render";
import { Settings } from "./panel/settings";
import { Snapshots } from "./panel/snapshots";
import { Stack } from "./panel/stack";
import { PresetTool } from "./panel/presets";
import { ProblemBar } from "./panel/problems";
import { Notices, Status } from "./panel/status";
import { TakePlayer } from "./panel/takes";
import { TimelineBar } from "./panel/timeline";
import { Viewbar } from "./panel/viewbar";
import { Sheets } from "./panel/sheets"; // the last of the panels, since its style places the others on a phone
import type { SharePage, Welcome } from "./protocol";
import { skips } from "./panel/skips";
import { Unsaved } from "./unsaved";
import { keep } from "./view/capture";
import { LOST_PICTURE } from "./view/context";
import { Viewer } from "./view/viewer";

export class App {
  readonly model = new Model();
  readonly viewer: Viewer;
  readonly timeline: TimelineBar;
  readonly live: LiveHair;
  readonly lock: LockTool;
  readonly tools: HandTools;
  readonly look: Look;
  readonly render: RenderPanel;
  readonly dock: Dock;
  private readonly notices = new Notices(this.model);
  private readonly problems: ProblemBar;
  private readonly status = new Status(this.model);
  private readonly clearArea: ClearArea;
  private readonly unsaved = new Unsaved(this.model);
  private session = "";

  constructor(root: HTMLElement, link: Link) {
    const { model } = this;
    const picture = h("main", { class: "picture" });
    const people = new People(model, () => this.look, this.notices);
    this.problems = new ProblemBar(model, people.questions);
    root.append(picture);
    this.viewer = new Viewer(picture);
    const { viewer } = this;
    this.fillPicture();
    const reload = h("button", { type: "button", class: "quiet", onclick: () => location.reload() }, "Load the page again");
    viewer.onLost = () => this.problems.keep("picture", LOST_PICTURE, reload);

    // What is in the hand, and how the groom is looked at
    this.lock = new LockTool(model, viewer);
    this.live = new LiveHair(model, viewer); // before the timeline: a frame is shown again once hair is at rest
    const { live } = this;
    new LiveSides(model, viewer);
    this.timeline = new TimelineBar(model, viewer, (frame) => this.status.simulated(frame.statistics));
    const sheets = new Sheets(model);
    this.tools = new HandTools(model, viewer, () => {
      this.lock.choose(-1);
      presets.show(false);
      sheets.open("stages");
    });
    const presets = new PresetTool(model, viewer);
    presets.opened = () => this.tools.layDown();
    live.buttons.prepend(this.tools.hand.button);
    this.lock.busy = () => this.tools.busy;
    bindViewKeys(viewer);
    const viewbar = new Viewbar(model, viewer, this.tools.brush, () => this.name);
    this.render = new RenderPanel(model, viewer, viewbar, () => this.name);
    this.look = new Look(model, viewer, viewbar, this.lock, this.timeline, this.notices);

    // What is kept next to the recipe
    this.dock = new Dock(() => this.look.introduce());
    const { dock } = this;
    const settings = new Settings(model);
    dock.add(settings.tab);
    dock.add(this.timeline.tab);
    for (const topic of ["document", "timeline"] as const) model.on(topic, () => dock.update());
    this.timeline.openChart = (shown) => (dock.isShown(this.timeline.tab) && !shown ? dock.goBack() : dock.open(this.timeline.tab));
    const snapshots = new Snapshots(model, viewer, this.look, dock, this.notices);
    const takes = new TakePlayer(model, viewer, this.timeline, () => snapshots.take("keep_take"));
    snapshots.play = (id) => takes.play(id);
    snapshots.makeShot = (id) => takes.makeShot(id);
    live.buttons.append(takes.keep);
    const notes = new Notes(model, viewer, this.look, dock);
    const references = new References(model, viewer, dock, this.notices);
    dock.element.append(this.status.element);
    dock.opened = () => sheets.open("settings");
    dock.uncover = () => sheets.open("");
    settings.search.left = () => viewer.canvas.focus();
    sheets.settings = settings.search.wanted = () => dock.open(settings.tab);

    // What is over the picture goes with it
    const pointer = new PresenterPointer(model, viewer);
    const head = new HeadHandle(model, viewer, () => this.tools.busy);
    picture.append(head.element, this.lock.handles, this.tools.brush.ring, pointer.element, this.render.element, references.element, notes.marks);
    viewer.onPaint = () => [this.lock, pointer, notes, head].forEach((one) => one.place());
    viewer.onDraw = (statistics) => this.status.drew(statistics);

    // The panels around it
    const lens = new Lens(model, viewer, this.look, () => this.name);
    viewbar.element.append(live.button, live.line, lens.button, snapshots.button, dock.button);
    const bar = new Bar(model, () => this.setTheme(), people.element, () => this.endComparison()).element;
    const compare = new CompareBar(model, viewer, () => this.endComparison());
    compare.bar.append(takes.element);
    const stack = new Stack(model, () => presets.show(true));
    const left = h("div", { class: "left" }, stack.element, presets.element, this.lock.element, ...this.tools.elements);
    const lower = h("div", { class: "lower" }, h("nav", { "aria-label": "View" }, viewbar.element), this.timeline.element);
    const back = () => dock.open(settings.tab);
    root.prepend(skips([["stages", left, back], ["settings", settings.element, back], ["view", viewbar.element]]));
    root.append(bar, left, dock.element, lower, compare.element, lens.element, this.notices.element, this.problems.element, sheets.element);
    keepFocus(document.body, viewer.canvas);
    const below = [viewbar.element, this.timeline.element, sheets.element];
    const panels = [...left.children, dock.element] as HTMLElement[];
    this.clearArea = new ClearArea([bar, this.problems.element], [compare.bar], panels, below, (clear) => {
      viewer.setClear(clear);
      model.tell("clear");
    });
    const preferred = matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";
    this.setTheme((localStorage.getItem("ringlet-theme") as "dark" | "light" | null) ?? preferred);
    this.connect(link);
  }

  /** What is open, without the ends of its file name. */
  private get name(): string {
    return (this.model.welcome?.name ?? "ringlet").split(".")[0];
  }

  private connect(link: Link): void {
    const { model } = this;
    model.hear("welcome", (message) => this.welcome(message));
    model.hear("share_page", (message) => this.sharePage(message));
    model.link = link;
    addEventListener("beforeunload", (event) => {
      (document.activeElement as HTMLElement | null)?.blur(); // what is typed counts
      if (document.documentElement.dataset["link"] !== "open" && link.unanswered) event.preventDefault();
    });
    link.tell({
      hear: (message) => model.take(message),
      changed: (state, why) => this.connected(state, why),
      leads: () => model.welcome !== null && model.role.leads,
    });
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
    const whole = viewer.hair.a.all === model.numbers?.hairs; // and no glimpse of few hairs
    return Boolean(model.link?.answered) && model.settled && whole && look.settled && this.laidOut && viewer.current;
  }

  private setTheme(theme?: "dark" | "light"): void {
    const now = document.documentElement.dataset["theme"];
    const next = theme ?? (now === "dark" ? "light" : "dark");
    document.documentElement.dataset["theme"] = next;
    localStorage.setItem("ringlet-theme", next);
  }

  private connected(state: LinkState, why: string): void {
    document.documentElement.dataset["link"] = state;
    this.problems.keep("link", state === "open" ? "" : why);
    if (state === "lost") this.unsaved.keep();
  }

  /** The picture shows what comes before panels hear of it. */
  private fillPicture(): void {
    const { model, viewer } = this;
    model.hear("subject", ({ low, high }) => viewer.frameSkin(low, high));
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
      model.putAtRest(); // nor does it move hair
      if (!message.recovered) this.unsaved.giveBack();
    }
    this.unsaved.forget();
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
    this.tools.layDown();
    this.viewer.reset();
    for (const topic of ["document", "timeline", "guides", "compared", "chosen", "live"] as const) this.model.tell(topic);
  }
}

function bindViewKeys(viewer: Viewer): void {
  const bind = (keys: string, does: string, ...all: string[]) =>
    bindKey({ section: "View", keys, does, on: plainKey(...all), run: (event) => void viewer.key(event.key) });
  bind("Arrows", "orbit the camera", "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown");
  bind("+ and -", "zoom in, zoom out", "+", "=", "-");
  bind("F", "frame all hair", "f");
}
