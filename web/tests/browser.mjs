/** A browser on the built page: Debian's Chromium, driven by playwright-core. */

import { existsSync } from "node:fs";
import { mkdir, readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize, resolve } from "node:path";
import { fileURLToPath } from "node:url";

import { chromium } from "playwright-core";

const here = fileURLToPath(new URL(".", import.meta.url));
export const dist = resolve(here, "../dist");
export const out = resolve(here, "out");
const examples = resolve(here, "../../examples");

/** Where Debian puts the browser. */
export const browserPath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", process.env.CHROMIUM].find((path) => path && existsSync(path));

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".svg": "image/svg+xml", ".png": "image/png", ".json": "application/json" };

/** A plain file server on a free port of this machine, as any would do; `models` are further files under `models/`. */
async function serve(models) {
  const server = createServer(async (request, response) => {
    const path = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
    const model = /^\/models\/(.+)$/.exec(path)?.[1];
    const file = model ? models(model) : join(dist, normalize(path === "/" ? "/index.html" : path));
    try {
      const body = await readFile(file);
      response.writeHead(200, { "content-type": TYPES[extname(file)] ?? "application/octet-stream" });
      response.end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { server, origin: `http://127.0.0.1:${server.address().port}` };
}

/** What a test needs; `close` ends it. */
export async function start({ width = 1280, height = 800, query = "", dark = false, models = (name) => join(examples, name), wait = true } = {}) {
  await mkdir(out, { recursive: true });
  const { server, origin } = await serve(models);
  const browser = await chromium.launch({
    executablePath: browserPath,
    args: [
      "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
      "--disable-background-networking", "--disable-component-update", "--disable-sync", "--enable-precise-memory-info",
    ],
  });
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light", acceptDownloads: true, permissions: ["clipboard-read", "clipboard-write"] });
  // other tests may keep both cores busy
  context.setDefaultTimeout(120_000);
  const page = await context.newPage();
  const [errors, foreign] = [[], []];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  page.on("request", (request) => {
    const url = request.url();
    if (!url.startsWith(origin) && !url.startsWith("blob:") && !url.startsWith("data:")) {
      foreign.push(url);
    }
  });
  await page.goto(`${origin}/${query}`);
  if (wait) {
    await page.waitForSelector("body[data-ready]");
  }
  const close = async () => {
    await browser.close();
    server.closeAllConnections();
    server.close();
  };
  return { page, origin, errors, foreign, close };
}

/** Volume, area and counts of what is open. */
export async function measures(page) {
  return page.evaluate(() => globalThis.planecut.document.kernel.call("measures", false));
}

/** Opens a text as a file that was chosen. */
export async function openText(page, name, text) {
  await page.setInputFiles("input[type=file]", { name, mimeType: "application/octet-stream", buffer: Buffer.from(text) });
}

/** Waits until the kernel has nothing to do and the page has shown it. */
export async function settle(page) {
  await page.waitForFunction(() => !globalThis.planecut.document.kernel.isBusy);
  await page.waitForTimeout(80);
  await page.waitForFunction(() => !globalThis.planecut.document.kernel.isBusy);
}

/** Looks at the model from a direction so that all of it is in view. */
export async function lookFrom(page, direction) {
  await page.evaluate((from) => {
    const { viewer, document } = globalThis.planecut;
    const vector = viewer.camera.position.clone().set(...from);
    viewer.lookFrom(vector);
    viewer.fit(document.faces.box());
    viewer.frame();
  }, direction);
}

/** Where a place of the model is on the page. */
export async function onPage(page, place) {
  return page.evaluate((at) => {
    const { viewer, document } = globalThis.planecut;
    const vector = viewer.camera.position.clone().set(at[0] - document.center[0], at[1] - document.center[1], at[2] - document.center[2]);
    return viewer.onPage(vector);
  }, place);
}
