// Making elements in one expression, and what stands in them.

type Attributes = Record<string, unknown>;
type Child = Node | string | null | undefined | false;

/** `h("button", { class: "quiet", onclick: save }, "Save")`: what begins with "on" is a listener. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value as EventListener);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(
    ...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false),
  );
  return element;
}

/** A number of things, its thousands apart. An `Intl` for it would take longer than the rest of a first sight. */
export function count(n: number): string {
  return String(n).replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

/** An icon of a few strokes in a box of 20 by 20. */
export function icon(path: string): SVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 20 20");
  svg.setAttribute("aria-hidden", "true");
  svg.classList.add("icon");
  const stroke = document.createElementNS("http://www.w3.org/2000/svg", "path");
  stroke.setAttribute("d", path);
  svg.append(stroke);
  return svg;
}

export const ICONS = {
  undo: "M7 5 3.5 8.5 7 12M4 8.5h7.5a4.5 4.5 0 0 1 0 9H8",
  redo: "M13 5l3.5 3.5L13 12M16 8.5H8.5a4.5 4.5 0 0 0 0 9H12",
  eye: "M2 10s3-5.5 8-5.5S18 10 18 10s-3 5.5-8 5.5S2 10 2 10zM10 7.7a2.3 2.3 0 1 0 0 4.6 2.3 2.3 0 0 0 0-4.6z",
  hidden: "M3 3l14 14M8 5c6-1.5 10 5 10 5s-.8 1.5-2.4 3M5 6.6C3 8 2 10 2 10s3 5.5 8 5.5c1 0 2-.2 2.8-.6",
  up: "M5 12l5-5 5 5",
  down: "M5 8l5 5 5-5",
  pen: "M3 17l1-4L14 3l3 3L7 16zM12 5l3 3",
  pin: "M7 3h6l-1 5 3 3H5l3-3zM10 11v6",
  bin: "M4 6h12M8 6V4h4v2M6 6l.7 10h6.6L14 6",
  plus: "M10 4v12M4 10h12",
  camera: "M3 7h3l1.5-2h5L14 7h3v9H3zM10 8.7a2.6 2.6 0 1 0 0 5.2 2.6 2.6 0 0 0 0-5.2z",
  live: "M5 3c4 3-2 6 0 9s-1 3 0 5M10 3c4 3-2 6 0 9s-1 3 0 5M15 3c4 3-2 6 0 9s-1 3 0 5",
  film: "M3 5h14v10H3zM3 8h2M3 12h2M15 8h2M15 12h2M9 8l3 2-3 2z",
  render: "M4 15.5 10 3l6 12.5zM7.5 9.5l5 6M10 3v12.5",
  turn: "M16 10a6 6 0 1 1-2-4.5M14.5 2.5V6H11",
  frame: "M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4",
  sun: "M10 6.5a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7zM10 2v1.5M10 16.5V18M2 10h1.5M16.5 10H18M4.3 4.3l1 1M14.7 14.7l1 1M15.7 4.3l-1 1M5.3 14.7l-1 1",
  dice: "M4 4h12v12H4zM7.5 7.5h.01M12.5 12.5h.01M12.5 7.5h.01M7.5 12.5h.01",
  reset: "M5 10a5 5 0 1 1 1.5 3.5M5 14v-4h4",
  play: "M6 4l10 6-10 6z",
  pause: "M7 4v12M13 4v12",
  again: "M4 4v5h5M4.5 9A6 6 0 1 1 4 12",
  brush: "M13 3l4 4-6.5 6.5-4-4zM6.5 9.5c-2.5.3-1.8 3.8-4 5.5 2.5 1.2 7.3.6 8-1.5",
  folder: "M3 6h5l1.5 2H17v8H3zM3 6v10",
  keys: "M3 6h14v8H3zM6 9h.01M9 9h.01M12 9h.01M14 9h.01M7 11.5h6",
  share: "M10 12V3M6.5 6.5L10 3l3.5 3.5M5 9.5H4v8h12v-8h-1",
  link: "M8.5 11.5l3-3M9 6l1.7-1.7a3.5 3.5 0 0 1 5 5L14 11M11 14l-1.7 1.7a3.5 3.5 0 0 1-5-5L6 9",
  chart: "M3 16V4M3 16h14M5 12c2-7 3-7 4.5-2S13 14 16 6",
  swap: "M3 7h12l-3-3M17 13H5l3 3",
  close: "M5 5l10 10M15 5L5 15",
  tray: "M3 12h14v5H3zM5 8.5h10M7 5h6",
  snapshot: "M4 4h12v12H4zM10 7v6M7 10h6",
  pipette: "M11 6l3 3M13 3.5l3.5 3.5-2.5 2.5-3.5-3.5zM12 7l-7 7-1 3 3-1 7-7",
  lens: "M10 3a7 7 0 1 0 0 14 7 7 0 0 0 0-14zM10 6.5a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7z",
  load: "M10 3v9M6 8.5l4 4 4-4M4 16.5h12",
  solo: "M10 3l2 5h5l-4 3.2 1.5 5.3L10 13.3 5.5 16.5 7 11.2 3 8h5z",
} as const;

export function iconButton(name: keyof typeof ICONS, label: string, onclick: () => void, more: Attributes = {}) {
  return h(
    "button",
    { type: "button", class: "icon-button", title: label, "aria-label": label, onclick, ...more },
    icon(ICONS[name]),
  );
}
