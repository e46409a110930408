/** Runs the tests of the page in a browser; says so where there is none. */

import { spawnSync } from "node:child_process";
import { existsSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

import { browserPath, dist } from "./browser.mjs";

const here = fileURLToPath(new URL(".", import.meta.url));

if (!browserPath) {
  console.log("page in a browser: skipped, there is no Chromium (Debian's package chromium, or a path in CHROMIUM)");
  process.exit(0);
}
if (!existsSync(join(dist, "index.html"))) {
  console.error("found no page in web/dist, expected one: npm run build makes it");
  process.exit(1);
}
const files = readdirSync(here).filter((name) => name.endsWith(".test.mjs")).map((name) => join(here, name));
// one after another: each has a browser, and times are measured
const { status } = spawnSync(process.execPath, ["--test", "--test-concurrency=1", ...process.argv.slice(2), ...files], { stdio: "inherit" });
process.exit(status ?? 1);
