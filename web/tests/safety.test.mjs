/** A kernel that ends, nothing from elsewhere, and a keyboard alone. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { measures, settle, start } from "./browser.mjs";

test("a kernel that ends is started again with the last good state", async () => {
  const { page, close } = await start({ query: "#example=bracket.json" });
  await page.evaluate(async () => {
    const { document } = globalThis.planecut;
    const { half_space } = (await document.brush(0)).planes[0];
    await document.edit({ op: "move_plane", brush: 0, plane: 0, offset: half_space[3] + 2 });
  });
  const { volume } = await measures(page);
  await page.evaluate(() => globalThis.planecut.document.kernel.call("fail").catch(() => {}));
  await page.waitForSelector(".message.error:has-text('started again with the last good state')");
  assert.equal((await measures(page)).volume, volume);
  // and by hand, in the middle of work
  await page.evaluate(() => {
    const { kernel } = globalThis.planecut.document;
    kernel.call("coarsen", { maxCells: 3 }).catch(() => {});
    kernel.restart("stopped by the user");
  });
  await page.waitForFunction(() => /stopped by the user/.test(document.querySelector(".messages").textContent));
  await settle(page);
  assert.equal((await measures(page)).volume, volume);
  await close();
});

test("everything can be reached by a keyboard alone", async () => {
  const { page, errors, close } = await start({ query: "#example=bracket.json" });
  const before = (await measures(page)).volume;
  await page.keyboard.press("Tab");
  const seen = new Set();
  for (let k = 0; k < 60; k++) {
    seen.add(await page.evaluate(() => document.activeElement.textContent.slice(0, 30) || document.activeElement.getAttribute("aria-label") || document.activeElement.tagName));
    await page.keyboard.press("Tab");
  }
  for (const name of ["File", "Add", "View", "Drag faces", "Tree", "Edit"]) {
    assert.ok(seen.has(name), `${name} in ${[...seen].join(", ")}`);
  }
  await page.locator(".tree-list").focus();
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowDown");
  await settle(page);
  assert.ok(await page.evaluate(() => globalThis.planecut.document.selection !== null));
  await page.locator("canvas").focus();
  await page.keyboard.press("n");
  await settle(page);
  await page.keyboard.press("]");
  await settle(page);
  assert.notEqual((await measures(page)).volume, before);
  await page.keyboard.press("Control+z");
  await settle(page);
  assert.equal((await measures(page)).volume, before);
  const from = await page.evaluate(() => globalThis.planecut.viewer.camera.position.toArray());
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("+");
  assert.notDeepEqual(await page.evaluate(() => globalThis.planecut.viewer.camera.position.toArray()), from);
  await page.locator('header button:text-is("File")').focus();
  await page.keyboard.press("Enter");
  await page.keyboard.press("ArrowDown");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Open…");
  await page.keyboard.press("Escape");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "File");
  assert.deepEqual(errors, []);
  await close();
});

test("controls have names, and texts enough contrast, in both themes", async () => {
  for (const dark of [false, true]) {
    const { page, close } = await start({ dark });
    const nameless = await page.evaluate(() =>
      [...document.querySelectorAll("button, input:not([hidden]), select, canvas, [role=tab]")]
        .filter((element) => !(element.textContent.trim() || element.getAttribute("aria-label") || element.labels?.length || element.title))
        .map((element) => element.outerHTML),
    );
    assert.deepEqual(nameless, []);
    const contrasts = await page.evaluate(() => {
      const luminance = (color) => {
        const [r, g, b] = color.match(/[\d.]+/g).map(Number).map((value) => (value / 255 <= 0.03928 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const background = (element) => {
        for (let at = element; at; at = at.parentElement) {
          const color = getComputedStyle(at).backgroundColor;
          if (!/, 0\)$|transparent/.test(color)) {
            return color;
          }
        }
        return "rgb(255, 255, 255)";
      };
      const texts = [...document.querySelectorAll("button, label, .note, h3, dt, dd, .tree-row span, .counts")].filter((element) => element.textContent.trim() && !element.disabled && element.getClientRects().length > 0);
      return texts.map((element) => {
        const [a, b] = [luminance(getComputedStyle(element).color), luminance(background(element))];
        return { text: element.textContent.slice(0, 20), ratio: (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05) };
      });
    });
    const poor = contrasts.filter(({ ratio }) => ratio < 4.5);
    assert.deepEqual(poor, [], dark ? "dark" : "light");
    await close();
  }
});

test("a narrow window shows all parts, one below another", async () => {
  const { page, errors, close } = await start({ width: 400, height: 760 });
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(overflow <= 0, `${overflow} pixels too wide`);
  for (const name of ["Tree", "Edit", "Look", "Measure"]) {
    await page.click(`#tab-${name}`);
    assert.ok(await page.locator(`#panel-${name}`).isVisible());
  }
  assert.deepEqual(errors, []);
  await close();
});
