/** Sections, cells, colliders, measures, files that leave; the pictures are compared with those of the last version. */

import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import pixelmatch from "pixelmatch";
import { PNG } from "pngjs";

import { measures, onPage, openText, out, settle, start } from "./browser.mjs";

const expected = fileURLToPath(new URL("./pictures", import.meta.url));

/** Side of the squares whose means are compared, in pixels: letters and thin lines lie elsewhere by a pixel in another version of the browser. */
const SQUARE = 4;

/** Share of these that may differ. */
const MOST_DIFFERENT = 0.02;

/** A picture of the means of its squares. */
function coarse({ width, height, data }) {
  const [columns, rows] = [Math.floor(width / SQUARE), Math.floor(height / SQUARE)];
  const means = new Uint8Array(4 * columns * rows);
  for (let k = 0; k < means.length; k++) {
    const [channel, column, row] = [k % 4, (k >> 2) % columns, Math.floor((k >> 2) / columns)];
    let sum = 0;
    for (let at = 0; at < SQUARE * SQUARE; at++) {
      const [x, y] = [SQUARE * column + (at % SQUARE), SQUARE * row + Math.floor(at / SQUARE)];
      sum += data[4 * (y * width + x) + channel];
    }
    means[k] = sum / (SQUARE * SQUARE);
  }
  return { width: columns, height: rows, data: means };
}

/** Compares what is seen with a picture that was looked at; with UPDATE_PICTURES set it becomes that. */
async function compare(page, name) {
  await page.mouse.move(0, 0);
  await page.evaluate(() => document.activeElement?.blur());
  await settle(page);
  const bytes = await page.screenshot();
  mkdirSync(out, { recursive: true });
  writeFileSync(join(out, `${name}.png`), bytes);
  const file = join(expected, `${name}.png`);
  if (process.env.UPDATE_PICTURES) {
    mkdirSync(expected, { recursive: true });
    writeFileSync(file, bytes);
  }
  assert.ok(existsSync(file), `found no ${file}, expected a picture: look at tests/out/${name}.png, then run with UPDATE_PICTURES=1`);
  const [found, known] = [bytes, readFileSync(file)].map((picture) => coarse(PNG.sync.read(picture)));
  assert.deepEqual([found.width, found.height], [known.width, known.height]);
  const different = pixelmatch(found.data, known.data, null, found.width, found.height, { threshold: 0.2, includeAA: true });
  assert.ok(different / (found.width * found.height) <= MOST_DIFFERENT, `${name}: ${different} squares differ`);
}

test("the page as it opens, in light and dark", async () => {
  for (const dark of [false, true]) {
    const { page, close } = await start({ dark });
    await compare(page, dark ? "castle_dark" : "castle");
    await close();
  }
});

test("a section, x-ray, cells moved apart, and colliders", async () => {
  const { page, errors, close } = await start({ query: "#example=flange.json" });
  await page.click("#tab-Look");
  await page.keyboard.press("c");
  await compare(page, "section");
  await page.keyboard.press("c");
  await page.keyboard.press("y");
  await compare(page, "xray");
  await page.keyboard.press("y");
  await page.keyboard.press("b");
  await page.waitForFunction(() => /cells, which/.test(document.querySelector(".look").textContent));
  await compare(page, "cells");
  await page.keyboard.press("b");
  await page.keyboard.press("h");
  await page.waitForSelector("#colliders-result");
  const excess = async () => Number(/add ([\d.,]+) %/.exec(await page.textContent("#colliders-result"))[1].replace(",", ""));
  const sixteen = await excess();
  await compare(page, "colliders");
  await page.fill('input[aria-label="Maximum number of hulls"]', "2");
  await page.keyboard.press("Tab");
  await page.waitForFunction(() => /^[12] hulls/.test(document.querySelector("#colliders-result").textContent));
  assert.ok((await excess()) > sixteen);
  assert.deepEqual(errors, []);
  await close();
});

test("a section along a face and in any direction", async () => {
  const { page, errors, close } = await start();
  // the half-space x + 2 y + 2 z <= 9 takes a corner of the box
  const model = { planecut: 1, model: { intersection: [{ box: { min: [0, 0, 0], max: [4, 3, 2] } }, { halfspaces: [[1, 2, 2, 9]] }] } };
  await openText(page, "box.json", JSON.stringify(model));
  await page.waitForFunction(() => globalThis.planecut.document.source?.name === "box.json");
  await settle(page);
  await page.click("#tab-Look");
  await page.evaluate(() => {
    const { document: model } = globalThis.planecut;
    const slanted = [...model.faces.faces.values()].find(({ normal }) => Math.abs(normal[0] - 1 / 3) < 1e-6);
    model.select({ brush: slanted.brush, plane: slanted.plane, face: slanted.id });
  });
  await page.click("#tab-Look");
  await page.click("#section-along");
  const plane = () =>
    page.evaluate(() => {
      const { viewer, document: model } = globalThis.planecut;
      const { normal, constant } = viewer.sectionPlane;
      // n·x >= d in the model's own coordinates
      return [...normal.toArray(), -constant + normal.toArray().reduce((sum, value, k) => sum + value * model.center[k], 0)];
    });
  const along = await plane();
  // the slider goes a thousandth beyond either end
  [-1 / 3, -2 / 3, -2 / 3, -3].forEach((value, k) => assert.ok(Math.abs(along[k] - value) < 0.01, `${along}`));
  assert.equal(await page.inputValue("#section-axis"), "free");
  await page.fill("#section-turn", "90");
  await page.fill("#section-tilt", "0");
  const turned = await plane();
  [0, -1, 0].forEach((value, k) => assert.ok(Math.abs(turned[k] - value) < 1e-6, `${turned}`));
  await page.selectOption("#section-axis", "z");
  await page.fill("#section-place", "0.25");
  assert.ok(Math.abs((await plane())[3] + 0.5) < 0.01);
  assert.deepEqual(errors, []);
  await close();
});

test("mass and inertia, distances and angles", async () => {
  const { page, close } = await start();
  await openText(page, "box.json", '{"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [2, 4, 6]}}}');
  await page.waitForFunction(() => globalThis.planecut.document.source?.name === "box.json");
  await settle(page);
  await page.click("#tab-Measure");
  await page.click('button:has-text("Mass and inertia")');
  await page.waitForSelector("#mass dd");
  const text = await page.textContent("#mass");
  // m (b² + c²) / 12 of a box
  const mass = 48_000;
  for (const value of [mass, (mass * (16 + 36)) / 12, (mass * (4 + 36)) / 12, (mass * (4 + 16)) / 12]) {
    assert.ok(text.includes(value.toLocaleString("en")), `${value} in ${text}`);
  }
  await page.keyboard.press("4");
  for (const place of [[0.02, 0, 6], [2, 0.02, 5.98]]) {
    const { x, y } = await onPage(page, place);
    await page.mouse.move(x, y);
    await page.waitForTimeout(150);
    await page.mouse.click(x, y);
    await settle(page);
  }
  assert.match(await page.textContent(".measures [role=status]"), /Distance .* angle between the faces/);
  await close();
});

test("a GLB that was saved has the volume of the solid", async () => {
  const { page, close } = await start({ query: "#example=gear.json" });
  const { volume } = await measures(page);
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Control+s")]);
  assert.equal(download.suggestedFilename(), "gear.glb");
  const file = await download.path();
  await page.setInputFiles("input[type=file]", { name: "back.glb", mimeType: "model/gltf-binary", buffer: readFileSync(file) });
  await page.waitForFunction(() => globalThis.planecut.document.source?.name === "back.glb");
  await settle(page);
  const back = (await measures(page)).volume;
  assert.ok(Math.abs(back / volume - 1) < 1e-4, `${back} ${volume}`);
  for (const format of ["stl", "3mf", "obj", "ply", "map", "csg", "json"]) {
    const size = await page.evaluate((name) => globalThis.planecut.document.kernel.call("encode", name).then((bytes) => bytes.length), format);
    assert.ok(size > 100, format);
  }
  await close();
});
