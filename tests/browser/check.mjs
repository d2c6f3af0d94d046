// Uses a page as a reader would and checks what it shows: node check.mjs report|compare|live PAGE [PICTURES]
import assert from "node:assert/strict";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./cdp.mjs";

const [kind, address, pictures] = process.argv.slice(2);
const url = address.includes("://") ? address : pathToFileURL(address).href;

const text = (page, selector) => page.eval(`document.querySelector(${JSON.stringify(selector)}).textContent`);
const count = (page, selector) => page.eval(`document.querySelectorAll(${JSON.stringify(selector)}).length`);
const tick = page => page.eval("Math.floor(player.time)");

async function fits(page, what) {
  const [wide, screen] = await page.eval("[document.documentElement.scrollWidth, innerWidth]");
  assert.ok(wide <= screen, `${what}: ${wide} pixels wide on a screen of ${screen}`);
}

// Clicks the middle of robot `i`, as it is drawn now.
async function clickRobot(page, canvas, scene, i) {
  const [x, y] = await page.eval(`[${scene}.toX(${scene}.frame.robots[${i}].x), ${scene}.toY(${scene}.frame.robots[${i}].y)]`);
  await page.click(canvas, x, y);
}

const painted = (page, canvas) => page.eval(`(() => { const c = document.querySelector(${JSON.stringify(canvas)});
  const all = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
  let n = 0; for (let i = 3; i < all.length; i += 4) n += all[i] > 0; return n; })()`);

async function report(page) {
  const [runs, robots, last] = await page.eval("[runs.length, runs[0].count, lastTick]");
  assert.ok(last > 30, "the run is long enough to play");
  assert.equal(await count(page, "#scenes canvas"), runs);
  assert.ok(await count(page, "#cards .card") >= 12 * runs);
  await page.until("document.querySelectorAll('#charts svg').length > 0");
  const titles = await page.eval("[...document.querySelectorAll('#charts figure h3')].map(h => h.textContent)");
  for (const title of ["Motion", "Prediction horizon", "Control input, x", "Control input, y", "Constraint activations", "Solver level"]) {
    assert.equal(titles.filter(other => other === title).length, runs, `${title} in ${titles}`);
  }
  assert.equal(titles.filter(title => title.startsWith("Separation") || title.startsWith("Latency")).length, 2 * runs);
  assert.equal(await count(page, "#charts figure:first-of-type svg path"), runs * robots, "a path per robot in the motion plot");
  assert.ok(await painted(page, "#scenes canvas") > 500, "the scene is painted");
  assert.equal(await page.eval("performance.getEntriesByType('resource').length"), 0, "nothing is loaded");

  await page.click("#play");
  await page.until("player.time > 4");
  assert.equal(await text(page, "#play"), "Pause");
  await page.eval("document.activeElement.blur()");
  await page.key(" ", "Space");
  assert.equal(await text(page, "#play"), "Play");
  const held = await tick(page);
  await page.eval("new Promise(resolve => setTimeout(resolve, 200))");
  assert.equal(await tick(page), held, "a paused replay stands still");

  await page.eval("(() => { const s = document.getElementById('scrub'); s.value = 20; s.dispatchEvent(new Event('input')); })()");
  assert.match(await text(page, "#time"), /^tick 20 \//);
  await page.key("ArrowRight");
  assert.equal(await tick(page), 21);
  await page.key("ArrowLeft");
  await page.key("ArrowLeft");
  assert.equal(await tick(page), 19);
  await page.key("End");
  assert.equal(await tick(page), last);
  await page.key("Home");
  assert.equal(await tick(page), 0);
  const speed = await page.eval("document.getElementById('speed').value");
  await page.key("+");
  assert.ok(Number(await page.eval("document.getElementById('speed').value")) > Number(speed));

  await clickRobot(page, "#scenes canvas", "scenes[0]", 1);
  assert.equal(await text(page, "#followed"), "following robot 1");
  assert.equal(await page.eval("charts[0].series.filter(line => line.classList.contains('dim')).length"), robots - 1);
  await page.key("Escape");
  assert.equal(await text(page, "#followed"), "");

  const drawing = await page.eval(`(() => { const start = performance.now();
    for (let t = 0; t < 60; t++) { player.time = t % lastTick; show(); } return (performance.now() - start) / 60; })()`);
  console.log(`${await page.eval("innerWidth")} px: ${drawing.toFixed(2)} ms to draw a moment`);
}

async function compare(page) {
  const all = await page.eval("families.size");
  assert.equal(await count(page, "#families > details"), all);
  const rows = await page.eval("comparison.rows.length + totals.length");
  assert.equal(await count(page, "#figures tbody tr"), rows);
  // What is closed is drawn when it is opened.
  assert.equal(await count(page, "#families > details[open]"), all > 3 ? 0 : all);
  await page.eval("document.querySelectorAll('#families > details').forEach(section => { section.open = true; })");
  await page.until(`document.querySelectorAll('#families svg').length === ${4 * all}`);
  const failing = await page.eval("comparison.rows.filter(row => row.successes < row.runs).length");
  assert.equal(await count(page, "#families figure:first-of-type rect.failed"), failing, "failures are red");
  if (all > 1) await manyFamilies(page, all);
}

// The index leads to a family, the filter leaves those that are looked for, layouts unfold.
async function manyFamilies(page, all) {
  const visible = selector => page.eval(`[...document.querySelectorAll(${JSON.stringify(selector)})].filter(e => !e.hidden).length`);
  await page.eval("document.querySelectorAll('#families > details').forEach(section => { section.open = false; })");
  await page.eval("document.querySelector('#index li:last-child a').click()");
  await page.until(`document.getElementById('family-${all - 1}').open`);
  await page.eval("(() => { const f = document.getElementById('filter'); f.value = shown[0].name; f.dispatchEvent(new Event('input')); })()");
  const found = await page.eval("shown.filter(family => family.name.includes(shown[0].name)).length");
  assert.equal(await visible("#families > details"), found);
  assert.equal(await visible("#index li"), found);
  assert.equal(await visible("#figures tbody tr"), await page.eval("totals.length") * (1 + found));
  await page.eval("(() => { const f = document.getElementById('filter'); f.value = ''; f.dispatchEvent(new Event('input')); })()");
  const folded = await count(page, ".layouts");
  if (folded) {
    await page.eval("document.querySelectorAll('.layouts').forEach(list => { list.open = true; })");
    await page.until(`document.querySelectorAll('.layouts table').length === ${folded}`);
  }
}

async function live(page) {
  await page.until("live.frames > 2");
  assert.match(await text(page, "#cards"), /tick\d+ of \d+/);
  assert.equal(await count(page, "#robots tr"), await page.eval("layout.robots.length"));
  assert.ok(await painted(page, "#scene") > 500, "the scene is painted");
  await page.click("#play");
  assert.equal(await text(page, "#play"), "Continue");
  await clickRobot(page, "#scene", "scene", 0);
  assert.equal(await text(page, "#followed"), "following robot 0");
  const held = await page.eval("live.held && live.frames");
  await page.click("#play");
  await page.until(`live.frames > ${held}`);
}

const browser = await Browser.open();
try {
  for (const width of [1280, 420]) {
    const page = await browser.page(url, width);
    await { report, compare, live }[kind](page);
    await fits(page, `${kind} at ${width}`);
    if (pictures) await page.screenshot(join(pictures, `${kind}-${width}.png`));
    if (kind === "live" && width === 420) await page.until("document.getElementById('state').textContent === 'the run has ended'");
    assert.deepEqual(page.errors, [], "no errors on the console");
  }
} finally {
  await browser.close();
}
