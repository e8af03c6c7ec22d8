// What the server says to a page that opens the small example: by the server itself, once for all tests.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import type { TestProject } from "vitest/node";

export type Example = "small.recipe" | "small.shot";

declare module "vitest" {
  interface ProvidedContext {
    /** Messages in Base64, by the file that is open. */
    messages: Record<Example, string[]>;
  }
}

export default function setup(project: TestProject): void {
  const root = resolve(import.meta.dirname, "../..");
  const folder = mkdtempSync(join(tmpdir(), "ringlet-messages-"));
  execFileSync(join(root, ".venv/bin/python"), ["-W", "ignore", join(root, "tests/python/page_messages.py"), folder], {
    env: { ...process.env, OMP_NUM_THREADS: "1" },
  });
  const read = (name: Example) => split(readFileSync(join(folder, `${name}.bin`)));
  project.provide("messages", { "small.recipe": read("small.recipe"), "small.shot": read("small.shot") });
  rmSync(folder, { recursive: true });
}

/** Blocks of bytes, each after its length. */
function split(data: Buffer): string[] {
  const blocks: string[] = [];
  for (let at = 0; at < data.length; ) {
    const end = at + 4 + data.readUInt32LE(at);
    blocks.push(data.subarray(at + 4, end).toString("base64"));
    at = end;
  }
  return blocks;
}
