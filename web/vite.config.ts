import { defineConfig } from "vite";

// The page goes where the server finds it, and into the wheel.
export default defineConfig({
  base: "./",
  build: {
    outDir: "../python/ringlet/viewer/static",
    emptyOutDir: true,
    target: "es2022",
    chunkSizeWarningLimit: 1200,
    assetsInlineLimit: 0,
  },
});
