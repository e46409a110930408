/** Edits by mouse, by keyboard and by panels; each is undone to the bit. */

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { lookFrom, measures, onPage, openText, settle, start } from "./browser.mjs";

const BLOCK = JSON.stringify({
  planecut: 1,
  model: { difference: [{ box: { min: [0, 0, 0], max: [4, 3, 2] }, name: "block" }, { box: { min: [1, 1, -1], max: [2, 2, 3] }, name: "hole" }] },
});

async function openBlock(options = {}) {
  const started = await start(options);
  await openText(started.page, "block.json", BLOCK);
  await started.page.waitForFunction(() => globalThis.planecut.document.source?.name === "block.json");
  await settle(started.page);
  await lookFrom(started.page, [1, -1.3, 0.8]);
  return started;
}

/** Drags with the mouse from one place of the model to another. */
async function drag(page, from, to, steps = 8) {
  const [a, b] = [await onPage(page, from), await onPage(page, to)];
  await page.mouse.move(a.x, a.y);
  await page.waitForFunction(() => document.querySelector("canvas").dataset.over === "face");
  await page.mouse.down();
  for (let k = 1; k <= steps; k++) {
    await page.mouse.move(a.x + ((b.x - a.x) * k) / steps, a.y + ((b.y - a.y) * k) / steps);
    await page.waitForTimeout(20);
  }
  await settle(page);
  await page.mouse.up();
  await settle(page);
}

const meshOf = (page) => page.evaluate(async () => [...(await globalThis.planecut.document.kernel.call("encode", "obj"))].join());

test("a face that is dragged moves its plane, as one step, which is undone to the bit", async () => {
  const { page, errors, close } = await openBlock();
  const before = await meshOf(page);
  await drag(page, [4, 1.5, 1], [5, 1.5, 1]);
  const { volume, max } = await measures(page);
  assert.ok(Math.abs(max[0] - 5) < 0.02, `${max}`);
  assert.ok(Math.abs(volume - (max[0] * 6 - 2)) < 1e-9);
  assert.equal(await page.evaluate(() => globalThis.planecut.document.history.undo), 1);
  await page.keyboard.press("Control+z");
  await settle(page);
  assert.equal(await meshOf(page), before);
  await page.keyboard.press("Control+Shift+z");
  await settle(page);
  assert.equal((await measures(page)).volume, volume);
  // what is drawn is what the kernel has
  const drawn = await page.evaluate(() => globalThis.planecut.document.faces.faces.size);
  assert.equal(drawn, (await measures(page)).faces);
  assert.deepEqual(errors, []);
  await close();
});

test("a drag snaps to the grid and to planes of others", async () => {
  const { page, close } = await openBlock();
  await page.fill('input[aria-label="Distance of the grid, 0 for none"]', "0.5");
  await page.keyboard.press("Tab");
  await drag(page, [4, 1.5, 1], [4.63, 1.5, 1]);
  assert.equal((await measures(page)).max[0], 4.5);
  await close();
});

test("a step that is ended by Escape leaves nothing", async () => {
  const { page, close } = await openBlock();
  const before = await meshOf(page);
  const [a, b] = [await onPage(page, [4, 1.5, 1]), await onPage(page, [6, 1.5, 1])];
  await page.mouse.move(a.x, a.y);
  await page.waitForFunction(() => document.querySelector("canvas").dataset.over === "face");
  await page.mouse.down();
  await page.mouse.move((a.x + b.x) / 2, (a.y + b.y) / 2);
  await page.mouse.move(b.x, b.y);
  await settle(page);
  await page.keyboard.press("Escape");
  await page.waitForTimeout(100);
  await settle(page);
  await page.mouse.up();
  assert.equal(await meshOf(page), before);
  assert.equal(await page.evaluate(() => globalThis.planecut.document.history.undo), 0);
  await close();
});

test("planes are turned, cut, removed with a preview, and put back", async () => {
  const { page, close } = await openBlock();
  await page.keyboard.press("2");
  await drag(page, [4, 1.5, 1], [4.4, 1.5, 1.4]);
  assert.notEqual((await measures(page)).volume, 22);
  await page.keyboard.press("Control+z");
  await settle(page);
  assert.equal((await measures(page)).volume, 22);
  await page.keyboard.press("3");
  await page.evaluate(() => globalThis.planecut.document.select({ brush: 0, plane: null, face: null }));
  await drag(page, [3, 0, 2], [3, 3, 2]);
  const cut = (await measures(page)).volume;
  assert.ok(cut < 22 && cut > 0, `${cut}`);
  const plane = await page.evaluate(() => globalThis.planecut.document.selection.plane);
  assert.equal(plane, 6);
  await page.waitForSelector('[data-key="remove-plane"]');
  const children = () => page.evaluate(() => globalThis.planecut.viewer.overlay.children.length);
  const bare = await children();
  await page.hover('[data-key="remove-plane"]');
  await page.waitForFunction((count) => globalThis.planecut.viewer.overlay.children.length > count, bare);
  await page.click('[data-key="remove-plane"]');
  await settle(page);
  assert.equal((await measures(page)).volume, 22);
  await page.keyboard.press("Control+z");
  await settle(page);
  assert.equal((await measures(page)).volume, cut);
  await close();
});

test("brushes are added, copied, changed and deleted, and all of it is undone", async () => {
  const { page, errors, close } = await openBlock();
  const before = await meshOf(page);
  const choose = async (menu, item) => {
    await page.click(`header button:text-is("${menu}")`);
    await page.click(`[role=menuitem]:text-is("${item}")`);
    await settle(page);
  };
  await choose("Add", "Add box");
  assert.equal((await measures(page)).brushes, 3);
  await page.keyboard.press("Escape");
  await page.evaluate(() => globalThis.planecut.document.select({ brush: 1, plane: null, face: null }));
  await page.waitForSelector('[data-key="role"]');
  await page.selectOption('[data-key="role"]', "add");
  await settle(page);
  assert.ok((await measures(page)).volume > 22);
  await page.fill('[data-key="name"]', "post");
  await page.keyboard.press("Tab");
  await page.fill('[data-key="material"]', "brass");
  await page.keyboard.press("Tab");
  await settle(page);
  assert.match(await page.locator(".tree-row").nth(1).textContent(), /post.*brass/);
  await page.click('[data-key="copy"]');
  await settle(page);
  assert.equal((await measures(page)).brushes, 4);
  await page.click('[data-key="delete"]');
  await settle(page);
  assert.equal((await measures(page)).brushes, 3);
  for (let k = 0; k < 20; k++) {
    await page.keyboard.press("Control+z");
  }
  await settle(page);
  assert.equal(await meshOf(page), before);
  assert.equal(await page.locator('button:text-is("Undo")').isDisabled(), true);
  assert.ok(errors.length === 0, errors.join());
  await close();
});

test("parameters and the text build the model again, and an error is marked at its line", async () => {
  const { page, close } = await start({ query: "#example=gear.json" });
  await page.click("#tab-Parameters");
  const before = (await measures(page)).volume;
  const input = page.locator(".parameters input[type=number]").first();
  await input.fill(String(Number(await input.inputValue()) + 4));
  await page.keyboard.press("Tab");
  await settle(page);
  assert.notEqual((await measures(page)).volume, before);
  await page.click("#tab-Text");
  await page.waitForSelector(".cm-content");
  await page.evaluate(async () => {
    const text = '{"planecut": 1,\n"model":\n{"box": {"min": [0, 0, 0], "max": [2, 2]}}}';
    await globalThis.planecut.document.open({ name: "gear.json", bytes: new TextEncoder().encode('{"planecut": 1,\n"model":\n{"box": {"min": [0, 0, 0], "max": [2, 2, 2]}}}'), parameters: {} });
    globalThis.brokenText = text;
  });
  await page.locator(".cm-content").click();
  await page.keyboard.press("Control+a");
  await page.keyboard.insertText('{"planecut": 1,\n"model":\n{"box": {"min": [0, 0, 0], "max": [2, 2]}}}');
  await page.waitForSelector(".cm-lint-marker-error");
  assert.match(await page.locator(".source .note").textContent(), /gear\.json:3/);
  assert.equal((await measures(page)).volume, 8);
  await page.keyboard.press("Control+a");
  await page.keyboard.insertText('{"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [2, 2, 3]}}}');
  await page.waitForFunction(async () => (await globalThis.planecut.document.kernel.call("measures", false)).volume === 12);
  assert.equal(await page.locator(".cm-lint-marker-error").count(), 0);
  await close();
});

test("what an address says is there again", async () => {
  const { page, origin, close } = await start({ query: "#example=bracket.json" });
  await page.evaluate(async () => {
    const { document, look } = globalThis.planecut;
    await document.edit({ op: "move_plane", brush: 0, plane: 0, offset: (await document.brush(0)).planes[0].half_space[3] + 1 });
    look.toggleSection();
  });
  await settle(page);
  const { volume } = await measures(page);
  await page.waitForFunction(() => location.hash.includes("edits=") && location.hash.includes("look="));
  const address = await page.evaluate(() => location.href);
  assert.ok(address.startsWith(origin));
  await page.goto("about:blank");
  await page.goto(address);
  await page.waitForSelector("body[data-ready]");
  assert.equal((await measures(page)).volume, volume);
  assert.ok(await page.evaluate(() => globalThis.planecut.viewer.sectionPlane !== null));
  await close();
});

test("an address holds a file of one's own, what was typed, and the edits", async () => {
  const { page, origin, close } = await start();
  await openText(page, "own.json", '{"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [2, 3, 4]}}}');
  await page.waitForFunction(() => globalThis.planecut.document.source?.name === "own.json");
  await page.evaluate(() => globalThis.planecut.document.edit({ op: "move_plane", brush: 0, plane: 1, offset: 3 }));
  await settle(page);
  const { volume } = await measures(page);
  await page.waitForFunction(() => location.hash.includes("source=") && location.hash.includes("edits="));
  const address = await page.evaluate(() => location.href);
  assert.ok(address.startsWith(origin));
  await page.goto("about:blank");
  await page.goto(address);
  await page.waitForSelector("body[data-ready]");
  assert.equal(await page.evaluate(() => globalThis.planecut.document.source.name), "own.json");
  assert.equal((await measures(page)).volume, volume);
  // a text that was changed is no example any more
  await page.goto("about:blank");
  await page.goto(`${origin}/#example=gear.json`);
  await page.waitForSelector("body[data-ready]");
  await page.click("#tab-Text");
  await page.click(".cm-content");
  await page.keyboard.press("Control+a");
  await page.keyboard.insertText('{"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [1, 1, 7]}}}');
  await page.waitForFunction(() => location.hash.includes("source=") && !location.hash.includes("example="));
  await page.reload();
  await page.waitForSelector("body[data-ready]");
  assert.ok(Math.abs((await measures(page)).volume - 7) < 1e-9);
  await close();
});

test("a model that was edited is saved and opened with its tree, names and materials of faces", async () => {
  const { page, errors, close } = await openBlock();
  const facts = () =>
    page.evaluate(async () => {
      const { document: model } = globalThis.planecut;
      const { volume } = await model.kernel.call("measures", false);
      const brushes = await Promise.all([...model.brushes.keys()].map(async (brush) => (await model.brush(brush)).planes.map(({ half_space, material }) => [...half_space, material])));
      return { volume, brushes, names: [...model.brushes.values()].map(({ name, role }) => [name, role]) };
    });
  await page.evaluate(async () => {
    const { document: model } = globalThis.planecut;
    await model.edit({ op: "move_plane", brush: 1, plane: 0, offset: 2.1 });
    await model.edit({ op: "set_material", brush: 0, plane: 2, material: "red \"paint\"" });
  });
  await settle(page);
  await page.waitForFunction(() => globalThis.planecut.document.materials.some(({ name }) => name.startsWith("red")));
  const before = await facts();
  await page.click('button:has-text("File")');
  const [download] = await Promise.all([page.waitForEvent("download"), page.click('[role=menuitem]:has-text("model file")')]);
  assert.equal(download.suggestedFilename(), "block.json");
  await openText(page, "back.json", readFileSync(await download.path(), "utf8"));
  await page.waitForFunction(() => globalThis.planecut.document.source?.name === "back.json");
  await settle(page);
  assert.deepEqual(await facts(), before);
  assert.ok(before.brushes[0].some(([, , , , material]) => material === 'red "paint"'));
  assert.deepEqual(errors, []);
  await close();
});
