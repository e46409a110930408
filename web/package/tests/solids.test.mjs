/** Solids: shapes and operators. */

import assert from "node:assert/strict";
import { test } from "node:test";

import * as pc from "planecut";

import { assertClose, meshVolume, random, someBody } from "./helpers.mjs";

const SQUARE = [[0, 0], [2, 0], [2, 2], [0, 2]];

test("shapes have the volumes that formulas give", () => {
  const polygon = (n, radius) => 0.5 * n * radius ** 2 * Math.sin((2 * Math.PI) / n);
  const cases = [
    [pc.box([0, 0, 0], [4, 2, 1]), 8],
    [pc.cube(2), 8],
    [pc.cube(2, { center: false }), 8],
    [pc.cylinder(4, 3, { segments: 32 }), 4 * polygon(32, 3)],
    [pc.cone(3, 2, { segments: 12 }), polygon(12, 2)],
    [pc.prism(2, 1, 6), 2 * polygon(6, 1)],
    [pc.hull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), 1 / 6],
    [pc.hull([pc.box([0, 0, 0], [1, 1, 1]), pc.box([2, 0, 0], [3, 1, 1])]), 3],
    [pc.extrude([[0, 0], [2, 0], [0, 2]], 3), 6],
    [pc.extrude([SQUARE, [[0.5, 0.5], [1, 0.5], [1, 1], [0.5, 1]]], 2), 2 * (4 - 0.25)],
    [pc.extrude(SQUARE, 1, { scale: 0.5 }), 4 * (1 + 0.5 + 0.25) / 3],
    [pc.revolve([[1, 0], [2, 0], [2, 1], [1, 1]], { segments: 24 }), polygon(24, 2) - polygon(24, 1)],
    [pc.minkowski(pc.cube(2), pc.cube(1)), 27],
    [pc.halfspaces([[1, 0, 0, 0.5]]).intersect(pc.box([0, 0, 0], [1, 1, 1])), 0.5],
  ];
  for (const [solid, expected] of cases) {
    assertClose(solid.volume, expected, 1e-12);
  }
  assert.ok(pc.sphere(1, { segments: 128 }).volume > 4.18 && pc.sphere(1).volume < (4 / 3) * Math.PI);
  assertClose(pc.torus(3, 1, { segments: 256, tubeSegments: 128 }).volume, 6 * Math.PI ** 2, 1e-3);
  assertClose(pc.capsule(2, 0.5, { segments: 128 }).volume, pc.capsule(2, 0.5, { segments: 256 }).volume, 1e-3);
});

test("volumes add up as inclusion and exclusion say", () => {
  for (let seed = 0; seed < 8; seed += 1) {
    const next = random(seed);
    const [a, b, c] = [someBody(next), someBody(next), someBody(next)];
    const volume = (solid) => solid.volume;
    assertClose(volume(a.union(b)), volume(a) + volume(b) - volume(a.intersect(b)));
    assertClose(volume(a.subtract(b)), volume(a) - volume(a.intersect(b)));
    assertClose(volume(a.xor(b)), volume(a.union(b)) - volume(a.intersect(b)));
    const pairs = volume(a.intersect(b)) + volume(a.intersect(c)) + volume(b.intersect(c));
    assertClose(volume(pc.union([a, b, c])), volume(a) + volume(b) + volume(c) - pairs + volume(pc.intersection([a, b, c])));
    assertClose(volume(pc.difference(a, [b, c])), volume(a.intersect(b.union(c).complement())));
    const mesh = pc.union([a, b, c]).mesh();
    assertClose(meshVolume(mesh), mesh.volume);
    assert.ok(mesh.isWatertight);
    assert.deepEqual(mesh.check(), []);
  }
});

test("solids move, turn, grow and are mirrored", () => {
  const solid = pc.box([0, 0, 0], [1, 2, 3]);
  assert.deepEqual([...solid.translate([1, 1, 1]).bounds], [1, 1, 1, 2, 3, 4]);
  assert.deepEqual([...solid.rotate("z", 90).bounds], [-2, 0, 0, 0, 1, 3]);
  assert.deepEqual([...solid.rotate([0, 0, 5], 90).bounds], [-2, 0, 0, 0, 1, 3]);
  assert.deepEqual([...solid.scale(2).bounds], [0, 0, 0, 2, 4, 6]);
  assert.deepEqual([...solid.scale([1, 2, 1]).bounds], [0, 0, 0, 1, 4, 3]);
  assert.deepEqual([...solid.mirror([1, 0, 0]).bounds], [-1, 0, 0, 0, 2, 3]);
  assert.deepEqual([...solid.transform([[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0]]).bounds], [5, 0, 0, 6, 2, 3]);
  assert.equal(solid.area, 22);
  assert.deepEqual([...solid.centroid], [0.5, 1, 1.5]);
});

test("points, rays, cells and components are asked for", () => {
  const plate = pc.box([0, 0, 0], [40, 20, 4]);
  const part = plate.subtract(pc.cylinder(4, 3, { segments: 32 }).translate([10, 10, 0]));
  assert.deepEqual(part.contains([[5, 5, 2], [10, 10, 2], [0, 0, 0]]), [true, false, true]);
  assert.deepEqual([...part.rayCast([[10, 10, 9], [5, 5, 9]], [0, 0, -1])], [Infinity, 5]);
  const cells = part.cells();
  assertClose(cells.reduce((sum, cell) => sum + cell.volume, 0), part.volume);
  assertClose(pc.union(cells.map((cell) => cell.toSolid())).volume, part.volume);
  assert.equal(cells[0].planes.length % 4, 0);
  assert.equal(part.union(pc.cube(1).translate([90, 0, 0])).components().length, 2);
  assertClose(part.asOneBody().volume, part.volume);
});

test("what is empty and what is unbounded", () => {
  const nothing = pc.union([]);
  assert.ok(nothing.isEmpty && nothing.volume === 0 && [...nothing.bounds].every(Number.isNaN));
  const outside = pc.cube(1).complement();
  assert.equal(outside.isEmpty, false);
  assert.throws(() => outside.volume, { name: "PlanecutError", message: /^found a solid that reaches infinity, expected/ });
  assert.throws(() => pc.intersection([]), { name: "PlanecutError", message: /^solids: found none, expected/ });
});

test("what is cut shows the material of what cuts", () => {
  const plate = pc.box([0, 0, 0], [4, 4, 1], { material: "steel" });
  const hole = pc.box([1, 1, 0], [2, 2, 1]);
  assert.deepEqual(plate.subtract(hole).mesh().materials, ["steel"]);
  const mesh = plate.subtract(hole.withMaterial("brass", [0.75, 0.5, 0])).mesh();
  assert.deepEqual(mesh.materials, ["steel", "brass"]);
  assert.deepEqual([...mesh.materialColors].slice(3), [0.75, 0.5, 0]);
});

test("a deep tree is as good as a flat one", () => {
  let solid = pc.box([0, 0, 0], [1, 1, 1]);
  for (let k = 1; k < 2000; k += 1) {
    solid = solid.union(pc.box([k, 0, 0], [k + 1, 1, 1]));
  }
  assert.equal(solid.bodyCount, 2000);
  assert.equal(solid.volume, 2000);
});

test("shapes refuse what has no shape", () => {
  const cases = [
    [() => pc.box([0, 0], [1, 1, 1]), /^min: found 2 numbers, expected 3$/],
    [() => pc.box([0, 0, NaN], [1, 1, 1]), /^min: found NaN, expected finite numbers$/],
    [() => pc.box([0, 0, 0], [1, 1, 0]), /^max: found z = 0, expected/],
    [() => pc.sphere(-1), /^radius: found -1/],
    [() => pc.sphere(1, { segments: 2.5 }), /^segments: found 2.5, expected/],
    [() => pc.cube(1).rotate("w", 90), /^axis: found "w", expected/],
    [() => pc.cube(1).transform([[1, 0, 0, 0]]), /^matrix: found 1 rows, expected 3/],
    [() => pc.cube(1).scale(0), /singular/],
    [() => pc.hull([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), /no interior/],
    [() => pc.cube(1).withMaterial("a", [2, 0, 0]), /^color: found .*expected numbers from 0 to 1$/],
    [() => pc.cube(1).encode("doc"), /'\.doc', expected/],
    [() => pc.cube(1).rayCast([[0, 0, 0]], [0, 0, 0]), /^directions\[0\]: found the zero vector/],
    [() => pc.union([1]), /^solids: found a value of type number, expected solids$/],
  ];
  for (const [work, message] of cases) {
    assert.throws(work, (error) => error instanceof pc.PlanecutError && message.test(error.message) && !error.message.includes("\n"), String(message));
  }
});

test("what was freed is not used any more", () => {
  const solid = pc.cube(1);
  const both = solid.union(pc.cube(2));
  solid.free();
  assert.throws(() => solid.volume, { name: "PlanecutError", message: /freed/ });
  assert.equal(both.volume, 8);
});
