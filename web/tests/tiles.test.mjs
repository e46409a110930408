/** A tile set that the program writes: its documents and contents by their specifications, and a viewer that loads it. */

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";

import { validateBytes } from "gltf-validator";
import { PNG } from "pngjs";

import { out, start } from "./browser.mjs";

const here = fileURLToPath(new URL(".", import.meta.url));
const root = resolve(here, "../..");

/** The program: PLANECUT, or what `cargo build` made. */
const program = process.env.PLANECUT ?? join(process.env.CARGO_TARGET_DIR ?? join(root, "target"), "debug/planecut");

/** A city of a number of buildings between streets as a model file, higher towards the middle, some with a tower that is turned; in metres. */
function city(buildings) {
  const [step, street] = [30, 9];
  const side = Math.ceil(Math.sqrt(buildings));
  const reach = (side * step) / 2;
  let state = 1;
  const noise = () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
  const box = (min, size, material) => ({ box: { min, max: min.map((at, axis) => at + size[axis]) }, material });
  const nodes = [box([-reach, -reach, -2], [2 * reach, 2 * reach, 2], "ground")];
  for (let number = 0; number < buildings; number++) {
    const at = [(number % side) * step - reach + street / 2, Math.floor(number / side) * step - reach + street / 2, -1];
    const width = step - street;
    const far = Math.hypot(at[0], at[1]) / reach;
    const height = Math.round(6 + 60 * noise() ** 2 * Math.max(1.2 - far, 0.1));
    const size = [width * (0.7 + 0.3 * noise()), width * (0.7 + 0.3 * noise()), height];
    nodes.push(box(at, size, ["brick", "sandstone", "concrete", "plaster"][Math.floor(4 * noise())]));
    if (height > 20) {
      const tower = box([-width / 4, -width / 4, -height / 2], [width / 2, width / 2, height], "glass");
      const middle = [at[0] + size[0] / 2, at[1] + size[1] / 2, at[2] + height];
      nodes.push({ ...tower, transform: [{ rotate: [0, 0, Math.round(90 * noise())] }, { translate: middle }] });
    }
  }
  const colors = { ground: [0.25, 0.27, 0.25], brick: [0.5, 0.2, 0.13], sandstone: [0.65, 0.5, 0.3], concrete: [0.5, 0.5, 0.5], plaster: [0.75, 0.72, 0.65], glass: [0.15, 0.3, 0.45] };
  const materials = Object.fromEntries(Object.entries(colors).map(([name, color]) => [name, { color }]));
  return JSON.stringify({ planecut: 1, materials, model: { union: nodes } });
}

const folder = mkdtempSync(join(tmpdir(), "tiles-"));
const set = join(folder, "city");
after(() => rmSync(folder, { recursive: true }));
writeFileSync(join(folder, "city.json"), city(10_000));
if (!existsSync(program)) {
  execFileSync("cargo", ["build", "--quiet", "--locked", "--bin", "planecut"], { cwd: root, stdio: "inherit" });
}
execFileSync(program, ["build", join(folder, "city.json"), "--tiles", set, "--blocks=20"]);

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
  const files = readdirSync(join(set, "tiles"), { recursive: true });
  const of = (ending) => files.filter((name) => name.endsWith(ending)).length;
  assert.ok(of(".json") > 1, "a large set has several documents");
  assert.equal(Object.values(heights).reduce((sum, count) => sum + count), of(".glb"));
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
  const top = Math.max(...readdirSync(join(set, "tiles")).map(Number));
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
