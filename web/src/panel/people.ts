// Who is there: their names and colors, whom one follows, who asks to edit, and the name of one's own.

import "./people.css";
import { h, iconButton } from "../dom";
import type { Model } from "../model";
import type { Person } from "../protocol";
import { NAME, ownName } from "./author";
import { bindKey, plainKey } from "./keys";
import type { Look } from "./look";
import type { Notices } from "./status";

const MOST_SEEN = 4; // people in the bar; the list has all
const RETURN = 3000; // after which a page that was there is not only loaded again [ms]

/** The color of a person, for CSS. */
export const colorOf = (person: Person): string => `oklch(0.5 0.13 ${(40 + 137.5 * person.hue) % 360})`;

export class People {
  /** In the bar: who is there, and what one can ask for. */
  readonly element = h("span", { class: "group people" });
  /** The question for a name, and the one of a page that asks to edit. */
  readonly questions = h("div", { class: "questions" });
  private readonly faces = h("button", { type: "button", class: "faces", popovertarget: "people" });
  private readonly list = h("ul", { class: "people-list", "aria-label": "People" });
  private readonly sheet = h("div", { id: "people", class: "people-sheet", popover: "auto", role: "dialog", "aria-label": "Who is here" });
  private readonly follow = h("button", { type: "button", class: "quiet" });
  private readonly lead = h("button", { type: "button", class: "quiet" }, "Ask to edit");
  private readonly name = h("input", { type: "text", id: "person-name", maxlength: 40, autocomplete: "nickname" });
  private readonly asked = h("input", { type: "text", id: "person-asked", maxlength: 40, autocomplete: "nickname" });
  private readonly nameless = this.nameQuestion();
  private readonly asking = h("p", {});
  private readonly request = this.editQuestion();
  private declined = false;
  private led = ""; // name of the person that led last
  private gone = 0; // timer

  constructor(
    private readonly model: Model,
    private readonly look: () => Look,
    private readonly notices: Notices,
  ) {
    this.sheet.append(
      h("h2", {}, "Who is here"),
      this.list,
      h("label", { for: "person-name" }, "Your name"),
      this.name,
    );
    this.name.addEventListener("change", () => this.rename(this.name.value));
    this.follow.addEventListener("click", () => this.turn());
    this.lead.addEventListener("click", () => model.say({ kind: "lead" }));
    this.element.append(
      this.faces,
      this.sheet,
      this.follow,
      this.lead,
      iconButton("link", "Copy a link to this view (L)", () => this.look().copyLink()),
    );
    this.questions.append(this.nameless, this.request);
    bindKey({ section: "Review", keys: "C", does: "copy a link to this view", on: plainKey("c"), run: () => this.look().copyLink() });
    bindKey({ section: "Review", keys: "G", does: "follow the page that leads, or stop", on: plainKey("g"), run: () => this.turn() });
    for (const part of [this.faces, this.follow, this.lead]) part.hidden = true;
    model.on("role", () => this.update());
  }

  /** The person whose page leads, if it is connected. */
  static leader(model: Model): Person | undefined {
    return model.role.people.find((person) => person.leads);
  }

  private turn(): void {
    if (!this.model.role.leads) this.look().setFollows(!this.look().follows);
  }

  private rename(name: string): void {
    localStorage.setItem(NAME, name.trim());
    this.look().introduce();
  }

  private nameQuestion(): HTMLElement {
    const give = () => {
      this.declined = true;
      this.rename(this.asked.value);
      this.update();
    };
    const form = h(
      "form",
      { class: "problem recovered", hidden: true },
      h("label", { for: "person-asked" }, "Others see this page too. Your name for them:"),
      this.asked,
      h("div", { class: "group" }, h("button", { class: "quiet" }, "Use this name"), h("button", { type: "button", class: "quiet", onclick: give }, "Stay a guest")),
    );
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      if (this.asked.value.trim()) give();
      else this.asked.focus();
    });
    return form;
  }

  private editQuestion(): HTMLElement {
    const answer = (label: string, over: boolean) =>
      h("button", { type: "button", class: "quiet", onclick: () => this.model.say({ kind: "hand", over }) }, label);
    return h(
      "div",
      { class: "problem recovered", hidden: true },
      this.asking,
      h("div", { class: "group" }, answer("Hand over", true), answer("Not now", false)),
    );
  }

  private update(): void {
    const { role } = this.model;
    const others = role.people.length > 1;
    const leader = People.leader(this.model);
    const follows = this.look().follows;
    this.faces.hidden = !others;
    const seen = role.people.slice(0, MOST_SEEN);
    const rest = role.people.length - seen.length;
    this.faces.replaceChildren(...seen.map(face), rest ? h("span", { class: "face rest", "aria-hidden": "true" }, `+${rest}`) : "");
    this.faces.append(h("span", { class: "heard" }, `${role.people.length} people are here`));
    this.faces.title = role.people.map((person) => `${person.name}: ${does(person)}`).join("\n");
    this.list.replaceChildren(...role.people.map(row));
    const own = role.people.find((person) => person.you);
    this.name.placeholder = own?.name ?? "";
    if (document.activeElement !== this.name) this.name.value = ownName();
    this.nameless.hidden = !others || this.declined || localStorage.getItem(NAME) !== null;
    this.asked.placeholder = own?.name ?? "";
    this.request.hidden = !role.asked;
    this.asking.textContent = `${role.asking} asks to edit. After 10 seconds without an answer and without an edit, they can.`;

    this.follow.hidden = role.leads || !leader;
    this.follow.textContent = follows ? "Stop following" : `Follow ${leader?.name ?? ""}`;
    this.lead.hidden = role.leads;
    this.lead.disabled = role.asks;
    this.lead.textContent = role.asks ? "Asked to edit …" : leader ? "Ask to edit" : "Edit";
    if (leader) this.led = leader.name;
    clearTimeout(this.gone);
    const left = () => {
      this.notices.show(`${this.led} has disconnected; the first to press ‘Edit’ takes the edit lock`);
      this.led = "";
    };
    if (this.led && !leader) this.gone = window.setTimeout(left, RETURN);
    const page = document.documentElement;
    page.toggleAttribute("data-follows", !role.leads && follows && leader !== undefined);
    if (leader) page.style.setProperty("--presenter", colorOf(leader));
  }
}

const initials = (name: string): string =>
  name
    .split(" ")
    .slice(0, 2)
    .map((word) => [...word][0] ?? "")
    .join("")
    .toUpperCase();

function face(person: Person): HTMLElement {
  const element = h("span", { class: `face${person.leads ? " leads" : ""}`, "aria-hidden": "true" }, initials(person.name));
  element.style.setProperty("--person", colorOf(person));
  return element;
}

function does(person: Person): string {
  if (person.leads) return "edits";
  return person.follows ? "follows" : "looks elsewhere";
}

function row(person: Person): HTMLElement {
  const name = person.you ? `${person.name} (you)` : person.name;
  return h("li", {}, face(person), h("span", { class: "person-name" }, name), h("span", { class: "does" }, does(person)));
}
