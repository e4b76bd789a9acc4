// The report of thirty runs: one table, one filter, one context of WebGL, and what a phone makes of it.
import assert from "node:assert/strict";
import { readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { begin, changed, end, folder, near, numberOf, open, pixels, report, run, saved, table, tick } from "./browser.mjs";

const moduli = [500, 750, 1000, 1500, 2000];
const stiffnesses = [2, 3, 4, 5, 6, 7];
const stiffnessKey = "contraction.apical.stiffness_nN_per_um";
let thirty; // an open page that tests share; each leaves all runs shown

before(async () => {
  const coarse = ["embryo.cells=[12, 7, 6]", "region.furrow.cells_along=8", "region.furrow.cells_across=3", "furrow.vce_cell=1",
    "time.end_s=20", "output.frame_every_s=10"];
  const one = (name, young, stiffness, ...more) =>
    run("drosophila", name, ...[...coarse, `elasticity.young_modulus_Pa=${young}`, `${stiffnessKey}=${stiffness}`, ...more]
      .flatMap((setting) => ["--set", setting]));
  const names = [];
  for (const young of moduli)
    for (const stiffness of stiffnesses) {
      names.push(`E${young}-k${stiffness}`);
      one(names.at(-1), young, stiffness);
    }
  report(names, "thirty.html");
  const ramp = [];
  for (let i = 0; i < 6; ++i) ramp.push(`E1000-k${stiffnesses[(5 * i + 2) % 6]}`);
  report(ramp, "ramp.html");
  one("failed", 1000, 2.5, "time.end_s=10");
  report(["failed", ...ramp.slice(1)], "uneven.html");
  makeUneven("uneven.html");
  await begin();
  thirty = await open("thirty.html");
});

after(async () => {
  await thirty?.done();
  await end();
});

// As if the run called failed had failed, half of all frames had been left out, and the others' tissue passed through itself.
function makeUneven(file) {
  const page = readFileSync(join(folder, file), "utf8");
  const [mark, ending] = ['<script type="application/json" id="data">', "</script>"];
  const from = page.indexOf(mark) + mark.length;
  const data = JSON.parse(page.slice(from, page.indexOf(ending, from)));
  for (const one of data.runs) {
    one.every = 2;
    one.frames_saved *= 2;
    if (one.name === "failed") {
      Object.assign(one.summary, { status: "failed", failure: `a cell turns inside out; ${"lower what pulls; ".repeat(20)}` });
      continue;
    }
    const [head, ...rows] = one.series.trim().split("\n").map((line) => line.split(","));
    const place = head.indexOf("self_intersections");
    for (const row of rows) row[place] = "1";
    one.series = [head, ...rows].map((row) => row.join(",")).join("\n");
  }
  const text = JSON.stringify(data).replaceAll("<", "\\u003c");
  writeFileSync(join(folder, file), page.slice(0, from) + text + page.slice(page.indexOf(ending, from)));
}

const shownRuns = (page, part) =>
  page.locator(`${part} [data-run]:visible`).evaluateAll((all) => all.map((one) => one.dataset.run));
const samples = (page) => page.locator(".runs tbody tr").evaluateAll((rows) => rows.map((row) => {
  const line = row.querySelector(".sample line");
  return { run: row.dataset.run, colour: line.getAttribute("stroke"), dash: line.getAttribute("stroke-dasharray") };
}));

test("a table of the runs says in what they differ and what came out, and sorts", async () => {
  const { page } = thirty;
  assert.equal(await page.locator(".runs tbody tr").count(), 30);
  const cell = (name, key) => page.locator(`.runs tr[data-run="${name}"] td[data-key="${key}"]`).textContent();
  for (const name of ["E500-k2", "E2000-k7"]) {
    assert.equal(numberOf(await cell(name, "elasticity.young_modulus_Pa")), Number(name.match(/E(\d+)/)[1]));
    assert.equal(numberOf(await cell(name, stiffnessKey)), Number(name.match(/k(\d)/)[1]));
    const summary = JSON.parse(readFileSync(join(folder, name, "summary.json"), "utf8"));
    near(numberOf(await cell(name, "furrow_depth_um")), summary.furrow_depth_um, 1e-3, "depth");
  }
  const depths = () => page.locator('.runs td[data-key="furrow_depth_um"]').allTextContents();
  for (const sign of [1, -1]) {
    await page.click('.runs th[data-key="furrow_depth_um"] button');
    const sorted = (await depths()).map(numberOf);
    assert.deepEqual(sorted, [...sorted].sort((a, b) => sign * (a - b)));
  }
  // Pictures and midlines lie in the same order.
  const first = await page.locator(".runs tbody tr").first().getAttribute("data-run");
  for (const part of ["#canvases", "#midline"]) {
    const order = await page.locator(`${part} [data-run]`).evaluateAll((all) =>
      all.sort((a, b) => a.style.order - b.style.order).map((one) => one.dataset.run));
    assert.equal(order[0], first, part);
  }
  assert.equal(await page.title(), "Ventral furrow of Drosophila melanogaster", "one title for all");
});

test("thirty runs have thirty lines; where one number differs, lightness follows it", async () => {
  const lines = await samples(thirty.page);
  assert.equal(new Set(lines.map(({ colour, dash }) => `${colour} ${dash}`)).size, 30);
  await thirty.page.selectOption("#colour-by", stiffnessKey);
  assert.equal(new Set((await samples(thirty.page)).map(({ colour }) => colour)).size, 6);
  // Six runs of one modulus have one colour: dashes tell them apart.
  await thirty.page.selectOption("#colour-by", "elasticity.young_modulus_Pa");
  const byModulus = await samples(thirty.page);
  assert.equal(new Set(byModulus.map(({ colour }) => colour)).size, 5);
  assert.equal(new Set(byModulus.map(({ colour, dash }) => `${colour} ${dash}`)).size, 30);
  for (const dark of [false, true]) {
    const { page, done } = await open("ramp.html", { dark });
    const light = ({ colour }) => {
      const [r, g, b] = colour.match(/\d+/g).map((part) => (part / 255) ** 2.2);
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const ordered = (await samples(page)).sort((a, b) => a.run.localeCompare(b.run));
    for (let i = 1; i < ordered.length; ++i)
      assert.ok(light(ordered[i]) > 1.08 * light(ordered[i - 1]), `${ordered[i].run} is lighter than ${ordered[i - 1].run}`);
    await done();
  }
});

test("text and ticks show and hide runs everywhere at once", async () => {
  const { page } = thirty;
  await page.fill("#filter", "k7 young>=1000");
  const wanted = ["E1000-k7", "E1500-k7", "E2000-k7"];
  for (const part of [".runs", "#canvases", "#midline", "#texts"]) assert.deepEqual((await shownRuns(page, part)).sort(), wanted, part);
  assert.match(await page.textContent("#shown-count"), /3 of 30/);
  await tick(page, '.runs tr[data-run="E1500-k7"] input', false);
  for (const part of ["#canvases", "#midline"]) assert.deepEqual((await shownRuns(page, part)).sort(), ["E1000-k7", "E2000-k7"], part);
  const rows = (await saved(page, "#save-table")).bytes.toString().trim().split("\n").slice(1);
  assert.equal(rows.length, table("E1000-k7/series.csv").length + table("E2000-k7/series.csv").length);
  for (const [text, count] of [["young=500", 6], ["stiffness_nN_per_um<3.5", 10], ["E1 k2", 2], ["k>=3", 0], ["time=20", 29]]) {
    await page.fill("#filter", text);
    assert.equal((await shownRuns(page, "#canvases")).length, count, text);
  }
  await page.fill("#filter", "E500");
  await page.click("#tick-none");
  assert.equal((await shownRuns(page, "#canvases")).length, 0);
  await page.click("#tick-all");
  assert.equal((await shownRuns(page, "#canvases")).length, 6);
  await page.fill("#filter", "nothing-like-it");
  assert.match(await page.textContent("#shown-count"), /0 of 30/);
  await page.fill("#filter", "");
  assert.equal((await shownRuns(page, "#canvases")).length, 29);
  await tick(page, '.runs tr[data-run="E1500-k7"] input', true);
});

test("pictures are drawn where they are seen, all by one context; one is made large", async () => {
  const { page, done } = await open("thirty.html", { height: 700 });
  const drawn = () => page.locator(".picture[data-cells]").count();
  const first = await drawn();
  assert.ok(first >= 1 && first <= 20, `${first} drawn at first`);
  await page.locator(".view").last().scrollIntoViewIfNeeded();
  await page.waitForFunction(() => document.querySelectorAll(".view:last-child .picture[data-cells]").length > 0);
  const last = await pixels(page, ".view:last-child .picture");
  let inked = 0;
  for (let y = 0; y < last.height; y += 3) for (let x = 0; x < last.width; x += 3) inked += last.rgb(x, y)[2] < 225;
  assert.ok(inked > 300, `the last picture has ${inked} inked pixels`);
  const name = await page.locator(".view").last().getAttribute("data-run");
  const small = await page.locator(".view").last().boundingBox();
  await page.click(`.view[data-run="${name}"] .caption`);
  const large = await page.locator(`.view[data-run="${name}"]`).boundingBox();
  assert.ok(large.width > 3 * small.width && large.height > 2 * small.height, "large");
  await page.click(`.view[data-run="${name}"] .caption`);
  assert.equal((await page.locator(`.view[data-run="${name}"]`).boundingBox()).width, small.width);
  await done();
});

test("what the hand points at stands out in every plot", async () => {
  const { page } = thirty;
  const before = await pixels(page, "#plots .uplot");
  await page.mouse.move(0, 0);
  await page.locator('.runs tr[data-run="E500-k7"]').dispatchEvent("pointerenter");
  await page.waitForTimeout(100);
  const values = await page.locator(".pointed-value").allTextContents();
  assert.ok(values.length >= 8 && values.every((value) => value.startsWith("E500-k7: ")), values.join());
  near(numberOf(values[0].split(": ")[1]), table("E500-k7/series.csv").at(-1).furrow_depth_um, 1e-3, "depth");
  assert.ok(changed(before, await pixels(page, "#plots .uplot")) > 0.002, "the others fade");
  await page.locator('.runs tr[data-run="E500-k7"]').dispatchEvent("pointerleave");
});

test("a finger's tap makes a run stand out until the next one; moving the page does not", async () => {
  const { page, done } = await open("thirty.html", { width: 390, height: 844 });
  const touch = (selector, ...kinds) => page.locator(selector).first().evaluate((target, kinds) => {
    for (const kind of kinds)
      target.dispatchEvent(new PointerEvent(kind, { pointerType: "touch", bubbles: kind === "click" || kind === "pointerdown" }));
  }, kinds);
  const pointed = () => page.locator(".runs tr.pointed").evaluateAll((rows) => rows.map((row) => row.dataset.run));
  const begun = ["pointerenter", "pointerdown"];
  await touch('.runs tr[data-run="E500-k3"]', ...begun, "pointerleave");
  assert.deepEqual(await pointed(), [], "the page was moved");
  await touch('.runs tr[data-run="E500-k3"]', ...begun, "pointerleave", "click");
  assert.deepEqual(await pointed(), ["E500-k3"]);
  await touch('#midline [data-run="E750-k2"]', ...begun, "pointerleave", "click");
  assert.deepEqual(await pointed(), ["E750-k2"]);
  assert.match(await page.locator(".pointed-value").first().textContent(), /^E750-k2: /);
  await done();
});

test("what a page of many runs says of each is said once: ends before the time shown, failures, frames left out, crossings", async () => {
  const { page, done } = await open("uneven.html");
  assert.match(await page.textContent("#headline"), /^6 runs; .*; 1 failed$/);
  assert.match(await page.textContent("#thinned"), /^This page shows only some snapshots of 6 of 6 runs \(every 2nd, /);
  assert.match(await page.textContent("#crossing"), /^In 5 of 6 runs \(see their status\), the first from [\d.]+ min on, /);
  assert.match(await page.locator("#texts .note").nth(1).textContent(), /\d+ of \d+ snapshots are in this page/);
  // Why one has failed is more than one line has room for: it comes after all numbers.
  const columns = await page.locator(".runs thead th").evaluateAll((heads) => heads.map((head) => head.dataset.key));
  assert.ok(columns.indexOf("failure") > columns.indexOf("max_volume_error"), "words after numbers");
  // The picture of a run that has ended says so; the others have the page's time.
  const written = async (name) => {
    const picture = await pixels(page, `.view[data-run="${name}"] .picture`);
    let dark = 0;
    for (let y = 2; y < 16; ++y) for (let x = 6; x < picture.width - 6; ++x) dark += Math.max(...picture.rgb(x, y)) < 120;
    return dark;
  };
  const ended = await written("failed");
  assert.ok(ended > 20, `${ended} dark pixels above the run that has failed`);
  assert.equal(await written("E1000-k7"), 0);
  await done();
});

test("a picked cell goes with its run when that is hidden, and comes back with it", async () => {
  const { page } = thirty;
  await page.fill("#cell-id", "3");
  await page.click("#cell button");
  await page.waitForSelector("#cell dl");
  const name = await page.locator("#cell dd").first().textContent();
  await tick(page, `.runs tr[data-run="${name}"] input`, false);
  assert.equal(await page.locator("#cell dl").count(), 0);
  assert.equal(await page.locator("#cell .chart").count(), 0);
  await tick(page, `.runs tr[data-run="${name}"] input`, true);
  assert.equal(await page.locator("#cell dl").count(), 1);
});

test("on a phone nothing is wider than the screen, and a finger still moves the page", async () => {
  const { page, done } = await open("thirty.html", { width: 390, height: 844 });
  const [wide, room] = await page.evaluate(() => [document.scrollingElement.scrollWidth, innerWidth]);
  assert.ok(wide <= room, `${wide} pixels wide on ${room}`);
  assert.equal(await page.locator(".picture").first().evaluate((canvas) => getComputedStyle(canvas).touchAction), "pan-y");
  await page.locator("#canvases").evaluate((canvases) => canvases.scrollIntoView());
  const boxes = await page.locator(".view").evaluateAll((all) => all.map((one) => one.getBoundingClientRect().x));
  assert.equal(new Set(boxes).size, 2, "two beside each other");
  await done();
});

test("thirty runs stay one small file, soon seen", async () => {
  const bytes = statSync(join(folder, "thirty.html")).size;
  assert.ok(bytes < 6e6, `${bytes} bytes`);
  const { page } = thirty;
  const ms = await page.evaluate(() => performance.getEntriesByName("first-picture")[0].startTime);
  console.log(`${(bytes / 1e6).toFixed(2)} MB; first picture after ${ms.toFixed(0)} ms`);
});
