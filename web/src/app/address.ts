/** The state of the page in its address: what is open, what was done to it, where the camera is and how the picture is drawn. */

import type { Edit } from "../kernel/protocol";
import type { LookState } from "../ui/look";

/** What an address says. */
export interface AddressState {
  /** An address of the same server. */
  file?: string;
  /** The file of an example. */
  example?: string;
  parameters?: Record<string, number>;
  edits?: Edit[];
  /** Position and target of the camera. */
  camera?: number[];
  look?: LookState;
}

/** Longest text of edits that goes into an address. */
const LONGEST = 16_000;

async function through(bytes: BufferSource, transform: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(transform);
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function packed(value: unknown): Promise<string> {
  const bytes = await through(new TextEncoder().encode(JSON.stringify(value)), new CompressionStream("deflate-raw"));
  return btoa(String.fromCharCode(...bytes)).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

async function unpacked(text: string): Promise<unknown> {
  const bytes = Uint8Array.from(atob(text.replace(/-/g, "+").replace(/_/g, "/")), (letter) => letter.charCodeAt(0));
  return JSON.parse(new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw"))));
}

/** Reads the address of the page. Parts that cannot be read are left out. */
export async function readAddress(): Promise<AddressState> {
  const state: AddressState = {};
  const query = new URLSearchParams(location.search);
  const hash = new URLSearchParams(location.hash.slice(1));
  const file = query.get("file") ?? hash.get("file");
  const example = hash.get("example");
  if (file) {
    state.file = file;
  }
  if (example) {
    state.example = example;
  }
  const camera = hash.get("camera")?.split(",").map(Number);
  if (camera?.length === 6 && camera.every(Number.isFinite)) {
    state.camera = camera;
  }
  for (const name of ["parameters", "edits", "look"] as const) {
    const text = hash.get(name);
    if (text) {
      try {
        state[name] = (await unpacked(text)) as never;
      } catch {
        // an address that was cut off by whoever sent it
      }
    }
  }
  return state;
}

/** Writes a state into the address of the page; tells whether all of it fits. */
export async function writeAddress(state: AddressState): Promise<boolean> {
  const hash = new URLSearchParams();
  let fits = true;
  if (state.example) {
    hash.set("example", state.example);
  }
  if (state.file && !new URLSearchParams(location.search).has("file")) {
    hash.set("file", state.file);
  }
  if (state.camera) {
    hash.set("camera", state.camera.map((value) => Number(value.toPrecision(6))).join(","));
  }
  if (state.parameters && Object.keys(state.parameters).length > 0) {
    hash.set("parameters", await packed(state.parameters));
  }
  if (state.look) {
    hash.set("look", await packed(state.look));
  }
  if (state.edits && state.edits.length > 0) {
    const text = await packed(state.edits);
    fits = text.length <= LONGEST;
    if (fits) {
      hash.set("edits", text);
    }
  }
  const text = hash.toString();
  history.replaceState(null, "", text ? `#${text}` : location.pathname + location.search);
  return fits;
}
