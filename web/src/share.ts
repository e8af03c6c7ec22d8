// The share page: a look to turn, from the data in the page itself. It talks to nobody.

import "./base.css";
import "./share.css";
import { decode } from "./codec";
import { count, h, iconButton } from "./dom";
import type { Rig } from "./protocol";
import type { Colour } from "./view/hair";
import { Viewer } from "./view/viewer";

/** A snapshot or a note of the review. */
interface Said {
  author: string;
  text: string;
  time: string;
  picture?: string;
  camera?: number[];
}

interface About {
  name: string;
  file: string;
  view: { camera?: number[]; light?: string; color?: string; theme?: "dark" | "light" };
  hairs: number;
  of: number;
  snapshots?: Said[];
  notes?: Said[];
  colors: Record<string, Colour>;
  rigs: Record<string, Rig>;
}

const text = (id: string): string => document.getElementById(id)!.textContent ?? "";

class SharedLook {
  readonly viewer: Viewer;
  /** Whether all of the look is there. */
  ready = false;
  private readonly about = JSON.parse(text("about")) as About;
  private readonly turn = iconButton("turn", "Turn (space)", () => this.setTurning(!this.viewer.turntable));
  private readonly status = h("p", { class: "status", role: "status" }, "Unpacking the look …");

  constructor(root: HTMLElement) {
    const { name, view } = this.about;
    const picture = h("main", { class: "picture" });
    root.append(picture);
    this.viewer = new Viewer(picture);
    root.append(
      h("header", { class: "about" }, h("h1", {}, name), this.status),
      h(
        "nav",
        { "aria-label": "View" },
        h(
          "div",
          { class: "tools", role: "toolbar", "aria-label": "View" },
          this.turn,
          this.lights(),
          iconButton("frame", "Frame all hair (F)", () => this.viewer.frame()),
          iconButton("sun", "Dark or light theme", () => this.setTheme(this.theme === "dark" ? "light" : "dark")),
        ),
      ),
    );
    root.append(this.shelf());
    this.setTheme(view.theme ?? "dark");
    const { colors, rigs } = this.about;
    this.viewer.stage.setLights(rigs[view.light ?? ""] ?? Object.values(rigs)[0]);
    this.viewer.stage.setColour(colors[view.color ?? ""] ?? null, colors["dark_brown"]);
    this.viewer.controls.addEventListener("start", () => this.setTurning(false));
    addEventListener("keydown", (event) => this.key(event));
    this.unpack().catch((error) => (this.status.textContent = `The look cannot be shown: ${error}`));
  }

  private get theme(): string {
    return document.documentElement.dataset["theme"] ?? "dark";
  }

  private async unpack(): Promise<void> {
    const packed = Uint8Array.from(atob(text("look")), (letter) => letter.charCodeAt(0));
    document.getElementById("look")!.remove();
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    const data = await new Response(stream).arrayBuffer();
    const sizes = new DataView(data);
    for (let at = 0; at < data.byteLength; ) {
      const size = sizes.getUint32(at, true);
      this.take(data.slice(at + 4, at + 4 + size));
      at += 4 + size;
    }
    const { hairs, of, view } = this.about;
    if (view.camera?.length === 6) this.viewer.lookFrom(view.camera);
    this.status.textContent = hairs < of ? `${count(hairs)} of ${count(of)} hairs, drawn wider` : `${count(of)} hairs`;
    this.setTurning(!matchMedia("(prefers-reduced-motion: reduce)").matches);
    this.ready = true;
  }

  private take(data: ArrayBuffer): void {
    const message = decode(data);
    if (message.kind === "body") this.viewer.stage.setBody(message);
    else if (message.kind === "hairs") this.viewer.stage.setHairs(message);
    else if (message.kind === "colors") this.viewer.stage.setColors(message);
    else if (message.kind === "locks") this.viewer.setLocks(message);
  }

  private lights(): HTMLElement {
    const list = h("select", { "aria-label": "Light" });
    const { rigs, view } = this.about;
    for (const [key, { label }] of Object.entries(rigs)) list.append(h("option", { value: key }, label));
    list.value = view.light && rigs[view.light] ? view.light : Object.keys(rigs)[0];
    list.addEventListener("change", () => this.viewer.stage.setLights(rigs[list.value]));
    return list;
  }

  /** Notes, which lead to where they were written, and pictures of snapshots. */
  private shelf(): HTMLElement {
    const { notes = [], snapshots = [] } = this.about;
    const by = ({ author, time }: Said) => h("small", {}, [author, time.slice(0, 10)].filter(Boolean).join(", "));
    const see = (one: Said) => {
      this.setTurning(false);
      if (one.camera?.length === 6) this.viewer.lookFrom(one.camera);
    };
    const note = (one: Said) => h("li", {}, h("button", { type: "button", class: "said", onclick: () => see(one) }, one.text, by(one)));
    const picture = (one: Said) => h("li", {}, h("img", { src: one.picture, alt: one.text || "Snapshot" }), h("p", {}, one.text), by(one));
    const list = (label: string, rows: HTMLElement[]) => rows.length > 0 && h("section", {}, h("h2", {}, label), h("ul", {}, ...rows));
    const many = (count: number, one: string) => count > 0 && `${count} ${one}${count > 1 ? "s" : ""}`;
    const title = [many(notes.length, "note"), many(snapshots.length, "snapshot")].filter(Boolean).join(", ");
    const content = h("div", { class: "scrolls" }, list("Notes", notes.map(note)), list("Snapshots", snapshots.map(picture)));
    return h("details", { class: "shelf", hidden: !title }, h("summary", {}, title), content);
  }

  private setTurning(on: boolean): void {
    this.viewer.turntable = on;
    this.turn.setAttribute("aria-pressed", String(on));
    this.viewer.move();
  }

  private setTheme(theme: "dark" | "light"): void {
    document.documentElement.dataset["theme"] = theme;
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const control = (event.target as HTMLElement | null)?.closest("button, select");
    if (event.key === " " && !control) this.setTurning(!this.viewer.turntable);
    else if (control?.matches("select") || !this.viewer.key(event.key)) return;
    else this.setTurning(false);
    event.preventDefault();
  }
}

Object.assign(window, { look: new SharedLook(document.getElementById("app")!) });
