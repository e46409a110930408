/** The state of the page in its address: what is open, what was done to it, where the camera is and how the picture is drawn. */

import type { Edit, Source } from "../kernel/protocol";
import type { LookState } from "./look";

/** What an address says. */
export interface AddressState {
  /** An address of the same server. */
  file?: string;
  /** The file of an example. */
  example?: string;
  /** A file of the user's own: all of it. */
  source?: Pick<Source, "name" | "bytes">;
  parameters?: Record<string, number>;
  edits?: Edit[];
  /** Position and target of the camera. */
  camera?: number[];
  look?: LookState;
}

/** Longest text of edits, and of a file, that goes into an address. */
const LONGEST = 16_000;

async function through(bytes: BufferSource, transform: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(transform);
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** More bytes than this are not tried: they do not become so few. */
const MOST_BYTES = 1 << 21;

/** Bytes as a text; nothing where it would be longer than the longest. */
async function packedBytes(bytes: Uint8Array<ArrayBuffer>): Promise<string | null> {
  if (bytes.length > MOST_BYTES) {
    return null;
  }
  const small = await through(bytes, new CompressionStream("deflate-raw"));
  if (small.length > 0.75 * LONGEST) {
    return null;
  }
  return btoa(String.fromCharCode(...small)).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

async function unpackedBytes(text: string): Promise<Uint8Array> {
  const bytes = Uint8Array.from(atob(text.replace(/-/g, "+").replace(/_/g, "/")), (letter) => letter.charCodeAt(0));
  return through(bytes, new DecompressionStream("deflate-raw"));
}

async function packed(value: unknown): Promise<string | null> {
  return packedBytes(new TextEncoder().encode(JSON.stringify(value)));
}

async function unpacked(text: string): Promise<unknown> {
  return JSON.parse(new TextDecoder().decode(await unpackedBytes(text)));
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
  const [name, text] = [hash.get("name"), hash.get("source")];
  if (name && text) {
    try {
      state.source = { name, bytes: await unpackedBytes(text) };
    } catch {
      // an address that was cut off by whoever sent it
    }
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
  const put = (name: string, text: string | null) => {
    if (text === null) {
      fits = false;
    } else {
      hash.set(name, text);
    }
  };
  if (state.source) {
    put("source", await packedBytes(state.source.bytes as Uint8Array<ArrayBuffer>));
    if (fits) {
      hash.set("name", state.source.name);
    }
  }
  if (state.parameters && Object.keys(state.parameters).length > 0) {
    put("parameters", await packed(state.parameters));
  }
  if (state.look) {
    put("look", await packed(state.look));
  }
  // without the file that they are done to, edits say nothing
  if (fits && state.edits && state.edits.length > 0) {
    put("edits", await packed(state.edits));
  }
  const text = hash.toString();
  history.replaceState(null, "", text ? `#${text}` : location.pathname + location.search);
  return fits;
}
