// What one does with the picture: light, colour, where from, and pictures to keep.

import "./floating_bar.css";
import "./viewbar.css";
import { h, iconButton } from "../dom";
import type { Model } from "../model";
import type { BrushTool } from "./brush";
import { savePicture } from "./picture";
import { Recorder } from "../view/capture";
import { OVERLAYS, type OverlayName } from "../view/overlays";
import type { Viewer } from "../view/viewer";

const VIEWS: [string, number, number][] = [
  ["Three-quarter", 34, 7],
  ["Front", 0, 4],
  ["Left", 90, 4],
  ["Back", 180, 8],
  ["Right", -90, 4],
  ["Above", 20, 60],
];

export class Viewbar {
  readonly light = h("select", { "aria-label": "Light" });
  readonly color = h("select", { "aria-label": "Hair color" });
  private readonly overlay = h("select", { "aria-label": "Overlay" });
  readonly element = h("div", { class: "viewbar", role: "toolbar", "aria-label": "View" });

  constructor(
    private readonly model: Model,
    viewer: Viewer,
    brush: BrushTool,
    name: () => string,
  ) {
    const { light, color, overlay } = this;
    viewer.onLook = () => model.tell("look");
    light.addEventListener("change", () => {
      const rig = model.welcome?.rigs[light.value];
      if (rig) viewer.stage.setLights(rig);
      model.tell("look");
    });

    color.addEventListener("change", () => {
      const colors = model.welcome?.colors ?? {};
      viewer.stage.setColour(colors[color.value] ?? null, colors["dark_brown"]);
      model.tell("look");
    });
    model.on("welcome", () => {
      const names = Object.keys(this.model.welcome?.colors ?? {});
      const before = color.value;
      const named = names.map((one) => h("option", { value: one }, one.replaceAll("_", " ")));
      color.replaceChildren(h("option", { value: "" }, "as groomed"), ...named);
      color.value = before;
      color.dispatchEvent(new Event("change"));
      const rigs = Object.entries(this.model.welcome?.rigs ?? {});
      const lit = light.value || rigs[0]?.[0];
      light.replaceChildren(...rigs.map(([key, rig]) => h("option", { value: key }, rig.label)));
      light.value = this.model.welcome?.rigs[lit] ? lit : rigs[0]?.[0];
      light.dispatchEvent(new Event("change"));
    });

    const from = h("select", { "aria-label": "View from" });
    from.append(h("option", { value: "", hidden: true }, "free view"), ...VIEWS.map(([label]) => h("option", { value: label }, label)));
    let [[, azimuth, elevation]] = VIEWS;
    const frame = () => viewer.frame(azimuth, elevation);
    from.value = VIEWS[0][0];
    from.addEventListener("change", () => {
      [, azimuth, elevation] = VIEWS.find(([label]) => label === from.value)!;
      frame();
    });
    model.on("look", () => {
      const { framed } = viewer.view;
      from.value = VIEWS.find(([, a, e]) => framed?.[0] === a && framed[1] === e)?.[0] ?? "";
    });

    const legend = h("div", { class: "legend", hidden: true, role: "note" });
    overlay.addEventListener("change", () => {
      model.overlay = overlay.value as OverlayName | "";
      model.tell("overlay");
      this.explain(legend);
    });
    const offer = () => {
      const known = Object.entries(OVERLAYS).filter(([, one]) => !one.moving || model.timeline);
      overlay.replaceChildren(
        h("option", { value: "" }, "no overlay"),
        ...known.map(([key, one]) => h("option", { value: key }, one.label)),
      );
      overlay.value = model.overlay;
    };
    offer();
    model.on("timeline", () => {
      if (overlay.options.length < 5) offer();
    });

    const sculpt = iconButton("brush", "Sculpt guides", () => brush.show(!brush.on));
    sculpt.setAttribute("aria-pressed", "false");
    for (const topic of ["guides", "document"] as const)
      model.on(topic, () => sculpt.toggleAttribute("hidden", !model.guides || !model.documents.recipe));
    sculpt.toggleAttribute("hidden", true);
    brush.changed.push((on) => sculpt.setAttribute("aria-pressed", String(on)));

    const turn = iconButton("turn", "Turntable", () => {
      viewer.turntable = !viewer.turntable;
      turn.setAttribute("aria-pressed", String(viewer.turntable));
      viewer.move();
    });
    turn.setAttribute("aria-pressed", "false");

    const none = { disabled: !viewer.renderer };
    const recorder = new Recorder(viewer);
    const film = iconButton("film", "Record a movie", () => {
      if (recorder.running) recorder.stop(name());
      else recorder.start();
      film.setAttribute("aria-pressed", String(recorder.running));
      const began = performance.now();
      const tell = () => {
        const seconds = Math.floor((performance.now() - began) / 1000);
        recorded.textContent = `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
      };
      clearInterval(ticking);
      recorded.hidden = !recorder.running;
      if (!recorder.running) return;
      tell();
      ticking = window.setInterval(tell, 250);
    }, none);
    let ticking = 0;
    const recorded = h("output", { class: "recorded", hidden: true, "aria-label": "Recorded time" });
    film.setAttribute("aria-pressed", "false");

    this.element.append(
      sculpt,
      light,
      color,
      from,
      overlay,
      iconButton("frame", "Frame all hair (F)", frame),
      turn,
      iconButton("camera", "Save picture", () => savePicture(viewer, name()), none),
      film,
      recorded,
      iconButton("share", "Save a share page: one file that shows the look from all sides", () =>
        model.say({
          kind: "share",
          camera: [...viewer.camera.position.toArray(), ...viewer.controls.target.toArray()],
          light: light.value,
          color: color.value,
          theme: document.documentElement.dataset["theme"] === "light" ? "light" : "dark",
        }),
      ),
      legend,
    );
  }

  /** Chooses light, color and overlay. */
  choose(look: Record<"light" | "color" | "overlay", string>): void {
    for (const name of ["light", "color", "overlay"] as const) {
      const list = this[name];
      if (list.value === look[name] || ![...list.options].some((option) => option.value === look[name])) continue;
      list.value = look[name];
      list.dispatchEvent(new Event("change"));
    }
  }

  /** What the colours of the overlay say. */
  private explain(legend: HTMLElement): void {
    const { overlay } = this.model;
    legend.toggleAttribute("hidden", overlay === "");
    if (overlay === "") return;
    const { low, high, diverging } = OVERLAYS[overlay];
    const scale = h("span", { class: `scale${diverging ? " diverging" : ""}` });
    legend.replaceChildren(low, scale, high);
  }
}
