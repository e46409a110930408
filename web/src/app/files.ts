/** Files that come in, and files that leave. */

import type { Source } from "../kernel/protocol";

/** A file, and where it can be had again: an address of the server or an example; neither for a file of the user's own. */
export interface ModelFile extends Source {
  origin: { file?: string; example?: string };
}

/** The endings of files that can be opened. */
export const READABLE = [".json", ".map", ".csg", ".stl", ".obj", ".ply", ".glb", ".gltf"];

/** The endings of files that can be saved, and what they are called. */
export const WRITABLE: [string, string][] = [
  ["json", "model file (.json)"],
  ["glb", "glTF (.glb)"],
  ["stl", "STL"],
  ["3mf", "3MF"],
  ["obj", "OBJ"],
  ["ply", "PLY"],
  ["map", "Quake map, convex brushes"],
  ["csg", "OpenSCAD tree, convex brushes"],
];

/** Most bytes of a file: what fits into the memory of a page. */
const LIMIT = 1 << 29;

/** A file that was dropped or chosen. */
export async function sourceOfFile(file: File): Promise<ModelFile> {
  if (file.size > LIMIT) {
    throw new Error(`${file.name}: found ${file.size} bytes, expected at most ${LIMIT}`);
  }
  return { name: file.name, bytes: new Uint8Array(await file.arrayBuffer()), parameters: {}, origin: {} };
}

/** A file from an address of the same server; an example has a name of its own. */
export async function sourceOfAddress(address: string, example?: string): Promise<ModelFile> {
  const url = new URL(address, location.href);
  if (url.origin !== location.origin) {
    throw new Error(`${address}: found the address of another server, expected one of ${location.host}: the page loads nothing from elsewhere`);
  }
  const response = await fetch(url);
  if (!response.ok) {
    throw new Error(`${address}: the server says ${response.status} ${response.statusText}`);
  }
  const last = decodeURIComponent(url.pathname.split("/").at(-1) ?? "");
  const origin = example === undefined ? { file: address } : { example };
  return { name: example ?? last, bytes: new Uint8Array(await response.arrayBuffer()), parameters: {}, origin };
}

/** Hands bytes to the user as a file. */
export function download(bytes: BlobPart, name: string, type = "application/octet-stream") {
  const address = URL.createObjectURL(new Blob([bytes], { type }));
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  // the browser has taken the address when the click returns, but not read it
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** The name of a file without its ending. */
export function stem(name: string): string {
  return name.replace(/\.[^.]*$/, "") || "model";
}
