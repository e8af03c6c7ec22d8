// The connection: what a server has not heard is said again, to the next one or by the next page.

import { expect, test, vi } from "vitest";
import { decode } from "../src/codec";
import type { FromServer } from "../src/protocol";
import { Link } from "../src/link";
import { enter, number } from "./controls";
import { open, type Page, recorded, Socket } from "./page";

const changes = (page: Page) => page.said("set").flatMap((one) => one.changes);

/** Another server says what the first one has said. heard: messages of this page that it knows */
function found(page: Page, heard: number): void {
  Socket.latest.open();
  for (const message of recorded("small.recipe").map(decode))
    page.hear(message.kind === "welcome" ? { ...message, session: "another", heard } : message);
}

test("what was not answered is said again after a restart", async () => {
  const page = await open();
  page.hear({ kind: "heard", count: Socket.latest.heard.length - 1 }); // but for the greeting
  enter(number("curl.width"), "1.75");
  expect(page.model.link!.answered).toBe(false);
  Socket.latest.close();
  expect(document.documentElement.dataset["link"]).toBe("lost");
  expect(document.querySelector(".problems")!.textContent).toContain("The server does not answer");
  enter(number("curl.pitch"), "2.25");
  vi.advanceTimersByTime(300);
  found(page, 0);
  expect(document.documentElement.dataset["link"]).toBe("open");
  expect(page.last("hello").leads).toBe(true);
  expect(changes(page)).toEqual([[["curl", "width"], 1.75], [["curl", "pitch"], 2.25]]);
  page.hear({ kind: "heard", count: Socket.latest.heard.length - 1 });
  expect(page.model.link!.answered).toBe(true);
});

test("what comes before the page is there is heard in order, and before what comes after", async () => {
  vi.stubGlobal("WebSocket", Socket);
  vi.useFakeTimers();
  const link = new Link({ name: "tab", copied: false }, () => "");
  link.start();
  Socket.latest.open();
  expect(Socket.latest.heard).toMatchObject([{ kind: "hello", leads: false }]);
  const data = recorded("small.recipe");
  for (const one of data.slice(0, 4)) Socket.latest.onmessage({ data: one });
  const heard: string[] = [];
  link.tell({ hear: ({ kind }) => heard.push(kind), changed: (state) => heard.push(state), leads: () => false });
  Socket.latest.onmessage({ data: data[4] });
  expect(heard.length).toBe(2); // the rest after the page was drawn
  expect(link.answered).toBe(false);
  vi.advanceTimersByTime(10);
  expect(link.answered).toBe(true);
  Socket.latest.onmessage({ data: data[5] });
  expect(heard).toEqual(["open", ...data.slice(0, 6).map((one) => decode(one).kind)]);
});

test("what a server has heard is not said again", async () => {
  const page = await open();
  page.hear({ kind: "heard", count: Socket.latest.heard.length - 1 });
  const before = Socket.latest.heard.length - 1;
  enter(number("curl.width"), "1.75");
  page.hear({ kind: "heard", count: before + 1 });
  enter(number("curl.pitch"), "2.25");
  Socket.latest.close();
  vi.advanceTimersByTime(300);
  found(page, before + 1);
  expect(changes(page)).toEqual([[["curl", "pitch"], 2.25]]);
});

test("a server that was started anew gets what was not saved", async () => {
  const page = await open();
  page.document({ text: "edited", edits: "moved" });
  const { saved, saved_edits } = page.model.documents.recipe!;
  Socket.latest.close();
  vi.advanceTimersByTime(300);
  found(page, 0);
  expect(page.said("restore")).toEqual([{ kind: "restore", file: "recipe", text: "edited", edits: "moved", saved, saved_edits }]);
});

test("a page that is loaded again says what was not answered", async () => {
  await open();
  enter(number("curl.width"), "1.75");
  const page = await open();
  expect(page.last("hello").leads).toBe(true); // as before it was loaded again
  expect(changes(page)).toEqual([[["curl", "width"], 1.75]]);
  expect(page.model.role.leads).toBe(true);
});

test("changes wait while another page leads", async () => {
  const page = await open();
  enter(number("curl.width"), "1.75");
  Socket.latest.close();
  vi.advanceTimersByTime(300);
  Socket.latest.open();
  page.hear({ ...(decode(recorded("small.recipe")[0]) as Extract<FromServer, { kind: "welcome" }>), session: "another" });
  page.role({ leads: false });
  page.hear(page.first("numbers"));
  expect(changes(page)).toEqual([]);
  page.role({ leads: true });
  expect(changes(page)).toEqual([[["curl", "width"], 1.75]]);
});
