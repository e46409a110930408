/** What tests of several files share. */

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

import * as pc from "planecut";

await pc.init();

const root = resolve(fileURLToPath(new URL("../../..", import.meta.url)));

/** A file of the data beside the project, or null. */
export function data(name) {
  const file = join(process.env.PLANECUT_DATA ?? join(root, "../shared/data"), name);
  return existsSync(file) ? file : null;
}

/** Numbers that only a seed decides, from 0 to 1. */
export function random(seed) {
  let state = (seed * 2654435761 + 1) >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let value = Math.imul(state ^ (state >>> 15), state | 1);
    value ^= value + Math.imul(value ^ (value >>> 7), value | 61);
    return ((value ^ (value >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** Numbers that differ by no more than a part of them. */
export function assertClose(found, expected, tolerance = 1e-9) {
  assert.ok(Math.abs(found - expected) <= tolerance * Math.max(1, Math.abs(expected)), `found ${found}, expected ${expected}`);
}

/** Some convex body. */
export function someBody(next) {
  const number = (low, high) => low + (high - low) * next();
  if (next() < 0.5) {
    const low = [0, 0, 0].map(() => Math.floor(number(-1, 4)));
    return pc.box(low, low.map((value) => value + Math.floor(number(1, 4))));
  }
  const middle = [0, 0, 0].map(() => number(0, 4));
  return pc.hull(Array.from({ length: 8 }, () => middle.map((value) => value + number(-1.5, 1.5))));
}

/** All of a mesh, to the last bit; of materials the name of each triangle's, as a live model keeps those that it does not use any more. */
export function bits(mesh) {
  const names = Array.from(mesh.materialIds, (number) => mesh.materials[number]);
  const bytes = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength).toString("base64");
  return [bytes(mesh.positions), bytes(mesh.triangles), bytes(mesh.faceIds), bytes(mesh.faceNormals), names];
}

/** The volume that triangles bound, by the divergence theorem. */
export function meshVolume({ positions, triangles }) {
  let sum = 0;
  for (let k = 0; k < triangles.length; k += 3) {
    const [a, b, c] = [0, 1, 2].map((corner) => positions.subarray(3 * triangles[k + corner], 3 * triangles[k + corner] + 3));
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}
