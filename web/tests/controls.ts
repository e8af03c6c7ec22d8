// Hands on the page: finding controls by what they are called, and using them with the events of a browser.

const CONTROLS = "button, input, select, textarea, summary, [role=slider], [role=tab], [role=option]";

/** What a control is called. */
function nameOf(element: Element): string {
  const labelled = element.getAttribute("aria-label") ?? element.id ? document.querySelector(`label[for="${element.id}"]`) : null;
  const around = element.closest("label");
  return (element.getAttribute("aria-label") ?? labelled?.textContent ?? (element.matches("button, summary") ? element.textContent : around?.textContent) ?? "").trim();
}

const hidden = (element: Element) => element.closest("[hidden]") !== null;

/** The control of a name that is in sight, or of one that begins with it. */
export function control<E extends HTMLElement = HTMLElement>(name: string, within: ParentNode = document): E {
  const all = [...within.querySelectorAll(CONTROLS)].filter((one) => !hidden(one));
  const found = all.find((one) => nameOf(one) === name) ?? all.find((one) => nameOf(one).startsWith(name));
  if (!found) throw new Error(`no control ‘${name}’ among ${all.map(nameOf).join(", ")}`);
  return found as E;
}

/** The element of a selector. */
export function find<E extends Element = HTMLElement>(selector: string, within: ParentNode = document): E {
  const found = within.querySelector<E>(selector);
  if (!found) throw new Error(`nothing is ${selector}`);
  return found;
}

/** Texts of all elements of a selector. */
export const texts = (selector: string, within: ParentNode = document): string[] =>
  [...within.querySelectorAll(selector)].map((one) => one.textContent!.trim());

/** The open dialog. */
export const dialog = () => find("dialog[open]");

/** The slider and the number of a setting. */
export const slider = (setting: string) => find<HTMLInputElement>(`[data-setting="${setting}"] > input[type=range]`);
export const number = (setting: string) => find<HTMLInputElement>(`[data-setting="${setting}"] > .field-head input.number`);

/** Presses a key where the focus is; whether the page took it. */
export function press(key: string, more: KeyboardEventInit = {}, target: Element = document.activeElement ?? document.body): boolean {
  const options = { key, bubbles: true, cancelable: true, ...more };
  const taken = !target.dispatchEvent(new KeyboardEvent("keydown", options));
  target.dispatchEvent(new KeyboardEvent("keyup", options));
  return taken;
}

/** Types a text in place of what is there. */
export function fill(input: HTMLInputElement | HTMLTextAreaElement, text: string): void {
  input.focus();
  input.value = text;
  input.dispatchEvent(new Event("input", { bubbles: true }));
}

/** Types a text and ends it with the key Enter. */
export function enter(input: HTMLInputElement, text: string): void {
  fill(input, text);
  if (!press("Enter", {}, input)) input.dispatchEvent(new Event("change", { bubbles: true }));
}

/** Chooses an entry of a list. */
export function choose(list: HTMLElement, value: string): void {
  (list as HTMLSelectElement).value = value;
  list.dispatchEvent(new Event("change", { bubbles: true }));
}

/** Turns a switch. */
export function check(box: HTMLElement, on = true): void {
  (box as HTMLInputElement).checked = on;
  box.dispatchEvent(new Event("change", { bubbles: true }));
}

/** Moves the knob of a slider through values, and lets go; a browser says no `change` where it ends as it began. */
export function slide(input: HTMLInputElement, ...values: number[]): void {
  const before = input.value;
  input.dispatchEvent(new PointerEvent("pointerdown", { bubbles: true }));
  for (const value of values) {
    input.value = String(value);
    input.dispatchEvent(new Event("input", { bubbles: true }));
  }
  input.dispatchEvent(new PointerEvent("pointerup", { bubbles: true }));
  if (input.value !== before) input.dispatchEvent(new Event("change", { bubbles: true }));
}

/** Drags from a place to others on an element. */
export function drag(element: Element, from: [number, number], to: [number, number][], more: PointerEventInit = {}): void {
  const event = (name: string, [clientX, clientY]: [number, number]) =>
    element.dispatchEvent(new PointerEvent(name, { clientX, clientY, button: 0, pointerId: 1, bubbles: true, ...more }));
  event("pointerdown", from);
  for (const place of to) event("pointermove", place);
  event("pointerup", to.at(-1)!);
}
