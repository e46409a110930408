// Runs a program compiled for wasm32-unknown-unknown: `node run.mjs PROGRAM.wasm`.
// The program gets no imports at all, so that nothing in it can ask for a clock, threads or files.
import { readFile } from "node:fs/promises";

const module = await WebAssembly.compile(await readFile(process.argv[2]));
const imports = WebAssembly.Module.imports(module);
if (imports.length > 0) {
  console.error("the program has imports:", imports.map((entry) => `${entry.module}.${entry.name}`).join(", "));
  process.exit(1);
}
const { exports } = await WebAssembly.instantiate(module);
const start = performance.now();
const status = exports.main(0, 0);
const megabytes = exports.memory.buffer.byteLength / 2 ** 20;
console.log(`WebAssembly: all checks passed in ${Math.round(performance.now() - start)} ms, ${megabytes.toFixed(0)} MB of memory`);
process.exit(status);
