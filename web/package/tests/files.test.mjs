/** Files and meshes: in, out, and what is wrong with them. */

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import * as pc from "planecut";

import { assertClose, data } from "./helpers.mjs";

const PART = () => pc.box([0, 0, 0], [4, 4, 4], { material: "clay" }).subtract(pc.box([1, 1, 1], [2, 2, 5]));

test("meshes of all formats are read back with the same volume", () => {
  for (const format of ["glb", "gltf", "obj", "stl", "ply"]) {
    const again = pc.load(PART().encode(format), `part.${format}`);
    assertClose(again.volume, PART().volume, 1e-6);
    assert.ok(again.mesh().isWatertight);
  }
  assert.equal(Buffer.from(PART().encode("glb").subarray(0, 4)).toString(), "glTF");
  assert.equal(Buffer.from(PART().encode("3mf").subarray(0, 2)).toString(), "PK");
});

test("convex bodies are read back as they are", () => {
  for (const format of ["map", "csg", "json"]) {
    assertClose(pc.load(PART().encode(format), `part.${format}`).volume, PART().volume, 1e-12);
  }
});

test("options of formats have names as in JavaScript", () => {
  const small = PART().encode("glb", { quantize: true, vertexColors: true, shading: { smooth: { crease: 30 } } });
  assertClose(pc.load(small, "part.glb").volume, PART().volume, 1e-3);
  assertClose(pc.load(PART().encode("stl", { scale: 2, text: true }), "part.stl").volume, 8 * PART().volume, 1e-6);
  assert.throws(() => PART().encode("glb", { colour: 1 }), { name: "PlanecutError", message: /^options: unknown field `colour`, expected/ });
});

test("a mesh bounds a solid", () => {
  const positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
  assertClose(pc.fromMesh(positions, triangles, { material: "oak" }).volume, 1 / 6, 1e-15);
  const mesh = PART().mesh();
  assert.ok(mesh.positions instanceof Float64Array && mesh.triangles instanceof Uint32Array);
  assertClose(pc.fromMesh(mesh).volume, PART().volume, 1e-12);
  assertClose(pc.fromMesh(new pc.Mesh(mesh.positions, mesh.triangles)).volume, PART().volume, 1e-12);
  const mirrored = mesh.transform([[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]);
  assertClose(mirrored.volume, PART().volume, 1e-12);
  assert.deepEqual([...mirrored.bounds], [-4, 0, 0, 0, 4, 4]);
});

test("an open mesh is an error that says where", () => {
  const mesh = PART().mesh();
  const open = new pc.Mesh(mesh.positions, mesh.triangles.subarray(3));
  assert.equal(open.isWatertight, false);
  assert.equal(open.check().length, 1);
  assert.throws(() => pc.fromMesh(open), { name: "PlanecutError", message: /edge/ });
  assert.throws(() => new pc.Mesh([[0, 0, 0]], [[0, 0, 1]]), { name: "PlanecutError", message: /^triangles: found 1, expected numbers below 1$/ });
});

test("errors name the file, the line and the place", () => {
  const failure = (text, name, options) => {
    try {
      pc.load(text, name, options);
    } catch (error) {
      assert.ok(error instanceof pc.PlanecutError, String(error));
      assert.match(error.message, /found .*expected/);
      assert.ok(error.message.startsWith(name), error.message);
      return error;
    }
    return assert.fail("it was read");
  };
  const place = failure('{"planecut": 1,\n"model": {"box": {"min": [0, 0, 0]}}}', "broken.json");
  assert.match(place.jsonPath, /^\$\.model/);
  assert.equal(failure("{", "broken.json").line, 1);
  assert.equal(failure("cube(;", "broken.csg").line, 1);
  assert.equal(failure('{\n"classname" "worldspawn"\n{\n( 0 0 0 ) ( 1 0 0 ( 0 1 0 ) x 0 0 0 1 1\n}\n}\n', "broken.map").line, 4);
  failure("glTF and nothing more", "broken.glb");
  failure("anything", "a.doc");
  failure("cube();", "a.csg", { parameters: { width: 1 } });
});

test("parameters and warnings", () => {
  const text = '{"planecut": 1, "parameters": {"width": 2}, "model": {"box": {"min": [0, 0, 0], "max": ["=width", 1, 1]}}}';
  assert.equal(pc.load(text, "box.json").volume, 2);
  assert.equal(pc.load(text, "box.json", { parameters: { width: 7 } }).volume, 7);
  assert.deepEqual(pc.load(text, "box.json").warnings, []);
});

test("a level that others made", { skip: !data("map/romero/e1m1.map") }, () => {
  const level = pc.load(readFileSync(data("map/romero/e1m1.map")), "e1m1.map", { allowLoss: true });
  const { volume } = level;
  const mesh = level.mesh();
  assert.ok(mesh.isWatertight);
  assertClose(mesh.volume, volume);
  assertClose(level.area, 42_611_465, 1e-6);
});
