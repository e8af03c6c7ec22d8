import { defineConfig } from "vitest/config";

// Tests of the page without a browser: what it shows for the messages of the server, and what it says to it.
export default defineConfig({
  test: {
    include: ["tests/*.test.ts"],
    environment: "happy-dom",
    globalSetup: "tests/messages.ts",
    pool: "threads",
    maxWorkers: 1, // other tests run on the other processor
    isolate: false, // each page has modules of its own
    css: false,
    testTimeout: 60_000, // no time is judged, and the first page loads all modules
    unstubGlobals: true,
  },
});
