// The focus outlives the control that has it. A control that is rebuilt, disabled or hidden would leave it to nothing, and a
// keyboard at the top of the page: it goes to what has the place of the control now.

const CONTROLS = "button, input, select, textarea, summary, a[href], [tabindex]";
/** Fields in which a text is typed. */
export const TYPED = "input:not([type=range], [type=checkbox], [type=radio], [type=color]), textarea";
const AREAS = "dialog, nav, aside, header, main, [role=toolbar], [role=tabpanel], .panel";

/** What tells a control from the others of its area, also after it was built anew. */
function nameOf(control: Element): string {
  const { setting, id } = control.closest<HTMLElement>("[data-setting], [data-id]")?.dataset ?? {};
  const { stage } = (control as HTMLElement).dataset;
  const label = control.getAttribute("aria-label") ?? (control as HTMLInputElement).labels?.[0]?.textContent ?? control.textContent;
  return JSON.stringify([control.tagName, control.getAttribute("type"), setting, id, stage ?? label]);
}

function usable(control: Element): boolean {
  return control.isConnected && !control.matches(":disabled") && !control.closest("[hidden]") && control.checkVisibility();
}

/** Ends what is typed, so that it counts, and goes on in the same field. */
export function endTyping(): void {
  const field = document.activeElement;
  if (!(field instanceof HTMLElement) || !field.matches("input, textarea, select")) return;
  field.blur();
  field.focus({ preventScroll: true });
}

/** Keeps the focus on a page; `otherwise` gets it where a whole area is gone, or a pointer has pressed what is. */
export function keepFocus(root: HTMLElement, otherwise: HTMLElement): void {
  let last: HTMLElement | null = null;
  let under: Element | null = null; // the pointer, when it was pressed last
  let pressed = false; // a button by a pointer: keys are meant for the page then
  let name = "";
  let areas: { area: Element; index: number }[] = []; // around it, and its place among their controls
  const controls = (area: Element) => [...area.querySelectorAll<HTMLElement>(CONTROLS)].filter((one) => one.tabIndex >= 0);

  root.addEventListener("focusin", ({ target }) => {
    last = target as HTMLElement;
    name = nameOf(last);
    pressed = last.matches("button, summary, a") && last.contains(under);
    areas = [];
    for (let area = last.closest(AREAS); area; area = area.parentElement?.closest(AREAS) ?? null)
      areas.push({ area, index: controls(area).indexOf(last) });
  });
  const press = ({ target }: Event) => {
    last = null; // what is pressed gets the focus after this, or nothing does
    under = target as Element;
  };
  root.addEventListener("pointerdown", press, { capture: true });
  root.addEventListener("focusout", ({ target }) =>
    Promise.resolve().then(() => {
      if (target === last && usable(last as HTMLElement) && document.activeElement !== last) last = null; // it was given up
    }),
  );
  root.addEventListener("keydown", () => (under = null), { capture: true });

  const keep = () => {
    const { activeElement } = document;
    if (!last || usable(last) || (activeElement && activeElement !== document.body && activeElement !== last)) return;
    for (const { area, index } of pressed ? [] : areas) {
      if (!area.isConnected) continue;
      const all = controls(area);
      const same = all.find((one) => nameOf(one) === name && usable(one));
      const free = (one: HTMLElement) => usable(one) && !one.matches(TYPED); // where keys stay commands
      const next = all.slice(index).find(free) ?? all.slice(0, index).reverse().find(free);
      const to = same ?? next;
      if (to) return to.focus({ preventScroll: true });
    }
    otherwise.focus({ preventScroll: true });
  };
  new MutationObserver(keep).observe(root, { subtree: true, childList: true, attributes: true, attributeFilter: ["disabled", "hidden"] });
}
