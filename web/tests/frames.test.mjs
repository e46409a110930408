/** A drag of 300 steps in a map of 1,257 brushes, and 10,000 edits: times are reported, memory must stay flat. */

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join, resolve } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { settle, start } from "./browser.mjs";

const maps = resolve(fileURLToPath(new URL("../../../shared/data/map/romero", import.meta.url)));
const skip = !existsSync(join(maps, "e1m1.map")) && "found no ../shared/data/map/romero/e1m1.map";

const quantile = (times, share) => [...times].sort((a, b) => a - b)[Math.min(times.length - 1, Math.ceil(share * times.length) - 1)];

const text = (times) => `median ${quantile(times, 0.5).toFixed(2)} ms, 99 % ${quantile(times, 0.99).toFixed(2)} ms, most ${Math.max(...times).toFixed(2)} ms`;

test("a drag of 300 steps in e1m1", { skip }, async (context) => {
  const { page, close } = await start({ width: 480, height: 360, query: "#file=models/e1m1.map", models: (name) => join(maps, name) });
  const first = await page.evaluate(() => performance.now());
  context.diagnostic(`first picture of the map: ${first.toFixed(0)} ms after the page was asked for`);
  const result = await page.evaluate(async () => {
    const { document: model, viewer } = globalThis.planecut;
    // the brush with the most faces that are seen
    let brush = 0;
    let most = 0;
    for (const [id] of model.brushes) {
      const count = [...model.faces.facesOf(id)].length;
      if (count > most) {
        [brush, most] = [id, count];
      }
    }
    const { planes } = await model.brush(brush);
    const { plane, half_space } = planes[0];
    const frames = [];
    const times = model.times;
    Object.values(times).forEach((list) => (list.length = 0));
    viewer.drawTimes.length = 0;
    await model.edit({ op: "begin" });
    let last = performance.now();
    for (let step = 0; step < 300; step++) {
      const offset = half_space[3] + 24 * Math.sin(step / 20);
      await model.drag(brush, plane, [half_space[0], half_space[1], half_space[2], offset], { grid: 0, planes: 0, vertices: 0 });
      await new Promise((done) => requestAnimationFrame(done));
      const now = performance.now();
      frames.push(now - last);
      last = now;
    }
    await model.edit({ op: "cancel" });
    return { frames, kernel: times.kernel.slice(1, -1), transfer: times.transfer.slice(1, -1), upload: times.upload.slice(1, -1), draw: viewer.drawTimes };
  });
  for (const name of ["kernel", "transfer", "upload", "draw", "frames"]) {
    context.diagnostic(`${name}: ${text(result[name])}`);
  }
  assert.equal(result.kernel.length, 300);
  await close();
});

test("memory is flat over 10,000 edits", { skip }, async (context) => {
  const { page, close } = await start({ width: 900, height: 420, query: "#file=models/e1m1.map", models: (name) => join(maps, name) });
  const run = (edits) =>
    page.evaluate(async (count) => {
      const { document: model } = globalThis.planecut;
      const { plane, half_space } = (await model.brush(5)).planes[0];
      for (let step = 0; step < count; step++) {
        await model.edit({ op: "move_plane", brush: 5, plane, offset: half_space[3] + (step % 7) + 1 });
      }
      for (let step = 0; step < 5 && model.history.undo > 0; step++) {
        await model.edit({ op: "undo" });
      }
      return { kernel: await model.kernel.call("memory"), capacity: model.faces.surface.getAttribute("position").count };
    }, edits);
  await run(1000);
  await settle(page);
  const before = await run(1000);
  const after = await run(10_000);
  context.diagnostic(`kernel ${before.kernel / 1e6} MB, then ${after.kernel / 1e6} MB; ${before.capacity} vertices, then ${after.capacity}`);
  assert.ok(after.kernel <= before.kernel + (1 << 20), `${before.kernel} ${after.kernel}`);
  assert.equal(after.capacity, before.capacity);
  await close();
});
