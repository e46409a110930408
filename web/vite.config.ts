import { defineConfig } from "vite";

export default defineConfig({
  // addresses within the page are relative: it works from any folder of any server
  base: "./",
  worker: { format: "es" },
  build: {
    target: "es2022",
    // the page never asks for anything but its own files, so nothing is inlined as an address of data
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1500,
  },
});
