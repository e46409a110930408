// Unpacks the buffer of a GLB file with EXT_meshopt_compression: node unpack.js PACKED UNPACKED
//
// Views keep their order and what they say but for the extension, so accessors fit the new buffer as they are.

import { readFileSync, writeFileSync } from "node:fs";
import { MeshoptDecoder } from "three/addons/libs/meshopt_decoder.module.js";

const NAME = "EXT_meshopt_compression";
const [JSON_CHUNK, BIN_CHUNK] = [0x4e4f534a, 0x004e4942];

const [from, to] = process.argv.slice(2);
const file = readFileSync(from);
const length = file.readUInt32LE(12);
const gltf = JSON.parse(file.subarray(20, 20 + length).toString("utf8"));
const binary = file.subarray(20 + length + 8);

await MeshoptDecoder.ready;
const parts = gltf.bufferViews.map((view) => {
  const packed = view.extensions?.[NAME];
  const { byteOffset = 0, byteLength } = packed ?? view;
  const bytes = binary.subarray(byteOffset, byteOffset + byteLength);
  if (!packed) return bytes;
  const target = new Uint8Array(packed.count * packed.byteStride);
  MeshoptDecoder.decodeGltfBuffer(target, packed.count, packed.byteStride, bytes, packed.mode, packed.filter);
  delete view.extensions;
  return target;
});

let size = 0;
gltf.bufferViews.forEach((view, number) => {
  Object.assign(view, { buffer: 0, byteOffset: size, byteLength: parts[number].length });
  size += Math.ceil(parts[number].length / 4) * 4;
});
gltf.buffers = [{ byteLength: size }];
for (const list of ["extensionsUsed", "extensionsRequired"]) {
  const left = (gltf[list] ?? []).filter((name) => name !== NAME);
  if (left.length > 0) gltf[list] = left;
  else delete gltf[list];
}

const buffer = Buffer.alloc(size);
parts.forEach((part, number) => buffer.set(part, gltf.bufferViews[number].byteOffset));
const text = Buffer.from(JSON.stringify(gltf));
const json = Buffer.concat([text, Buffer.alloc(-text.length & 3, " ")]);
const head = (words) => Buffer.from(Uint32Array.from(words).buffer);
writeFileSync(to, [
  head([0x46546c67, 2, 12 + 8 + json.length + 8 + size, json.length, JSON_CHUNK]), json, head([size, BIN_CHUNK]), buffer,
].reduce((whole, part) => Buffer.concat([whole, part])));
