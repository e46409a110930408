/** Live models: after each edit they are what a fresh evaluation gives. */

import assert from "node:assert/strict";
import { test } from "node:test";

import * as pc from "planecut";

import { assertClose, bits, random, someBody } from "./helpers.mjs";

const start = () => new pc.Live(pc.box([0, 0, 0], [4, 4, 4], { material: "clay" }).subtract(pc.box([1, 1, 1], [2, 2, 5])));
const translation = (by) => [[1, 0, 0, by[0]], [0, 1, 0, by[1]], [0, 0, 1, by[2]]];

function assertIsFresh(live) {
  assert.deepEqual(bits(live.mesh()), bits(live.toSolid().mesh()));
  assertClose(live.volume, live.toSolid().volume);
}

/** Some call of an edit, on some brush. */
function someCall(next, live, edit) {
  const pick = (list) => list[Math.floor(next() * list.length)];
  const { brushes } = live;
  const what = brushes.length ? Math.floor(next() * 8) : 0;
  const brush = pick(brushes);
  const planes = brushes.length ? live.planes(brush) : new Map();
  if (what <= 1) {
    edit.addBrush(someBody(next), pick(["add", "add", "subtract"]));
  } else if (what <= 3) {
    const plane = pick([...planes.keys()]);
    const offset = planes.get(plane)[3] + (next() - 0.5);
    edit.movePlane(brush, plane, offset);
    assert.equal(live.planes(brush).get(plane)[3], offset, "to the last bit");
  } else if (what === 4) {
    edit.addPlane(brush, [next() - 0.5, next() - 0.5, next() - 0.5, next() + 0.5], pick(["clay", "steel"]));
  } else if (what === 5) {
    edit.transformBrush(brush, translation([next(), next(), next()]));
  } else if (what === 6 && brushes.length > 3) {
    edit.removeBrush(brush);
  } else {
    edit.replaceBrush(brush, someBody(next));
  }
}

test("random edits give what a fresh evaluation gives, bit for bit, and can be undone", () => {
  for (let seed = 0; seed < 8; seed += 1) {
    const next = random(seed);
    const live = start();
    const states = [bits(live.mesh())];
    for (let step = 0; step < 10; step += 1) {
      const before = new Set(live.faces);
      try {
        live.edit((edit) => {
          for (let calls = 1 + Math.floor(next() * 3); calls > 0; calls -= 1) {
            someCall(next, live, edit);
          }
        });
      } catch (error) {
        assert.ok(error instanceof pc.PlanecutError, String(error));
        assert.deepEqual(bits(live.mesh()), states.at(-1));
        continue;
      }
      assertIsFresh(live);
      const { removed, added } = live.change;
      removed.forEach((face) => assert.ok(before.delete(face)));
      added.forEach((face) => before.add(face));
      assert.deepEqual([...before].sort((a, b) => a - b), [...live.faces].sort((a, b) => a - b));
      states.push(bits(live.mesh()));
    }
    assert.ok(states.length > 4);
    assert.deepEqual(live.steps, { undo: states.length - 1, redo: 0 });
    for (const expected of states.slice(0, -1).reverse()) {
      live.undo();
      assert.deepEqual(bits(live.mesh()), expected);
    }
    assert.throws(() => live.undo(), { name: "PlanecutError", message: /nothing/ });
    for (const expected of states.slice(1)) {
      live.redo();
      assert.deepEqual(bits(live.mesh()), expected);
    }
  }
});

test("an edit is one step, and an exception takes all of it back", () => {
  const live = start();
  const before = live.volume;
  const brush = live.edit((edit) => {
    edit.movePlane(0, 0, 5);
    return edit.addBrush(pc.box([10, 0, 0], [11, 1, 1]));
  });
  assert.equal(live.volume, before + 1 + 16);
  assert.equal(live.role(brush), "add");
  live.undo();
  assert.equal(live.volume, before);
  live.redo();
  const state = bits(live.mesh());
  const mine = new Error("mine");
  assert.throws(() => live.edit((edit) => { edit.removeBrush(1); throw mine; }), (error) => error === mine);
  assert.deepEqual(bits(live.mesh()), state);
  assert.throws(() => live.edit(async () => {}), { name: "PlanecutError", message: /promise/ });
  let kept;
  live.edit((edit) => { kept = edit; });
  assert.throws(() => kept.removeBrush(0), { name: "PlanecutError", message: /over/ });
  assert.throws(() => live.edit(() => live.undo()), { name: "PlanecutError", message: /not complete/ });
});

test("faces, buffers and rays", () => {
  const live = start();
  const { face, distance } = live.pick([0.5, 0.5, 9], [0, 0, -1]);
  assert.equal(distance, 5);
  const found = live.face(face);
  assert.deepEqual(Array.from(found.normal, (part) => part + 0), [0, 0, 1]);
  assert.equal(found.material, "clay");
  assert.equal(live.planes(found.brush).get(found.plane)[3], 4);
  assert.equal(live.pick([-1, -1, 9], [0, 0, -1]), null);
  const buffers = live.buffers(live.faces, [2, 2, 2]);
  assert.equal(buffers.positions.length, buffers.normals.length);
  assert.equal(buffers.vertexStarts.at(-1), buffers.positions.length / 3);
  assert.equal(buffers.indexStarts.at(-1), buffers.indices.length / 3);
  assert.throws(() => live.buffers([4711]), { name: "PlanecutError", message: /^faces: found 4711, expected/ });
  assert.throws(() => live.face(-1), { name: "PlanecutError", message: /^id: found -1, expected/ });
});

test("measures are those of the solid, by material, too", () => {
  const live = new pc.Live(pc.box([0, 0, 0], [2, 2, 2], { material: "clay" }));
  live.edit((edit) => {
    edit.addBrush(pc.box([5, 0, 0], [6, 1, 1], { material: "steel" }));
    edit.setMaterial(0, "gold", 0);
  });
  assert.equal(live.volume, 9);
  assert.equal(live.area, 30);
  assert.deepEqual([...live.bounds], [0, 0, 0, 6, 2, 2]);
  assert.deepEqual(live.areas, new Map([["clay", 20], ["steel", 6], ["gold", 4]]));
  assert.deepEqual(live.volumes, new Map([["clay", 8], ["steel", 1]]));
});

test("planes turn and snap, brushes are copied", () => {
  const live = new pc.Live(pc.box([0, 0, 0], [1, 1, 1]).union(pc.box([2.25, 0, 0], [3, 1, 1])));
  const right = [...live.planes(0)].find(([, [x]]) => x > 0)[0];
  assert.deepEqual(live.snap(0, right, [1, 0, 0, 2.125], { planes: 0.25 }), { plane: [1, 0, 0, 2.25], target: "plane", distance: 0.125 });
  assert.equal(live.snap(0, right, [1, 0, 0, 1.75], { planes: 0.25 }), null);
  assert.equal(live.snap(0, right, [1, 0, 0, 1.7], { grid: 0.5 }).target, "grid");
  const [copy, mirrored] = live.edit((edit) => {
    edit.turnPlane(0, right, [1, 0, 1, 1]);
    edit.renameBrush(0, "wedge");
    return [...edit.copyBrushes([0], translation([0, 2, 0])), ...edit.mirrorBrushes([0], [1, 0, 0, -1])];
  });
  assert.equal(live.brushName(copy), "wedge");
  assert.equal(live.volume, 3 * 0.5 + 0.75);
  assert.equal(live.edit((edit) => edit.arrayBrushes([copy, mirrored], translation([0, 5, 0]), 2)).length, 4);
  assert.equal(live.volume, 7 * 0.5 + 0.75);
});

test("the tree is edited, and previews change nothing", () => {
  const [a, b, c] = [0, 1, 2].map((k) => pc.box([k, 0, 0], [k + 2, 1, 1]));
  const live = new pc.Live(a.union(b.xor(c)));
  assert.deepEqual(live.tree, [
    { brush: 0, role: "add" },
    { node: new pc.Node(0), operation: "xor", operands: [{ brush: 1 }, { brush: 2 }], role: "add" },
  ]);
  const node = live.edit((edit) => {
    edit.setOperation(new pc.Node(0), "intersection");
    return edit.wrap([0, new pc.Node(0)], "difference");
  });
  assert.equal(live.volume, a.subtract(b.intersect(c)).volume);
  live.edit((edit) => {
    edit.moveOperand(2, { to: node, before: new pc.Node(0) });
    edit.dissolve(new pc.Node(0));
    edit.moveBrushBefore(1, 2);
    edit.setRole(node, "add");
  });
  assert.equal(live.volume, a.subtract(b, c).volume);
  live.edit((edit) => edit.removeNode(node));
  assert.deepEqual(live.tree, []);
  live.undo();

  const before = bits(live.mesh());
  const preview = live.preview.transformBrush(0, translation([-1, 0, 0]));
  assertClose(preview.volumeChange, 1);
  assert.ok(preview.added.length > 0 && preview.added[0].positions.length > 0);
  assertClose(live.preview.addBrush(pc.box([0, 0, 1], [1, 1, 2])).volumeChange, 1);
  assert.throws(() => live.preview.removeBrush(99), { name: "PlanecutError", message: /^found brush 99, expected/ });
  assert.deepEqual(bits(live.mesh()), before);
  const cube = new pc.Live(pc.cube(2));
  const corner = cube.edit((edit) => edit.addPlane(0, [1, 1, 1, 2]));
  assertClose(cube.previewRemovePlane(0, corner).volume, 1 / 6);
  assert.equal(cube.previewRemovePlane(0, 1), "unbounded");
});

test("what is refused says what was found and what was expected", () => {
  const live = start();
  const cases = [
    [(edit) => edit.movePlane(0, 0, NaN), /^offset: found NaN, expected a finite number$/],
    [(edit) => edit.movePlane(99, 0, 1), /^found brush 99, expected/],
    [(edit) => edit.movePlane(0, 99, 1), /^found plane 99 of brush 0, expected/],
    [(edit) => edit.removePlane(0, 0), /^found a solid that reaches infinity, expected/],
    [(edit) => edit.addBrush(pc.cube(1).subtract(pc.cube(2))), /^solid: found one of 2 bodies, expected/],
    [(edit) => edit.addBrush(pc.cube(1), "take"), /^role: found "take", expected/],
    [(edit) => edit.addPlane(0, [1, 0, 0]), /^plane: found 3 numbers, expected/],
    [(edit) => edit.dissolve(0), /^node: found 0, expected a Node$/],
  ];
  for (const [work, message] of cases) {
    assert.throws(() => live.edit(work), { name: "PlanecutError", message });
  }
});

test("memory does not grow over ten thousand edits", () => {
  const live = start();
  const drag = (count) => {
    for (let k = 0; k < count; k += 1) {
      // of two brushes, so that faces of both come and go
      live.edit((edit) => {
        edit.movePlane(0, 0, 4.5 + (k % 100) / 100);
        edit.transformBrush(1, translation([(k % 7) / 8, 0, 0]));
      });
      live.buffers(live.change.added);
      live.undo();
    }
  };
  drag(200);
  const before = pc.memoryBytes();
  drag(10_000);
  assert.equal(pc.memoryBytes(), before);
});
