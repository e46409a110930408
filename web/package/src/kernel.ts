/** The WebAssembly module: loaded once, used by all. */

import load, { type InitOutput } from "../wasm/planecut_web.js";

import { InternalError, PlanecutError } from "./errors.js";

/** What {@link init} takes: the module as bytes, compiled, as an address or as the response to a request. */
export type KernelSource = BufferSource | WebAssembly.Module | URL | Response;

let loading: Promise<InitOutput> | null = null;
let memory: WebAssembly.Memory | null = null;
let bug: string | null = null;

/** The module from the disk, in Node; its address for `fetch`, elsewhere. */
async function ownModule(): Promise<URL | BufferSource> {
  const address = new URL("../wasm/planecut_web_bg.wasm", import.meta.url);
  if (address.protocol !== "file:") {
    return address;
  }
  // a name in a variable, so that bundlers for browsers do not look for it
  const name = "node:fs/promises";
  const { readFile } = (await import(/* @vite-ignore */ /* webpackIgnore: true */ name)) as typeof import("node:fs/promises");
  return readFile(address);
}

/**
 * Loads the kernel; nothing else works before. Another call gives the same, unless the first one failed.
 *
 * @param source - The module; by default the one of the package.
 */
export async function init(source?: KernelSource): Promise<void> {
  loading ??= (async () => load({ module_or_path: (source ?? (await ownModule())) as BufferSource }))();
  try {
    ({ memory } = await loading);
  } catch (error) {
    loading = null;
    throw error;
  }
}

/** Bytes of the kernel's memory, which grows and never shrinks. */
export function memoryBytes(): number {
  return memory?.buffer.byteLength ?? 0;
}

/** Names of options are written as they are in JavaScript. */
function withOurNames(message: string): string {
  return message.replace(/^[a-z]+(?:_[a-z]+)+(?=:)/, (name) => name.replace(/_([a-z])/g, (_, letter: string) => letter.toUpperCase()));
}

function translated(error: unknown): unknown {
  if (!(error instanceof Error)) {
    return error;
  }
  if (error.name === "PlanecutError") {
    const { line, jsonPath } = error as { line?: number | null; jsonPath?: string | null };
    return new PlanecutError(withOurNames(error.message), { line: line ?? null, jsonPath: jsonPath ?? null });
  }
  if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError) {
    // whatever was worked on is half-done, and its locks are held
    bug = error.message;
    const isSaid = error.name === "InternalError";
    const message = isSaid ? error.message : `found a failure of WebAssembly (${error.message}), expected none; nothing of this instance can be used any more: begin another worker or process`;
    return new InternalError(message, { cause: error });
  }
  if (error.name === "InternalError") {
    return new InternalError(error.message, { cause: error });
  }
  if (error.message === "null pointer passed to rust") {
    return new PlanecutError("found an object that was freed, expected one that was not");
  }
  return error;
}

/**
 * Does something with the kernel; what it throws becomes one of our errors.
 *
 * @internal
 */
export function guarded<T>(work: () => T): T {
  if (!memory) {
    throw new PlanecutError("found a kernel that is not loaded, expected `await init()` before anything else");
  }
  if (bug !== null) {
    throw new InternalError(`found an instance that an earlier bug left half-done (${bug}), expected another worker or process`);
  }
  try {
    return work();
  } catch (error) {
    throw translated(error);
  }
}
