/** A tile set that the program writes: its documents and contents by their specifications, and a viewer that loads it. */

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";

import { validateBytes } from "gltf-validator";
import { PNG } from "pngjs";

import { out, start } from "./browser.mjs";

const here = fileURLToPath(new URL(".", import.meta.url));
const root = resolve(here, "../..");

/** Writes a city of so many buildings into a folder, in several documents. TILES_EXAMPLE names the program where it is built already. */
function writeTiles(folder, buildings) {
  const built = process.env.TILES_EXAMPLE;
  const [program, first] = built ? [built, []] : ["cargo", ["run", "--quiet", "--example", "tiles", "--"]];
  return execFileSync(program, [...first, folder, `${buildings}`, "20"], { cwd: root, encoding: "utf8" });
}

const folder = mkdtempSync(join(tmpdir(), "tiles-"));
const set = join(folder, "city");
const said = writeTiles(set, 10_000);
after(() => rmSync(folder, { recursive: true }));

/** The JSON and the bytes of the buffer of a GLB. */
function parse(bytes) {
  assert.equal(bytes.toString("latin1", 0, 4), "glTF");
  const length = bytes.readUInt32LE(12);
  return JSON.parse(bytes.toString("utf8", 20, 20 + length));
}

/** The corners of the box of a content, as a viewer places it: glTF's Y is up, in tile sets Z is. */
function corners(json) {
  const [scene, node] = json.nodes;
  const [x, y, z, w] = scene.rotation;
  const turn = (v) => {
    // v + 2 w (q × v) + 2 q × (q × v)
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const once = cross([x, y, z], v);
    const twice = cross([x, y, z], once);
    return v.map((value, k) => value + 2 * w * once[k] + 2 * twice[k]);
  };
  const found = [];
  for (const { attributes } of json.meshes[0].primitives) {
    const { min, max } = json.accessors[attributes.POSITION];
    for (let k = 0; k < 8; k++) {
      const at = [0, 1, 2].map((axis) => (k & (1 << axis) ? max : min)[axis] * (node.scale?.[axis] ?? 1) + node.translation[axis]);
      const [right, up, back] = turn(at).map((value, axis) => value * scene.scale[axis]);
      found.push([right, -back, up]);
    }
  }
  return found;
}

/** Checks a document and those that it names: OGC 22-025r4. Gives its tiles by height. */
async function checkDocument(path, heights = {}) {
  const document = JSON.parse(readFileSync(path, "utf8"));
  assert.deepEqual(Object.keys(document).sort(), ["asset", "geometricError", "root"]);
  assert.equal(document.asset.version, "1.1");
  assert.ok(Object.keys(document.asset).every((key) => ["version", "extras"].includes(key)));
  assert.equal(document.root.refine, "REPLACE");
  assert.ok(document.geometricError >= document.root.geometricError);
  const check = async (tile, parent) => {
    const known = ["boundingVolume", "geometricError", "refine", "content", "children"];
    assert.ok(Object.keys(tile).every((key) => known.includes(key)));
    assert.ok(tile.geometricError >= 0 && (!parent || tile.geometricError < parent.geometricError));
    const box = tile.boundingVolume.box;
    assert.ok(box.length === 12 && box.every(Number.isFinite) && [3, 7, 11].every((k) => box[k] > 0));
    const holds = (outer, at, room) => at.every((value, axis) => Math.abs(value - outer[axis]) <= outer[3 + 4 * axis] + room);
    if (parent) {
      const ends = [-1, 1].map((way) => [0, 1, 2].map((axis) => box[axis] + way * box[3 + 4 * axis]));
      assert.ok(ends.every((end) => holds(parent.boundingVolume.box, end, 1e-6)));
    }
    const content = resolve(dirname(path), tile.content.uri);
    assert.ok(existsSync(content), content);
    if (content.endsWith(".json")) {
      assert.equal(tile.children, undefined);
      return checkDocument(content, heights);
    }
    const bytes = readFileSync(content);
    const report = await validateBytes(new Uint8Array(bytes), { maxIssues: 0 });
    assert.deepEqual([report.issues.numErrors, report.issues.numWarnings], [0, 0], `${content}: ${JSON.stringify(report.issues.messages)}`);
    const json = parse(bytes);
    assert.ok(corners(json).every((at) => holds(box, at, 1e-3)), content);
    const height = dirname(content).split("/").pop();
    heights[height] = (heights[height] ?? 0) + 1;
    assert.ok(tile.children === undefined || tile.children.length > 0);
    for (const child of tile.children ?? []) {
      await check(child, tile);
    }
    return heights;
  };
  return check(document.root, null);
}

test("documents and contents are as specified", async () => {
  const heights = await checkDocument(join(set, "tileset.json"));
  assert.match(said, /: [2-9] documents/);
  for (const [height, count] of Object.entries(heights)) {
    assert.match(said, new RegExp(`height ${height}: ${count} tiles`));
  }
});

/** The share of a picture that is not of the colour of its upper corner. */
function filled(bytes) {
  const { data } = PNG.sync.read(bytes);
  let count = 0;
  for (let k = 0; k < data.length; k += 4) {
    count += [0, 1, 2].some((channel) => Math.abs(data[k + channel] - data[channel]) > 8);
  }
  return count / (data.length / 4);
}

test("a viewer refines the tile set as it comes near", async (context) => {
  const models = (name) => {
    const [first, ...rest] = name.split("/");
    return { node: join(here, "../node_modules", ...rest), set: join(set, ...rest) }[first] ?? join(here, name);
  };
  const { page, errors, foreign, close } = await start({ query: "models/tiles.html", models });
  context.after(close);
  const top = Math.max(...[...said.matchAll(/height (\d+)/g)].map(([, height]) => Number(height)));
  const views = {
    tiles_far: [[0, -9, 6], [0, 0, 0]],
    tiles_whole: [[0, -0.8, 0.45], [0, -0.02, 0]],
    tiles_near: [[0.05, -0.2, 0.05], [0, 0, 0]],
    tiles_street: [[0.0, -0.06, 0.012], [0.02, 0.1, -0.005]],
  };
  const seen = {};
  for (const [name, [from, at]] of Object.entries(views)) {
    seen[name] = await page.evaluate(([from, at]) => globalThis.look(from, at), [from, at]);
    const picture = await page.screenshot();
    writeFileSync(join(out, `${name}.png`), picture);
    seen[name].filled = filled(picture);
    context.diagnostic(`${name}: ${JSON.stringify(seen[name])}`);
  }
  assert.deepEqual(seen.tiles_street.failed, []);
  assert.deepEqual(errors, []);
  assert.deepEqual(foreign, []);
  assert.deepEqual(seen.tiles_far.heights, { [top]: 1 });
  const lowest = (name) => Math.min(...Object.keys(seen[name].heights).map(Number));
  assert.ok(lowest("tiles_whole") < top && lowest("tiles_street") === 0, JSON.stringify(seen));
  assert.ok(Object.keys(seen.tiles_street.heights).length > 1, "what is far is coarser");
  assert.ok(seen.tiles_far.filled > 0.002 && seen.tiles_whole.filled > 0.2 && seen.tiles_street.filled > 0.3, JSON.stringify(seen));
});
