/** Loading the kernel, and what becomes of it after a bug. */

import assert from "node:assert/strict";
import { test } from "node:test";

import * as pc from "planecut";
import { Editor, init, memoryBytes } from "planecut/editor";

import { simulateBug } from "../wasm/planecut_web.js";

test("nothing works before the kernel is loaded, and all of it afterwards", async () => {
  assert.throws(() => pc.cube(1), { name: "PlanecutError", message: /not loaded, expected `await init\(\)`/ });
  assert.equal(memoryBytes(), 0);
  await Promise.all([pc.init(), init()]);
  assert.equal(pc.cube(1).volume, 1);
  assert.match(pc.version(), /^\d+\.\d+\.\d+$/);
  const editor = new Editor(new TextEncoder().encode('{"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}'), "box.json", "{}");
  assert.equal(JSON.parse(editor.answer('{"query": "measures"}')).volume, 1);
  editor.free();
});

test("messages keep every bit of a number", () => {
  const live = new pc.Live(pc.cube(2));
  // numbers of 17 digits, of which a quick reader of JSON loses the last bit
  for (let k = 1; k < 2000; k += 1) {
    const offset = Math.sqrt(1 + k / 997);
    live.edit((edit) => edit.movePlane(0, 0, offset));
    assert.equal(live.planes(0).get(0)[3], offset);
  }
});

// the last one: nothing works after it
test("a bug is an exception with its message, and the instance is not used any more", () => {
  assert.throws(simulateBug, (error) => error instanceof WebAssembly.RuntimeError && error.name === "InternalError" && /a bug that a test asks for.*nothing of this instance can be used/.test(error.message));
});
