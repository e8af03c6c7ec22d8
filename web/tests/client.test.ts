// Who a tab is: one name for each, also where a browser has copied what another has stored.

import { afterEach, expect, test, vi } from "vitest";
import { identify } from "../src/client";
import { enter, number } from "./controls";
import { open, Socket } from "./page";

/** Locks of a browser, which end with the page that holds them. */
function locks(): { held: Set<string>; release: (name: string) => void } {
  const held = new Set<string>();
  const waiting = new Map<string, () => void>();
  const request = (name: string, { signal }: { signal: AbortSignal }, take: () => unknown) => {
    const get = () => {
      held.add(name);
      take();
    };
    if (!held.has(name)) return Promise.resolve(get());
    return new Promise((_, refuse) => {
      waiting.set(name, get);
      signal.addEventListener("abort", () => refuse(new DOMException("timeout", "AbortError")));
    });
  };
  vi.stubGlobal("navigator", { locks: { request } });
  return {
    held,
    release: (name) => {
      held.delete(name);
      waiting.get(name)?.();
    },
  };
}

afterEach(() => vi.unstubAllGlobals());

test("a duplicated tab gets a name of its own", async () => {
  locks();
  const one = await identify();
  const two = await identify(); // with a copy of what the first has stored
  expect(one.copied).toBe(false);
  expect(two).toEqual({ name: sessionStorage.getItem("ringlet-client"), copied: true });
  expect(two.name).not.toBe(one.name);
});

test("a tab that is loaded again keeps its name, once the page before is gone", async () => {
  const { held, release } = locks();
  const one = await identify();
  const again = identify();
  release([...held][0]);
  expect(await again).toEqual({ name: one.name, copied: false });
});

test("without locks tabs ask one another", async () => {
  vi.stubGlobal("navigator", {});
  const one = await identify();
  const two = await identify();
  expect([one.copied, two.copied]).toEqual([false, true]);
  expect(two.name).not.toBe(one.name);
});

test("the copy of a tab does not lead, nor say again what the other has said", async () => {
  const page = await open();
  enter(number("curl.width"), "1.75");
  expect(page.model.link!.unanswered).toBe(true);
  const copy = await open("small.recipe", undefined, true);
  expect(copy.last("hello").leads).toBe(false);
  expect(copy.said("set")).toEqual([]);
  expect(Socket.latest.heard[0].kind).toBe("hello");
});
