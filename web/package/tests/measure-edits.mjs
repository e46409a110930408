/**
 * Measures live edits of a level: `node tests/measure-edits.mjs [file.map]`. No test: times are those of a machine.
 *
 * Planes of brushes all over the level are moved by one unit and back, each as an edit of its own.
 */

import { readFileSync } from "node:fs";
import { basename } from "node:path";

import * as pc from "planecut";

import { data } from "./helpers.mjs";

const file = process.argv[2] ?? data("map/romero/e1m1.map");
if (!file) {
  console.log("found no level, expected the name of a file");
  process.exit(1);
}
const seconds = (from) => ((performance.now() - from) / 1000).toFixed(2);
let begin = performance.now();
const solid = pc.load(readFileSync(file), basename(file), { allowLoss: true });
console.log(`${basename(file)}: read in ${seconds(begin)} s`);
begin = performance.now();
const live = new pc.Live(solid);
console.log(`a live model of ${live.brushes.length} brushes and ${live.faces.length} faces in ${seconds(begin)} s`);

const times = [];
const step = Math.max(1, Math.floor(live.brushes.length / 250));
for (let round = 0; round < 2; round += 1) {
  for (let k = 0; k < live.brushes.length; k += step) {
    const brush = live.brushes[k];
    const [[plane, [, , , offset]]] = live.planes(brush);
    for (const target of [offset + 1, offset]) {
      const from = performance.now();
      try {
        live.edit((edit) => edit.movePlane(brush, plane, target));
      } catch {
        continue;
      }
      live.buffers(live.change.added);
      // the first round warms the compiler up
      if (round > 0) {
        times.push(performance.now() - from);
      }
    }
  }
}
times.sort((a, b) => a - b);
const at = (part) => `${times[Math.floor(part * (times.length - 1))].toFixed(3)} ms`;
console.log(`${times.length} edits with their buffers: median ${at(0.5)}, 90 of 100 within ${at(0.9)}, the slowest ${at(1)}; ${(pc.memoryBytes() / 1e6).toFixed(0)} MB of memory`);
