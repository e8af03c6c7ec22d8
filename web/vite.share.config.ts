import { defineConfig } from "vite";

// The script and the style of the share page, which the server puts into one file.
export default defineConfig({
  publicDir: false,
  build: {
    outDir: "../python/ringlet/viewer/static/share",
    emptyOutDir: true,
    target: "es2022",
    chunkSizeWarningLimit: 1200,
    lib: { entry: "src/share.ts", formats: ["iife"], name: "look", fileName: () => "share.js", cssFileName: "share" },
  },
});
