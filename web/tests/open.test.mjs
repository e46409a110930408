/** Files of each kind are opened, and what is wrong with a file is said. */

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { measures, openText, settle, start } from "./browser.mjs";

const root = resolve(fileURLToPath(new URL("../..", import.meta.url)));
const example = (name) => readFileSync(join(root, "examples", name));

const TETRAHEDRON_OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

const TETRAHEDRON_STL = `solid t
${[[[0, 0, 0], [0, 1, 0], [1, 0, 0]], [[0, 0, 0], [1, 0, 0], [0, 0, 1]], [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 0], [0, 0, 0], [0, 0, 1]]]
  .map((corners) => `facet normal 0 0 0\nouter loop\n${corners.map((at) => `vertex ${at.join(" ")}`).join("\n")}\nendloop\nendfacet`)
  .join("\n")}
endsolid t
`;

const TETRAHEDRON_PLY = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

test("each kind of file is opened", async () => {
  const { page, errors, foreign, close } = await start();
  const open = async (name, content) => {
    await openText(page, name, content);
    await page.waitForFunction((expected) => globalThis.planecut.document.source?.name === expected, name);
    await settle(page);
    return measures(page);
  };
  for (const [name, text] of [["t.obj", TETRAHEDRON_OBJ], ["t.stl", TETRAHEDRON_STL], ["t.ply", TETRAHEDRON_PLY]]) {
    const { volume, triangles } = await open(name, text);
    assert.ok(Math.abs(volume - 1 / 6) < 1e-12, `${name}: ${volume}`);
    assert.equal(triangles, 4, name);
  }
  const box = await open("box.json", '{"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [1, 2, 3]}}}');
  assert.equal(box.volume, 6);
  const tree = await open("lattice.csg", "difference() { cube(size = [4, 4, 4], center = false); cube(size = [2, 2, 8], center = false); }");
  assert.equal(tree.volume, 64 - 16);
  const map = await open("keep.map", example("keep.map"));
  assert.ok(map.brushes > 10 && map.volume > 0);
  const bytes = await page.evaluate(() => globalThis.planecut.document.kernel.call("encode", "glb").then((glb) => [...glb]));
  const glb = await open("keep.glb", Buffer.from(bytes));
  // glTF is in metres and single precision
  assert.ok(Math.abs(glb.volume / map.volume - 1) < 1e-4, `${glb.volume} ${map.volume}`);
  assert.deepEqual(errors, []);
  assert.deepEqual(foreign, []);
  await close();
});

test("a file that was dropped is opened", async () => {
  const { page, close } = await start();
  await page.evaluate((text) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([text], "dropped.obj"));
    dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }, TETRAHEDRON_OBJ);
  await page.waitForFunction(() => globalThis.planecut.document.source?.name === "dropped.obj");
  await close();
});

test("the address of a file of the same server is opened, and no other", async () => {
  const { page, foreign, close } = await start({ query: "#file=models/gear.json" });
  assert.equal(await page.evaluate(() => globalThis.planecut.document.source.name), "gear.json");
  await page.evaluate(() => document.querySelectorAll("dialog")[1].showModal());
  await page.fill('input[aria-label="Address of a file on this server"]', "https://example.com/a.json");
  await page.click('dialog[open] button:text-is("Open")');
  await page.waitForSelector(".message.error:has-text('another server')");
  assert.deepEqual(foreign, []);
  await close();
});

test("what is wrong with a file is said, and what was open stays", async () => {
  const { page, close } = await start();
  const before = await measures(page);
  const cases = [
    ["broken.json", '{"planecut": 1,\n "model": {"box": {"min": [0, 0], "max": [1, 1, 1]}}}', /broken\.json:2/],
    ["open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", /open\.obj/],
    ["noise.glb", "this is no glTF", /noise\.glb/],
    ["what.xyz", "?", /expected \.json/],
    ["deep.csg", `${"union() { ".repeat(100_000)}`, /deep\.csg/],
  ];
  for (const [name, text, said] of cases) {
    await openText(page, name, text);
    const message = page.locator(".message.error").last();
    await page.waitForFunction((source) => [...document.querySelectorAll(".message.error")].some((entry) => new RegExp(source).test(entry.textContent)), said.source);
    assert.match(await message.textContent(), said);
    assert.deepEqual(await measures(page), before, name);
  }
  await close();
});

test("examples of the gallery are opened", async () => {
  const { page, errors, close } = await start();
  const count = await page.locator(".card").count();
  assert.ok(count >= 10);
  for (let k = 0; k < count; k++) {
    await page.keyboard.press("g");
    await page.waitForSelector("dialog[open]");
    const before = await page.evaluate(() => globalThis.planecut.document.source);
    await page.locator(".card").nth(k).click();
    await page.waitForFunction((name) => globalThis.planecut.document.source?.name !== name || globalThis.planecut.document.kernel.isBusy, before?.name ?? null).catch(() => {});
    await settle(page);
    assert.ok((await measures(page)).volume > 0, `example ${k}`);
  }
  assert.deepEqual(errors, []);
  await close();
});

test("a real map is opened", { skip: !existsSync(join(root, "../shared/data")) && "found no ../shared/data" }, async () => {
  const folder = join(root, "../shared/data");
  const { page, errors, close } = await start({ models: (name) => join(folder, name), query: "#file=models/map/romero/e1m1.map" });
  const { brushes, volume } = await measures(page);
  assert.ok(brushes > 1000 && volume > 0);
  assert.deepEqual(errors, []);
  await close();
});
