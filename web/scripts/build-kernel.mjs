/**
 * Compiles the kernel to WebAssembly and puts it, with its JavaScript and types, into package/wasm.
 *
 * The standard library is compiled with it, where its source is or can be had: its feature `optimize_for_size` saves a sixth of the module, nearly all of it sorts, that are there once for every type. Cargo
 * calls that unstable (`-Z build-std`); without it the module is larger, and the same otherwise.
 */

import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import { homedir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, gzipSync } from "node:zlib";

const web = resolve(fileURLToPath(new URL("..", import.meta.url)));
const root = dirname(web);
const out = join(web, "package/wasm");
const target = resolve(root, process.env.CARGO_TARGET_DIR ?? "target");
const triple = "wasm32-unknown-unknown";

function spawned(command, args, env = {}) {
  const { status, error } = spawnSync(command, args, { cwd: root, stdio: "inherit", env: { ...process.env, ...env } });
  return { ok: !error && status === 0, status, error };
}

function run(command, args, env = {}) {
  const { ok, status, error } = spawned(command, args, env);
  if (!ok) {
    console.error(`${command} ${args.join(" ")}: ${error?.message ?? `exit status ${status}`}`);
    process.exit(1);
  }
}

/** The source of the standard library, fetched where it can be. */
function hasLibrarySource() {
  const source = join(sysroot, "lib/rustlib/src/rust/library/Cargo.lock");
  if (!existsSync(source)) {
    spawned("rustup", ["component", "add", "rust-src"]);
  }
  return existsSync(source);
}

/** Whether a file is there and not older than another. */
function isFresh(file, than) {
  try {
    return statSync(file).mtimeMs >= statSync(than).mtimeMs;
  } catch {
    return false;
  }
}

const sysroot = spawnSync("rustc", ["--print", "sysroot"], { encoding: "utf8" }).stdout?.trim();
if (!existsSync(join(sysroot, "lib/rustlib", triple))) {
  run("rustup", ["target", "add", triple]);
}
// messages of panics name files: as they are called within packages, not where they lie on this machine
const cargoHome = process.env.CARGO_HOME ?? join(homedir(), ".cargo");
const places = [[join(cargoHome, "registry/src"), "crates"], [root, "planecut"], [join(sysroot, "lib/rustlib/src/rust/library"), "std"]];
const flags = places.map(([from, to]) => `--remap-path-prefix=${from}=${to}`);
const cargoArguments = ["build", "--locked", "--profile", "web", "--package", "planecut-web", "--target", triple];
const environment = { CARGO_ENCODED_RUSTFLAGS: flags.join("\x1f") };
if (hasLibrarySource()) {
  cargoArguments.push("-Z", "build-std=std,panic_abort", "-Z", "build-std-features=optimize_for_size");
  environment.RUSTC_BOOTSTRAP = "1";
} else {
  console.log("kernel: the source of the standard library cannot be had (rustup component add rust-src), so the module is a sixth larger");
}
run("cargo", cargoArguments, environment);
const compiled = join(target, triple, "web/planecut_web.wasm");
const module = join(out, "planecut_web_bg.wasm");
if (!isFresh(module, compiled)) {
  rmSync(out, { recursive: true, force: true });
  mkdirSync(out, { recursive: true });
  run("cargo", ["run", "--quiet", "--locked", "--package", "planecut-bindgen", "--", compiled, out]);
  // the optimiser of binaryen as a program of the package
  const binaryen = dirname(createRequire(import.meta.url).resolve("binaryen"));
  const features = ["bulk-memory", "mutable-globals", "nontrapping-float-to-int", "reference-types", "sign-ext", "multivalue"];
  run(process.execPath, [join(binaryen, "bin/wasm-opt"), module, "-o", module, "-Oz", "--strip-debug", ...features.map((name) => `--enable-${name}`)]);
}
const bytes = readFileSync(module);
const kilobytes = (length) => `${(length / 1000).toFixed(0)} kB`;
console.log(`kernel: ${kilobytes(bytes.length)}, ${kilobytes(gzipSync(bytes, { level: 9 }).length)} as gzip, ${kilobytes(brotliCompressSync(bytes).length)} as brotli`);
