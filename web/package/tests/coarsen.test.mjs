/** Few convex cells around solids, meshes and hulls. */

import assert from "node:assert/strict";
import { test } from "node:test";

import * as pc from "planecut";

import { assertClose, random, someBody } from "./helpers.mjs";

const stairs = () => pc.union([0, 1, 2, 3].map((k) => pc.box([k, 0, 0], [k + 1, 1, k + 1])));
const hullOf = (cell) => pc.hull(cell.positions);

test("cells hold the solid, and the excess is what they add", () => {
  for (let seed = 0; seed < 6; seed += 1) {
    const next = random(seed);
    const solid = pc.union([someBody(next), someBody(next), someBody(next)]);
    for (const maxCells of [1, 3]) {
      const hulls = pc.coarsen(solid, { maxCells });
      assert.ok(hulls.encloses && hulls.cells.length >= 1 && hulls.cells.length <= maxCells);
      const around = pc.union(hulls.cells.map(hullOf));
      assertClose(solid.subtract(around).volume, 0, 1e-9);
      assertClose(hulls.volumeIn, solid.volume);
      assertClose(hulls.excess, around.volume / solid.volume - 1, 1e-6);
      assertClose(hulls.sumExcess, hulls.cells.reduce((sum, cell) => sum + cell.volume, 0) / solid.volume - 1, 1e-6);
      assertClose(hulls.toSolid().volume, hulls.volumeOut);
      assert.equal(hulls.enclosed, "solid");
    }
  }
});

test("limits are kept", () => {
  const solid = pc.sphere(1, { segments: 16 });
  assert.ok(pc.coarsen(solid, { maxCells: 1, maxVertices: 12 }).cells.every((cell) => cell.positions.length <= 36));
  assert.ok(pc.coarsen(solid, { maxCells: 1, engine: "physx" }).cells.every((cell) => cell.positions.length <= 3 * 64));
  assert.ok(pc.coarsen(stairs(), { maxExcess: 0.1 }).excess <= 0.1);
  assert.equal(pc.coarsen(stairs()).cells.length, 4);
  const inner = pc.coarsen(stairs(), { maxCells: 3, inner: true });
  assert.ok(!inner.encloses && inner.excess <= 0);
});

test("what is to be kept clear stays clear", () => {
  const door = pc.box([1, -1, 0], [2, 1, 2]);
  const wall = pc.box([0, -0.125, 0], [3, 0.125, 3]).subtract(door);
  const hulls = pc.coarsen(wall, { maxCells: 3, keepClear: door });
  assertClose(pc.union(hulls.cells.map(hullOf)).intersect(door).volume, 0);
});

test("solids, meshes and hulls are taken", () => {
  const expected = pc.coarsen(stairs(), { maxCells: 1 }).excess;
  const cells = stairs().cells();
  for (const subject of [stairs().mesh(), cells, cells.map((cell) => cell.positions)]) {
    assertClose(pc.coarsen(subject, { maxCells: 1 }).excess, expected);
  }
});

test("an open mesh becomes a shell, and that is told", () => {
  const { positions, triangles } = pc.cube(4).mesh();
  const open = new pc.Mesh(positions, triangles.subarray(6));
  const hulls = pc.coarsen(open, { maxCells: 8 });
  assert.ok(hulls.enclosed === "shell" && hulls.thickness > 0 && /shell/.test(hulls.note));
  assert.equal(pc.coarsen(open, { maxCells: 1, surface: "filled" }).enclosed, "filled");
});

test("cells are written each as a mesh of its own", () => {
  const hulls = pc.coarsen(stairs(), { maxCells: 2 });
  const text = Buffer.from(hulls.encode("obj")).toString();
  assert.equal(text.match(/^o /gm).length, 2);
  assertClose(pc.load(hulls.encode("glb"), "stairs.glb").volume, hulls.volumeOut, 1e-6);
});

test("options that cannot be met have our names", () => {
  assert.throws(() => pc.coarsen(stairs(), { maxCells: 0 }), { name: "PlanecutError", message: /^maxCells: found 0, expected/ });
  assert.throws(() => pc.coarsen(stairs(), { engine: "quake" }), { name: "PlanecutError", message: /^engine: found "quake", expected one of/ });
  assert.throws(() => pc.coarsen(pc.union([])), { name: "PlanecutError", message: /^found an empty solid, expected/ });
});
