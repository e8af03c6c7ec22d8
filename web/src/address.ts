// What stands after "#" in the address: the token of the server, and the view that a link leads to.

import type { Followed } from "./protocol";

export type View = Omit<Followed, "kind">;

const parts = (hash: string) => hash.replace(/^#/, "").split("&");

/** The token of the server; empty on this computer. */
export function tokenOf(hash: string): string {
  return parts(hash).find((part) => !part.includes("=")) ?? "";
}

/** The view that a link leads to, and the file that it is of; null for an address without one. */
export function viewOf(hash: string): { name: string; view: View } | null {
  const values = new URLSearchParams(parts(hash).filter((part) => part.includes("=")).join("&"));
  const numbers = (text: string | null) => (text ? text.split(",").map(Number) : []);
  const camera = numbers(values.get("camera"));
  if (camera.length !== 6 || !camera.every(Number.isFinite)) return null;
  const [file, ...place] = (values.get("stage") ?? "recipe/curl").split("/");
  const number = (key: string, otherwise: number) => {
    const value = Number(values.get(key) ?? otherwise);
    return Number.isFinite(value) ? value : otherwise;
  };
  const frame = values.has("frame") ? Number(values.get("frame")) : null;
  return {
    name: values.get("of") ?? "",
    view: {
      camera,
      focal_length: number("lens", 85),
      light_turn: number("turn", 0),
      light: values.get("light") ?? "",
      color: values.get("color") ?? "",
      overlay: values.get("overlay") ?? "",
      file: file === "shot" ? "shot" : "recipe",
      place: place.map((part) => (/^\d+$/.test(part) ? Number(part) : part)),
      locks: numbers(values.get("locks")).filter(Number.isSafeInteger),
      frame: Number.isFinite(frame) ? frame : null,
      looks: null,
      step: null,
    },
  };
}

/** The address of a view of a file; without a view, that of the server alone. */
export function addressOf(hash: string, link?: { name: string; view: View }): string {
  const token = tokenOf(hash);
  const values: [string, string][] = [];
  if (link) {
    const { camera, focal_length, light_turn, light, color, overlay, file, place, locks, frame } = link.view;
    values.push(["of", link.name], ["camera", camera.map((value) => value.toFixed(4)).join(",")], ["light", light]);
    values.push(["color", color], ["overlay", overlay], ["stage", [file, ...place].join("/")], ["locks", locks.join(",")]);
    values.push(["lens", String(focal_length)], ["turn", light_turn ? String(light_turn) : ""]);
    if (frame !== null) values.push(["frame", String(frame)]);
  }
  const said = values.filter(([, value]) => value !== "").map(([key, value]) => `${key}=${encodeURIComponent(value)}`);
  const { origin, pathname, search } = location;
  const behind = [token, ...said].filter(Boolean).join("&").replaceAll("%2C", ",").replaceAll("%2F", "/");
  return `${origin}${pathname}${search}${behind ? `#${behind}` : ""}`;
}
