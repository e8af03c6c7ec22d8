// People: names, who is there, asking to edit, and the look of the page that leads.

import { expect, test, vi } from "vitest";
import type { Compared, Followed, Person } from "../src/protocol";
import { choose, control, fill, find, press, texts } from "./controls";
import { open, type Page } from "./page";

const person = (name: string, more: Partial<Person> = {}): Person => ({ name, hue: 0, leads: false, follows: true, you: false, ...more });

/** The server says that two people are there, of whom this page leads or follows. */
function two(page: Page, leads: boolean, other = "Guest 1", own = "Guest 2"): void {
  const people = leads
    ? [person(own, { leads: true, you: true }), person(other)]
    : [person(other, { leads: true }), person(own, { you: true })];
  page.role({ leads, people });
}

/** What the page that leads looks at, which is what this page looks at but for some of it. */
const look = (page: Page, change: Partial<Followed>): Followed => ({ kind: "followed", ...page.app.look.state, ...change });

const follows = () => document.documentElement.hasAttribute("data-follows");
const eye = (page: Page) => page.app.viewer.camera.position.toArray();

test("people give their name once, and see who is there", async () => {
  let page = await open();
  two(page, true, "Guest 2", "Guest 1");
  fill(control<HTMLInputElement>("Others see this page too. Your name for them:"), "Ann Lee");
  find<HTMLFormElement>(".questions form").requestSubmit();
  expect(page.last("introduce")).toEqual({ kind: "introduce", person: "Ann Lee", follows: true });
  two(page, true, "Guest 2", "Ann Lee");
  expect(find(".questions form").hidden).toBe(true);
  press("t", {}, page.app.viewer.canvas);
  expect(find<HTMLInputElement>(".dock .author").value).toBe("Ann Lee");
  expect(texts(".people-list .person-name")).toEqual(["Ann Lee (you)", "Guest 2"]);
  expect(texts(".people-list .does")).toEqual(["edits", "follows"]);
  expect(texts(".faces .face")).toEqual(["AL", "G2"]);
  expect(texts(".faces .heard")).toEqual(["2 people are here"]);
  page = await open();
  expect(page.last("hello").person).toBe("Ann Lee");
  two(page, true, "Guest 2", "Ann Lee");
  expect(find(".questions form").hidden).toBe(true);
});

test("a guest stays one", async () => {
  const page = await open();
  two(page, false);
  expect(find(".questions form").hidden).toBe(false);
  control("Stay a guest").click();
  expect(page.last("introduce").person).toBe("");
  expect(find(".questions form").hidden).toBe(true);
});

test("who asks to edit is named, and gets an answer", async () => {
  const page = await open();
  two(page, false);
  control("Ask to edit").click();
  expect(page.last("lead")).toEqual({ kind: "lead" });
  page.role({ asks: true });
  expect(control<HTMLButtonElement>("Asked to edit").disabled).toBe(true);
  page.hear({ kind: "notice", message: "Guest 1 goes on editing" });
  page.role({ asks: false });
  expect(texts(".notice")).toEqual(["Guest 1 goes on editing"]);
  expect(find<HTMLFieldSetElement>(".settings > .fields").disabled).toBe(true);

  two(page, true, "Bo");
  expect(find<HTMLFieldSetElement>(".settings > .fields").disabled).toBe(false);
  page.role({ asked: true, asking: "Bo" });
  expect(find(".questions").textContent).toContain("Bo asks to edit");
  control("Not now").click();
  expect(page.last("hand")).toEqual({ kind: "hand", over: false });
  control("Hand over").click();
  expect(page.last("hand")).toEqual({ kind: "hand", over: true });
});

test("pages that follow are notified when the leading page disconnects, and one takes the edit lock", async () => {
  const page = await open();
  two(page, false, "Bo");
  page.role({ leads: false, people: [person("Guest 2", { you: true })] }); // loads the page again
  vi.advanceTimersByTime(1000);
  two(page, false, "Bo");
  vi.advanceTimersByTime(5000);
  expect(texts(".notice")).toEqual([]);
  page.role({ leads: false, people: [person("Guest 2", { you: true })] });
  vi.advanceTimersByTime(3000);
  expect(texts(".notice")).toEqual(["Bo has disconnected; the first to press ‘Edit’ takes the edit lock"]);
  control("Edit").click();
  expect(page.last("lead")).toEqual({ kind: "lead" });
});

test("a follower sees what the leader sees, until it looks elsewhere", async () => {
  const page = await open();
  two(page, false);
  const camera = page.app.look.state.camera.map((value) => value + 0.1);
  const [first] = page.app.viewer.hair.a.locks!.ids;
  page.hear(look(page, { place: ["locks"], locks: [first], camera }));
  expect(page.model.chosen.place).toEqual(["locks"]);
  expect(page.app.lock.ids).toEqual([first]);
  expect(eye(page)[0]).toBeCloseTo(camera[0], 9);
  expect(follows()).toBe(true);
  find('[data-stage="curl"]').click(); // what a follower looks at on its own ends that it follows
  expect(page.last("introduce").follows).toBe(false);
  const moved = camera.map((value) => value + 0.1);
  page.hear(look(page, { place: ["guides"], camera: moved }));
  expect(page.model.chosen.place).toEqual(["curl"]);
  expect(eye(page)[0]).toBeCloseTo(camera[0], 9);
  press("g");
  expect(page.model.chosen.place).toEqual(["guides"]);
  expect(eye(page)[0]).toBeCloseTo(moved[0], 9);
  control("Stop following").click();
  expect(follows()).toBe(false);
  expect(control("Follow Guest 1")).toBeTruthy();
});

test("the page that leads says what it looks at", async () => {
  const page = await open();
  two(page, true, "Bo");
  press("n");
  find('[data-stage="locks"]').click();
  press("ArrowLeft");
  vi.advanceTimersByTime(100);
  expect(page.last("look")).toMatchObject({ place: ["locks"], locks: page.app.lock.ids });
  expect(page.last("look").camera.slice(0, 3)).toEqual(eye(page));
});

test("a follower sees the comparison as the leader arranges it", async () => {
  const page = await open();
  const compared: Compared = { kind: "compared", side: "b", name: "as saved", detail: "", settings: {}, take: "" };
  page.hear({ ...compared, side: "a", name: "now" });
  page.hear(compared);
  two(page, true, "Bo");
  const { looks } = page.app.viewer;
  choose(control("Arrangement of the looks"), "wipe");
  press("ArrowRight", {}, control("Place of the wipe"));
  expect(looks.wipe).toBeGreaterThan(0.5);
  vi.advanceTimersByTime(100);
  expect(page.last("look").looks).toMatchObject({ arrangement: "wipe", wipe: looks.wipe });
  control("Swap the two sides").click();
  vi.advanceTimersByTime(100);
  expect(page.last("look").looks!.order).toEqual(["b", "a"]);

  two(page, false);
  page.hear(look(page, { looks: { arrangement: "wipe", order: ["a", "b"], front: "a", wipe: 0.7 } }));
  expect(looks.arranged).toEqual({ arrangement: "wipe", order: ["a", "b"], front: "a", wipe: 0.7 });
  page.hear(look(page, { looks: { arrangement: "wipe", order: ["b", "a"], front: "a", wipe: 0.7 } }));
  expect(looks.order).toEqual(["b", "a"]);
  expect(control<HTMLSelectElement>("Arrangement of the looks").value).toBe("wipe");
  expect(follows()).toBe(true);
  choose(control("Arrangement of the looks"), "difference"); // it looks on its own from now on
  expect(page.last("introduce").follows).toBe(false);
});

test("a page that follows takes snapshots, and loads none", async () => {
  const page = await open();
  two(page, false);
  vi.spyOn(HTMLCanvasElement.prototype, "toDataURL").mockReturnValue("data:image/png;base64,AAAA");
  vi.spyOn(page.app.viewer, "drawAt").mockReturnValue(document.createElement("canvas"));
  press("s", {}, page.app.viewer.canvas);
  expect(page.last("take_snapshot")).toMatchObject({ author: "", picture: "AAAA", look: page.app.look.state });
  page.hear({ kind: "snapshots", snapshots: [{ id: "1", author: "", note: "", time: "2026-01-01T10:00:00", look: page.app.look.state, seconds: 0 }] });
  press("t", {}, page.app.viewer.canvas);
  expect(control<HTMLButtonElement>("Load: use its settings").disabled).toBe(true);
  two(page, true);
  expect(control<HTMLButtonElement>("Load: use its settings").disabled).toBe(false);
});

test("a link opens the view that it was copied from", async () => {
  const one = await open();
  const written = vi.fn(async (_: string) => {});
  vi.spyOn(navigator, "clipboard", "get").mockReturnValue({ writeText: written } as unknown as Clipboard);
  press("n");
  find('[data-stage="locks"]').click();
  const light = control<HTMLSelectElement>("Light");
  choose(light, light.options[2].value);
  choose(control("Overlay"), "pin");
  one.app.viewer.orbit(0.9, 0.2);
  one.app.viewer.move();
  press("c");
  await vi.advanceTimersByTimeAsync(10);
  expect(texts(".notice")).toEqual(["The link to this view is copied"]);
  const [link] = written.mock.calls[0];
  expect(link).toContain("#of=small.recipe.toml&camera=");
  expect(link).toContain("stage=recipe/locks");
  const { locks, camera } = one.app.look.state;

  localStorage.clear();
  location.hash = link.slice(link.indexOf("#"));
  const page = await open();
  location.hash = "";
  expect(page.app.lock.ids).toEqual(locks);
  page.app.look.state.camera.forEach((value, k) => expect(value).toBeCloseTo(camera[k], 4));
  expect([page.model.chosen.place, page.model.overlay]).toEqual([["locks"], "pin"]);
  expect(control<HTMLSelectElement>("Light").selectedIndex).toBe(2);
  expect(page.last("introduce").follows).toBe(false);
  two(page, false);
  expect(control("Follow Guest 1")).toBeTruthy();
});

