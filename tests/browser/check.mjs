// Opens reports as a reader would: clicks designs and the globe, and measures.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { after, test as nodeTest } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [work, shots] = process.argv.slice(2);

const PAGE_BYTES = 6e6;

const browser = await chromium.launch({
  executablePath: "/usr/bin/chromium",
  args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
    "--disable-component-update", "--no-first-run"],
});

/** The pages of the test that runs. */
const opened = [];

/** Whether the browser makes no frames of the page any more. */
const stalled = (page) => page.evaluate(() => Promise.race([
  new Promise((frame) => requestAnimationFrame(() => frame(false))),
  new Promise((late) => setTimeout(() => late(true), 3000)),
])).catch(() => false);

/**
 * A test that begins anew, twice at most, where it failed because headless Chromium stopped making frames of its page:
 * that happened to 3 of 92 pages, and no later event began them again.
 */
function test(name, steps) {
  nodeTest(name, async () => {
    for (let left = 2; ; left--) {
      try {
        return await steps();
      } catch (error) {
        const cause = await Promise.all(opened.map(stalled));
        if (left === 0 || !cause.includes(true)) throw error;
        console.log(`${name}: the browser stopped making frames of the page; the test begins anew`);
      } finally {
        opened.length = 0;
      }
    }
  });
}

/** Opens the report of a run; anything that must not happen is collected in `trouble`. */
async function open(run, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options });
  const page = await context.newPage();
  opened.push(page);
  const trouble = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) trouble.push(`console: ${message.text()}`);
  });
  page.on("pageerror", (error) => trouble.push(`error: ${error.stack}`));
  page.on("dialog", (dialog) => { trouble.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  const url = pathToFileURL(`${work}/${run}/report.html`).href;
  page.on("request", (request) => {
    if (request.url() !== url && !/^(data|blob):/.test(request.url())) trouble.push(`request: ${request.url()}`);
  });
  const start = performance.now();
  await page.goto(url, { waitUntil: "load" });
  return { page, context, trouble, start };
}

/** Scrolls through the page so that every figure is drawn. */
async function scrollThrough(page) {
  const height = await page.evaluate(() => document.documentElement.scrollHeight);
  for (let y = 0; y < height + 1000; y += 500) {
    await page.evaluate((to) => scrollTo(0, to), y);
    await page.waitForTimeout(60);
  }
  await page.waitForTimeout(300);
}

async function wholePage(page, name) {
  await scrollThrough(page);
  await page.evaluate(() => scrollTo(0, 0));
  await page.waitForTimeout(200);
  await page.screenshot({ path: `${shots}/${name}.png`, fullPage: true });
}

const mapValues = (page, id) => page.evaluate((map) => JSON.stringify(document.getElementById(map).data[0].z), id);
const place = (page) => page.evaluate(() => window.navwalker.state.place);

test("a search among shells has each variable once, and colours by a shell", async () => {
  const { page, context, trouble } = await open("shells");
  await scrollThrough(page);
  const names = await page.evaluate(() => document.getElementById("parallel").layout.xaxis.ticktext);
  assert.equal(new Set(names).size, names.length, names.join(", "));
  assert.ok(names.includes("A planes") && names.includes("cvar-pdop"), names.join(", "));
  // What is the same in all designs has no column.
  assert.ok(!names.includes("B inclination (°)"), names.join(", "));
  assert.deepEqual(await page.locator("#colour option").allTextContents(),
    ["satellites of shell A", "satellites of shell B", "none"]);
  assert.deepEqual(trouble, []);
  await context.close();
});

test("the paper's report is light, loads fast and follows a click", async () => {
  const bytes = statSync(`${work}/paper/report.html`).size;
  // Times are reported, not judged: they depend on the machine. Other load can only add, so the
  // smallest is reported.
  let loaded = Infinity;
  for (let n = 0; n < 3; n++) {
    const { page, context, start } = await open("paper");
    await page.waitForSelector("#pareto .scatterlayer .trace", { state: "attached" });
    loaded = Math.min(loaded, performance.now() - start);
    await context.close();
  }
  const { page, context, trouble } = await open("paper");
  console.log(`page ${(bytes / 1e6).toFixed(2)} MB, first figure after ${loaded.toFixed(0)} ms (aim: 1500)`);
  assert.ok(bytes <= PAGE_BYTES, `${bytes} bytes`);

  await scrollThrough(page);
  for (const id of ["pareto", "membership", "map-mean-visible", "map-mean-pdop", "map-p95-pdop", "map-max-pdop",
    "map-availability", "cdf-visible", "series-max-pdop", "series-mean-pdop", "tail", "convergence", "parallel", "budget"]) {
    assert.ok(await page.locator(`#${id} svg.main-svg`).count() > 0, `${id} is not drawn`);
  }
  // Light is good on every map, whether more is better or less.
  const reversed = await page.evaluate(() => ["map-mean-visible", "map-availability", "map-mean-pdop", "map-longest-outage-s"]
    .map((id) => document.getElementById(id).data[0].reversescale));
  assert.deepEqual(reversed, [false, false, true, true]);
  // Every figure can be saved, from the keyboard too.
  for (const [n, name] of ["svg", "png"].entries()) {
    const button = page.locator("figure:has(#map-max-pdop) button.save").nth(n);
    await button.focus();
    const [saved] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Enter")]);
    assert.equal(saved.suggestedFilename(), `map-max-pdop.${name}`);
    assert.ok(statSync(await saved.path()).size > 5000);
  }
  const before = await place(page);
  const maps = ["map-mean-visible", "map-mean-pdop", "map-p95-pdop", "map-max-pdop"];
  const values = await Promise.all(maps.map((id) => mapValues(page, id)));
  const picture = await page.locator("#map-mean-pdop").screenshot();
  const curve = await page.evaluate(() => JSON.stringify(document.getElementById("series-max-pdop").data.at(-1).y));

  // The first design of the front is its left end, which is not the fuzzy pick.
  const trace = await page.evaluate(() => document.getElementById("pareto").data.findIndex((t) => t.name === "front"));
  await page.locator("#pareto").scrollIntoViewIfNeeded();
  const point = page.locator("#pareto .scatterlayer .trace").nth(trace).locator("path.point").first();
  const box = await point.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2, { steps: 4 });
  // The point under the pointer shows its name first, as it does for a reader.
  await page.waitForSelector("#pareto .hoverlayer .hovertext");
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForFunction((old) => window.navwalker.state.place !== old, before);
  const after = await place(page);
  const notation = await page.locator("#choose option:checked").textContent();
  assert.ok(notation.startsWith(`${after + 1}: `), notation);
  await page.locator("#map-mean-pdop").scrollIntoViewIfNeeded();
  await page.waitForTimeout(300);
  for (const [n, id] of maps.entries()) assert.notEqual(await mapValues(page, id), values[n], `${id} did not follow`);
  assert.ok(!picture.equals(await page.locator("#map-mean-pdop").screenshot()), "the picture of the map did not change");
  assert.notEqual(await page.evaluate(() => JSON.stringify(document.getElementById("series-max-pdop").data.at(-1).y)), curve);

  await page.locator("#next").click();
  assert.equal(await place(page), after + 1);
  await page.locator("#choose").selectOption(String(before));
  assert.equal(await page.locator("#badge").isVisible(), true);
  assert.deepEqual(trouble, []);
  await wholePage(page, "desktop");
  // The picture in the README: trade-off, selected design and the first maps.
  const top = await page.evaluate(() => document.getElementById("tradeoff").offsetTop);
  await page.screenshot({ path: `${shots}/readme.png`, fullPage: true, clip: { x: 0, y: top, width: 1280, height: 1230 } });
  await context.close();
});

test("a slider goes through the maps at instants, from the keyboard too", async () => {
  const { page, context, trouble } = await open("paper", { reducedMotion: "reduce" });
  await scrollThrough(page);
  const slider = page.getByLabel("instant", { exact: true });
  const maps = ["instant-visible", "instant-pdop"];
  const drawn = () => Promise.all(maps.map((id) => mapValues(page, id)));
  /** The greatest PDOP of the points at the instant of the slider. */
  const greatest = () => page.evaluate(() => Math.max(...document.getElementById("instant-pdop").data[0].customdata.flat()));
  assert.match(await page.locator("#instant-time").textContent(), /^2025-01-01 00:00 UTC, 0 h after the epoch$/);
  const first = await drawn();
  await slider.focus();
  await page.keyboard.press("ArrowRight");
  assert.match(await slider.getAttribute("aria-valuetext"), /^2025-01-01 00:15 UTC, 0\.25 h/);
  assert.equal(await page.locator("#instant-time").textContent(), await slider.getAttribute("aria-valuetext"));
  await page.waitForFunction((old) => JSON.stringify(document.getElementById("instant-pdop").data[0].z) !== old, first[1]);
  const second = await drawn();
  for (const n of maps.keys()) assert.notEqual(second[n], first[n], maps[n]);
  // Satellites are whole, and the greatest PDOP is that of the series, but for the 16 bits of both.
  assert.ok(await page.evaluate(() => document.getElementById("instant-visible").data[0].customdata.flat()
    .every((value) => value === null || Number.isInteger(value))));
  const overTime = await page.evaluate(() => Core.cutsOf(Core.state.place).series["max-pdop"][15]);
  assert.ok(Math.abs(await greatest() - overTime) < 1e-3, `${await greatest()} ${overTime}`);
  await page.keyboard.press("End");
  assert.match(await page.locator("#instant-time").textContent(), /^2025-01-01 23:45 UTC, 23\.75 h/);
  // A constellation beside the front has maps as well; a member that is not chosen has none, and the page says so.
  await page.locator("#compared button.pick", { hasText: "star" }).click();
  assert.equal(await page.locator("#instant-maps").isVisible(), true);
  const chosen = await page.evaluate(() => Core.data.chosen);
  await page.locator("#choose").selectOption(String(chosen === 0 ? 1 : 0));
  assert.equal(await page.locator("#instant-maps").isVisible(), false);
  assert.match(await page.locator("#no-instants").textContent(), /star/);
  await page.locator("#choose").selectOption(String(chosen));
  assert.equal(await page.locator("#instant-maps").isVisible(), true);
  await page.locator("#instants").scrollIntoViewIfNeeded();
  await page.screenshot({ path: `${shots}/instants.png` });
  assert.deepEqual(trouble, []);
  await context.close();
});

for (const name of ["size", "sweep"]) {
  test(`the page of a ${name} needs no script, and suits a phone, dark mode and print`, async () => {
    const { page, context, trouble } = await open(name, { javaScriptEnabled: false });
    assert.ok(await page.locator("figure svg").count() >= 4);
    await page.screenshot({ path: `${shots}/${name}.png`, fullPage: true });
    await page.pdf({ path: `${shots}/${name}.pdf`, preferCSSPageSize: true });
    assert.deepEqual(trouble, []);
    await context.close();
    const phone = await open(name, { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, colorScheme: "dark" });
    const width = await phone.page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(width <= 390, `the page is ${width} px wide`);
    await phone.page.screenshot({ path: `${shots}/${name}-phone.png` });
    assert.deepEqual(phone.trouble, []);
    await phone.context.close();
  });
}

test("parallel coordinates have their variables between the bounds of the search", async () => {
  const { page, context, trouble } = await open("paper");
  await scrollThrough(page);
  const { names, ends } = await page.evaluate(() => {
    const { layout } = document.getElementById("parallel");
    return { names: layout.xaxis.ticktext, ends: layout.annotations.map((one) => [one.x, one.text]) };
  });
  const of = (name) => ends.filter(([x]) => x === names.indexOf(name)).map(([, text]) => Number(text)).sort((a, b) => a - b);
  // As in data/scenarios/paper.toml.
  assert.deepEqual(of("inclination (°)"), [40, 60]);
  assert.deepEqual(of("altitude (km)"), [400, 1000]);
  assert.deepEqual(trouble, []);
  await context.close();
});

test("compared constellations have a mark each and are selected in the plane and in the table", async () => {
  const { page, context, trouble } = await open("four");
  await page.waitForSelector("#pareto .scatterlayer .trace", { state: "attached" });
  const names = ["Proposed", "Polar", "Iridium-like", "Optimised-LFC"];
  const marks = await page.evaluate(() => document.getElementById("pareto").data.slice(0, 4)
    .map((trace) => ({ name: trace.name, symbol: trace.marker.symbol, color: trace.marker.color })));
  assert.deepEqual(marks.map((mark) => mark.name), names);
  for (const part of ["symbol", "color"]) assert.equal(new Set(marks.map((mark) => mark[part])).size, 4, part);
  const legend = page.locator("#pareto .legend .traces .legendtext");
  assert.deepEqual((await legend.allTextContents()).slice(0, 4), names);
  // The marks of the table are those of the plane.
  const rgb = (hex) => `rgb(${[1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)).join(", ")})`;
  const fills = await page.evaluate(() => [...document.querySelectorAll("#compared .mark path")].map((path) => getComputedStyle(path).fill));
  assert.deepEqual(fills, marks.map((mark) => rgb(mark.color)));
  assert.match(await page.locator("#dominance").textContent(), /Proposed dominates Polar/);
  assert.match(await page.locator("#compared tr.alone").textContent(), /GNSS alone/);
  for (const of of ["#membership", "#parallel", "#convergence", "#search"]) assert.equal(await page.locator(of).count(), 0, of);

  await scrollThrough(page);
  const figures = ["map-mean-visible", "map-mean-pdop", "map-p95-pdop", "map-max-pdop"];
  const values = await Promise.all(figures.map((id) => mapValues(page, id)));
  const bold = (id) => page.evaluate((figure) => document.getElementById(figure).data.at(-1).name, id);
  assert.equal(await bold("tail"), "Proposed");
  await page.locator("#compared button.pick").nth(1).click();
  assert.equal(await place(page), 1);
  assert.match(await page.locator("#choose option:checked").textContent(), /^Polar: star:90/);
  assert.equal(await page.locator("#compared tr.current").getAttribute("data-place"), "1");
  for (const [n, id] of figures.entries()) assert.notEqual(await mapValues(page, id), values[n], `${id} did not follow`);
  for (const id of ["cdf-visible", "series-max-pdop", "series-mean-pdop", "tail"]) assert.equal(await bold(id), "Polar", id);
  const tile = await page.locator("#tiles div").first().textContent();
  const column = await page.evaluate(() => [...document.querySelectorAll("#compared thead th")].findIndex((th) => th.textContent.trim() === "J_pos"));
  const cell = await page.locator("#compared tr.current > *").nth(column).textContent();
  assert.ok(tile.endsWith(cell), `${tile} ${cell}`);

  await page.locator("#pareto").scrollIntoViewIfNeeded();
  const box = await page.locator("#pareto .scatterlayer .trace").nth(3).locator("path.point").first().boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2, { steps: 4 });
  await page.waitForSelector("#pareto .hoverlayer .hovertext");
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForFunction(() => window.navwalker.state.place === 3);
  assert.deepEqual(trouble, []);
  await wholePage(page, "four");
  await context.close();

  for (const [name, options] of [["four-dark", { colorScheme: "dark" }],
    ["four-phone", { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true }]]) {
    const other = await open("four", options);
    await wholePage(other.page, name);
    const width = await other.page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(width <= (options.viewport?.width ?? 1280), `the page is ${width} px wide`);
    assert.deepEqual(other.trouble, []);
    await other.context.close();
  }
});

test("a constellation beside a front is selected like its members", async () => {
  const { page, context, trouble } = await open("paper");
  await scrollThrough(page);
  const values = await mapValues(page, "map-mean-pdop");
  await page.locator("#compared button.pick", { hasText: "star" }).click();
  assert.match(await page.locator("#choose option:checked").textContent(), /^star: star:86\.4/);
  assert.equal(await page.locator("#badge").isVisible(), false);
  assert.notEqual(await mapValues(page, "map-mean-pdop"), values);
  await page.locator("#previous").click();
  assert.match(await page.locator("#choose option:checked").textContent(), /^reference design/);
  assert.deepEqual(trouble, []);
  await context.close();
});

test("the globe draws every shell, and satellites of files with whatever name", async () => {
  const { page, context, trouble } = await open("files");
  await page.locator("#play").click();
  await page.locator("#globe").scrollIntoViewIfNeeded();
  assert.deepEqual(await page.locator("#shells span").allTextContents(), ["delta:53:72/6/1@1050", "star:90:60/6/1@800"]);
  const colours = await page.evaluate(() => [...document.querySelectorAll("#shells i")].map((dot) => dot.style.background));
  assert.equal(new Set(colours).size, 2);
  await page.waitForFunction(() => window.navwalker.sky().length > 0);
  await page.screenshot({ path: `${shots}/hybrid.png` });
  await page.locator("#choose").selectOption("1");
  assert.equal(await page.locator("#shells").isVisible(), false);
  assert.match(await page.locator("#drawn-from").textContent(), /positions every 5 min, interpolated/);
  // The satellites of the file are in low orbits all around the Earth: an order is over any horizon.
  const sky = await page.evaluate(() => window.navwalker.sky());
  assert.ok(sky.length >= 2 && sky.length <= 12, `${sky.length} over the horizon`);
  const option = await page.locator("#choose option").nth(1).textContent();
  assert.ok(option.includes("<img src=x") && option.includes("\\u{202e}"), option);
  await wholePage(page, "files");
  assert.equal(await page.evaluate(() => window.attacked), undefined);
  assert.deepEqual(trouble, []);
  await context.close();
});

test("the page suits a phone, dark mode and print", async () => {
  const phone = await open("paper", { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true });
  await wholePage(phone.page, "phone");
  // A page that is too wide makes a phone zoom out.
  const width = await phone.page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(width <= 390, `the page is ${width} px wide`);
  assert.deepEqual(phone.trouble, []);
  await phone.context.close();

  const dark = await open("paper", { colorScheme: "dark" });
  await wholePage(dark.page, "dark");
  assert.deepEqual(dark.trouble, []);
  await dark.context.close();

  const print = await open("paper");
  await print.page.emulateMedia({ media: "print" });
  await print.page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  await print.page.waitForTimeout(500);
  await print.page.pdf({ path: `${shots}/print.pdf`, format: "A4" });
  assert.deepEqual(print.trouble, []);
  await print.context.close();
});

test("the globe keeps up with 300 satellites and shows the sky of a point", async () => {
  const { page, context, trouble } = await open("many");
  await page.locator("#globe").scrollIntoViewIfNeeded();
  await page.waitForFunction(() => window.navwalker.frames().length >= 100, null, { timeout: 30000 });
  const frames = (await page.evaluate(() => window.navwalker.frames())).sort((a, b) => a - b);
  const median = frames[Math.floor(frames.length / 2)];
  console.log(`median ${median.toFixed(2)} ms of script a frame over ${frames.length} frames (aim: 8)`);

  const box = await page.locator("#globe").boundingBox();
  const caption = () => page.locator("#sky-caption").textContent();
  const before = await caption();
  await page.mouse.click(box.x + box.width / 2 + 40, box.y + box.height / 2 + 40);
  const where = (text) => text.split(":")[0];
  assert.notEqual(where(await caption()), where(before));
  await page.locator("#play").click();
  const stopped = await page.evaluate(() => window.navwalker.frames().length);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 120, box.y + box.height / 2, { steps: 5 });
  await page.mouse.up();
  assert.ok(stopped > 0 && where(await caption()) !== where(before));
  await page.screenshot({ path: `${shots}/globe.png` });
  assert.deepEqual(trouble, []);
  await context.close();
});

test("the axes of three objectives can be changed", async () => {
  const { page, context, trouble } = await open("points");
  const title = () => page.evaluate(() => document.getElementById("pareto").layout.yaxis.title.text);
  await page.waitForSelector("#pareto .scatterlayer .trace", { state: "attached" });
  const before = await title();
  await page.locator("#axes select").nth(1).selectOption("2");
  assert.notEqual(await title(), before);
  await wholePage(page, "points");
  assert.deepEqual(trouble, []);
  await context.close();
});

test("the sky shows the skyline that the numbers were computed with", async () => {
  const { page, context, trouble } = await open("walled");
  await page.locator("#play").click();
  await page.locator("#sky").scrollIntoViewIfNeeded();
  await page.waitForFunction(() => window.navwalker.sky().length > 0);
  const sky = (await page.evaluate(() => window.navwalker.sky())).map((s) => ({ visible: s.visible,
    elevation: s.elevation * 180 / Math.PI, azimuth: (s.azimuth * 180 / Math.PI + 360) % 360 }));
  const walled = (s) => s.azimuth > 1 && s.azimuth < 179;
  const free = (s) => s.azimuth > 180;
  assert.ok(sky.some((s) => walled(s) && s.elevation > 7 && s.elevation < 80), "nothing behind the wall");
  for (const s of sky) {
    if (walled(s)) assert.equal(s.visible, s.elevation >= 80, JSON.stringify(s));
    if (free(s)) assert.equal(s.visible, s.elevation >= 7, JSON.stringify(s));
  }
  const caption = await page.locator("#sky-caption").textContent();
  assert.ok(caption.includes(`${sky.filter((s) => s.visible).length} LEO satellites above the mask of 7° and the skyline of up to 80°`), caption);
  assert.match(caption, /GNSS satellites, which are not drawn, is 12°/);
  await page.locator("#sky").screenshot({ path: `${shots}/sky.png` });
  assert.deepEqual(trouble, []);
  await context.close();
});

test("an empty front says so", async () => {
  const { page, context, trouble } = await open("empty");
  assert.match(await page.locator("aside.gaps").textContent(), /no design/);
  assert.equal(await page.locator("#pareto").count(), 0);
  await wholePage(page, "empty");
  assert.deepEqual(trouble, []);
  await context.close();
});

test("damage is reported and hostile texts stay texts", async () => {
  const { page, context, trouble } = await open("hostile");
  const gaps = await page.locator("aside.gaps").textContent();
  assert.match(gaps, /history\.json is damaged/);
  assert.match(gaps, /1 of 3 designs of the front cannot be read/);
  await page.locator("#next").click();
  await scrollThrough(page);
  await page.locator("#pareto").scrollIntoViewIfNeeded();
  const box = await page.locator("#pareto .nsewdrag").first().boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForTimeout(200);
  await page.screenshot({ path: `${shots}/hostile.png` });
  assert.equal(await page.evaluate(() => window.attacked), undefined);
  assert.match(await page.locator("#choose option").nth(1).textContent(), /<script>/);
  assert.deepEqual(trouble, []);
  await context.close();
});

test("ten thousand members still open and follow", async () => {
  const { page, context, trouble, start } = await open("large");
  await page.waitForSelector("#pareto .scatterlayer .trace", { state: "attached" });
  console.log(`ten thousand members: first figure after ${(performance.now() - start).toFixed(0)} ms`);
  await page.evaluate(() => window.navwalker.select(17));
  assert.equal(await page.locator("#no-cuts").isVisible(), true);
  await scrollThrough(page);
  assert.match(await page.locator("aside.gaps").textContent(), /of the 10000 designs on the front/);
  assert.deepEqual(trouble, []);
  await context.close();
});

after(() => browser.close());
