// Shows glTF files in headless Chromium, by three.js.
//
//   node view.js CHROMIUM WIDTHxHEIGHT AZIMUTH ELEVATION
//
// Jobs on standard input, one a line: {"path": …, "picture": PNG, "sliver": height}. For each a line of JSON with the path and either
// what three.js found ("facts") or what went wrong ("error"), and what the page said on its console ("said").

import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { createInterface } from "node:readline";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const [executablePath, size, azimuth, elevation] = process.argv.slice(2);
const [width, height] = size.split("x").map(Number);
const HERE = fileURLToPath(new URL(".", import.meta.url));
const THREE = fileURLToPath(new URL("../node_modules/three/", import.meta.url));
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".glb": "model/gltf-binary", ".gltf": "model/gltf+json" };

let asset = null;

/** The file behind an address: one of this folder, of three.js, or the asset that is looked at. */
function fileOf(address) {
  const path = normalize(decodeURIComponent(new URL(address, "http://localhost").pathname));
  if (path.startsWith("/asset/")) return asset;
  return path.startsWith("/three/") ? join(THREE, path.slice("/three/".length)) : join(HERE, path);
}

const server = createServer(async (request, response) => {
  try {
    const file = fileOf(request.url);
    const bytes = await readFile(file);
    response.writeHead(200, { "Content-Type": TYPES[extname(file)] ?? "application/octet-stream" }).end(bytes);
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
const origin = `http://127.0.0.1:${server.address().port}`;

const browser = await chromium.launch({
  executablePath,
  args: ["--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const page = await browser.newPage({ viewport: { width, height }, deviceScaleFactor: 1 });
let said = [];
// What a driver says about its speed is not about the asset.
const aboutTheDriver = (text) => text.includes("GL Driver Message") || text.includes("favicon");
page.on("console", (message) => {
  if (["warning", "error"].includes(message.type()) && !aboutTheDriver(message.text() + message.location().url)) {
    said.push(message.text());
  }
});
page.on("pageerror", (error) => said.push(String(error)));
await page.goto(`${origin}/page.html`);
await page.waitForFunction(() => globalThis.show !== undefined);

for await (const line of createInterface({ input: process.stdin })) {
  const { path, picture, sliver } = JSON.parse(line);
  [asset, said] = [path, []];
  const answer = { path };
  try {
    // The number keeps the browser from taking another asset from its cache.
    const url = `/asset/${Date.now()}${extname(path)}`;
    const options = { url, sliver, width, height, azimuth: +azimuth, elevation: +elevation };
    answer.facts = await page.evaluate((options) => globalThis.show(options), options);
    await page.screenshot({ path: picture, omitBackground: true });
  } catch (error) {
    answer.error = String(error).split("\n")[0];
  }
  console.log(JSON.stringify({ ...answer, said }));
}

await browser.close();
server.close();
