/** What `npm pack` packs. */

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const folder = fileURLToPath(new URL("..", import.meta.url));

test("the package is complete", () => {
  const [{ files }] = JSON.parse(execFileSync("npm", ["pack", "--dry-run", "--json", "--ignore-scripts"], { cwd: folder, encoding: "utf8" }));
  const names = new Set(files.map(({ path }) => path));
  const { exports } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
  const targets = Object.values(exports).flatMap((target) => (typeof target === "string" ? [target] : Object.values(target)));
  for (const file of [...targets, "./wasm/planecut_web.js", "./wasm/planecut_web.d.ts", "./README.md", "./LICENSE-MIT", "./LICENSE-APACHE"]) {
    assert.ok(names.has(file.slice(2)), `${file} is packed`);
  }
  assert.ok([...names].every((name) => !/^(src|tests)\//.test(name)));
});

test("no module asks for what is not packed", () => {
  const [{ files }] = JSON.parse(execFileSync("npm", ["pack", "--dry-run", "--json", "--ignore-scripts"], { cwd: folder, encoding: "utf8" }));
  const names = new Set(files.map(({ path }) => path));
  for (const name of names) {
    if (/^dist\/.*\.(js|d\.ts)$/.test(name)) {
      const text = readFileSync(`${folder}/${name}`, "utf8");
      for (const [, from] of text.matchAll(/from "(\.[^"]+)"/g)) {
        const path = new URL(from, `file:///${name}`).pathname.slice(1);
        assert.ok(names.has(path), `${name} asks for ${from}`);
      }
    }
  }
});

test("the types are complete, as a program sees them", () => {
  const compiler = fileURLToPath(import.meta.resolve("typescript/bin/tsc"));
  execFileSync(process.execPath, [compiler, "--project", "tests/types"], { cwd: folder, encoding: "utf8" });
});
