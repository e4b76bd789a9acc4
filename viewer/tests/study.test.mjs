// The report of a study: one with failures, one that keeps the runs' own reports, and one of 10 000 runs.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { begin, changed, end, folder, near, numberOf, open, pixels, saved } from "./browser.mjs";

const plica = process.env.PLICA ? resolve(process.env.PLICA) : "plica";
const stiffness = "contraction.apical.stiffness_nN_per_um";
const young = "elasticity.young_modulus_Pa";

function study(name, text) {
  writeFileSync(join(folder, `${name}.toml`), text);
  execFileSync(plica, ["study", join(folder, `${name}.toml`), "--out", join(folder, name), "--quiet", "--jobs", "2"]);
}

// As if the first points made no scenario.
function refuse(name, count) {
  const out = join(folder, name);
  const lines = readFileSync(join(out, "runs.csv"), "utf8").trim().split("\n");
  const refused = lines.slice(1, count + 1).map((line) => {
    const fields = line.split(",");
    return [...fields.slice(0, 5), "refused", "", "", "", "0", "0.001", `${stiffness}: 1 does not go with the others`].join(",");
  });
  writeFileSync(join(out, "runs.csv"), `${[lines[0], ...refused, ...lines.slice(count + 1)].join("\n")}\n`);
  rmSync(join(out, "rows"), { recursive: true });
  execFileSync(plica, ["report", out]);
}

const head = (scenario) => `format = 1\nscenario = "${scenario}"\n[set]\n"time.end_min" = 0.05\n`;

before(async () => {
  study("grid", `${head("drosophila")}[vary]\n"${stiffness}" = { values = [1, 3, 5, 7] }\n"${young}" = { values = [800, 1200] }
"contraction.apical.region" = { values = ["furrow", "all"] }\n[design]\nkind = "grid"
[keep]\nmeasures = ["furrow_depth_um", "vml_apical_area_ratio", "lips_closed_time_s"]\n`);
  refuse("grid", 4);
  study("kept", `${head("drosophila")}[vary]\n"${stiffness}" = { low = 3, high = 30, scale = "log" }\n"${young}" = { low = 800, high = 1200 }
[design]\nkind = "latin-hypercube"\npoints = 3\n[keep]\neach = "full"\n`);
  closing();
  large(10_000);
  await begin();
});

after(end);

// A grid of three by two, of made-up values that have each verdict.
function closing() {
  const out = join(folder, "closing");
  mkdirSync(out);
  const measures = ["furrow_depth_um", "furrow_depth_below_lips_um", "lips_closed_time_s", "self_intersections"];
  const results = [[55, 40, 900, 0], [38.7, -4.2, "", 0], [3, 1.5, "", 0], [3, -2, "", 0], [60, 40, 900, 3], [-0.1, -0.3, "", 0]]; // the last one failed
  const pairs = results.map((_, i) => [[400, 600, 800][i % 3], i < 3 ? 1 : 2]);
  const points = results.map((_, i) => `${i},${i + 1},1,${pairs[i]},`);
  const runs = results.map((row, i) => `${i + 1},${pairs[i]},1,${i < 5 ? "end_time" : "failed"},${row},10,1.5,`);
  const text = `format = 1\nscenario = "drosophila"\n[vary]\n"${young}" = { values = [400, 600, 800] }\n"${stiffness}" = { values = [1, 2] }\n[design]\nkind = "grid"\n`;
  const begun = { format: 1, plica: "another", processor: "none", name: "closing", file: join(out, "study.toml"), runs: 6, keys: [young, stiffness], measures };
  for (const [file, content] of [["points.csv", [`run,point,replicate,${young},${stiffness},seeds`, ...points, ""].join("\n")],
    ["runs.csv", [`point,${young},${stiffness},replicate,status,${measures},steps,wall_s,reason`, ...runs, ""].join("\n")],
    ["study.toml", text], ["study.json", JSON.stringify(begun)]]) writeFileSync(join(out, file), content);
  execFileSync(plica, ["report", out]);
}

// A study as plica leaves it, of made-up values.
function large(count) {
  const out = join(folder, "large");
  mkdirSync(out);
  const measures = ["furrow_depth_um", ...Array.from({ length: 45 }, (_, i) => `made_up_${i}_um`)];
  let state = 1;
  const random = () => (state = (state * 48271) % 2147483647) / 2147483647;
  const [points, runs] = [[`run,point,replicate,${stiffness},${young},seeds`], [`point,${stiffness},${young},replicate,status,${measures},steps,wall_s,reason`]];
  for (let i = 0; i < count; ++i) {
    const [k, e, isBad] = [10 ** (2 * random()), 500 + 1500 * random(), random() < 0.04];
    points.push(`${i},${i + 1},1,${k},${e},`);
    const values = measures.map((_, m) => (isBad ? "" : m === 0 ? (40 * k) / (k + e / 50) + random() : random() * 10 ** (m / 9)));
    runs.push(`${i + 1},${k},${e},1,${isBad ? "failed" : "equilibrium"},${values},${isBad ? 0 : 40},1.5,${isBad ? `at ${(900 * random()).toFixed(1)} s: the step got too short` : ""}`);
  }
  const text = `format = 1\nscenario = "drosophila"\n[vary]\n"${stiffness}" = { low = 1, high = 100, scale = "log" }\n"${young}" = { low = 500, high = 2000 }\n[design]\nkind = "sobol"\npoints = ${count}\n`;
  const begun = { format: 1, plica: "another", processor: "none", name: "large", file: join(out, "study.toml"), runs: count, keys: [stiffness, young], measures };
  for (const [file, content] of [["points.csv", `${points.join("\n")}\n`], ["runs.csv", `${runs.join("\n")}\n`], ["study.toml", text], ["study.json", JSON.stringify(begun)]])
    writeFileSync(join(out, file), content);
  execFileSync(plica, ["report", out]);
}

function runsOf(name) {
  const [first, ...lines] = readFileSync(join(folder, name, "runs.csv"), "utf8").trim().split("\n").map((line) => line.split(","));
  return lines.map((line) => Object.fromEntries(first.map((column, i) => [column, line[i]])));
}

// Where a part of the page is for the mouse. A picture of another part may have scrolled it out of sight.
async function inView(page, selector) {
  const part = page.locator(selector).first();
  await part.scrollIntoViewIfNeeded();
  return part.boundingBox();
}

const shown = (page) => page.textContent("#shown-count").then((text) => Number(text.replace(/\D*of.*/, "").replace(/\D/g, "")));
const points = (page) => page.locator(".rows tr[data-row] th").allTextContents().then((all) => all.map(Number));

test("the heading counts, the table holds what runs.csv holds, and sorts with what is missing last", async () => {
  const { page, done } = await open("grid/report.html");
  assert.equal(await page.title(), "grid");
  const headline = await page.textContent("#headline");
  for (const part of ["Grid over 3 keys of drosophila", "16 runs: 4 refused, 12 end time", "total run time", "time.end_min=0.05"])
    assert.ok(headline.includes(part), `${part} in ${headline}`);
  const rows = runsOf("grid");
  const cell = (row, key) => page.textContent(`.rows tr[data-row="${row}"] [data-key="${key}"]`);
  let compared = 0;
  for (const [row, run] of rows.entries())
    for (const key of [stiffness, young, "furrow_depth_um", "vml_apical_area_ratio", "lips_closed_time_s"]) {
      const text = await cell(row, key);
      if (run[key] === "") assert.equal(text, "–");
      else near(numberOf(text), Number(run[key]), 1e-3, key);
      ++compared;
    }
  assert.equal(compared, 80);
  assert.equal(await cell(1, "contraction.apical.region"), "all");
  for (const sign of [1, -1]) {
    await page.click('.rows th[data-key="furrow_depth_um"] button');
    const depths = (await page.locator('.rows td[data-key="furrow_depth_um"]').allTextContents());
    assert.deepEqual(depths.slice(-4), ["–", "–", "–", "–"]);
    const given = depths.slice(0, -4).map(numberOf);
    assert.deepEqual(given, [...given].sort((a, b) => sign * (a - b)));
  }
  await done();
});

test("text, ticks, reasons, ranges and drags leave runs out everywhere", async () => {
  const { page, done } = await open("grid/report.html");
  const axis = `.handle[data-key="${stiffness}"]`;
  await page.fill("#filter", "young>=1000 furrow");
  assert.equal(await shown(page), 4);
  assert.deepEqual(await points(page), [3, 7, 11, 15]);
  await page.fill("#filter", "");
  await page.click('#statuses [data-status="refused"] input');
  assert.equal(await shown(page), 12);
  await page.click("#show-all");
  assert.equal(await shown(page), 16);
  await page.click(".reason");
  assert.deepEqual(await points(page), [1, 2, 3, 4]);
  await page.click(".reason");
  assert.equal(await shown(page), 16);
  await page.click("#range summary");
  await page.selectOption("#range-of", stiffness);
  await page.fill("#range-from", "4");
  await page.press("#range-from", "Enter");
  await page.waitForFunction(() => document.querySelector("#shown-count").textContent.startsWith("8 "));
  await page.mouse.click(2, 2); // elsewhere
  assert.ok(!(await page.isVisible("#range-from")), "the menu has closed");
  await page.click("#chips .chip");
  await page.waitForFunction(() => document.querySelector("#shown-count").textContent.startsWith("16 "));
  // The upper half of an axis: 5 and 7 of 1 to 7.
  const before = await pixels(page, "#scatter .layers");
  let strip = await inView(page, axis);
  await page.mouse.move(strip.x + strip.width / 2, strip.y + 1);
  await page.mouse.down();
  await page.mouse.move(strip.x + strip.width / 2, strip.y + 0.42 * strip.height, { steps: 5 });
  await page.mouse.up();
  await page.waitForFunction(() => document.querySelector("#shown-count").textContent.startsWith("8 "));
  assert.equal(await page.locator("#scatter .layers").getAttribute("data-points"), "8");
  assert.equal(await page.locator("#phase .layers").first().getAttribute("data-cells"), "4");
  assert.ok(changed(before, await pixels(page, "#scatter .layers")) > 0.0005, "points fade");
  const { name, bytes } = await saved(page, "#save-table");
  assert.equal(name, "grid.csv");
  const kept = readFileSync(join(folder, "grid/runs.csv"), "utf8").split("\n");
  assert.deepEqual(bytes.toString().split("\n").map((line) => line.split(",").slice(5, 8)), [0, 9, 10, 11, 12, 13, 14, 15, 16, 17].map((i) => kept[i].split(",").slice(5, 8)));
  strip = await inView(page, axis);
  await page.mouse.click(strip.x + strip.width / 2, strip.y + strip.height / 2);
  await page.waitForFunction(() => document.querySelector("#shown-count").textContent.startsWith("16 "));
  await done();
});

test("a picked run shows its values and the command that makes it again", async () => {
  const { page, done } = await open("grid/report.html", { width: 1280, height: 900 });
  const rows = runsOf("grid");
  await page.click('.rows tr[data-row="5"] th');
  assert.equal(await page.textContent("#run h2"), "Point 6");
  near(numberOf(await page.textContent('#run dd[data-key="furrow_depth_um"]')), Number(rows[5].furrow_depth_um), 1e-3, "depth");
  assert.equal(await page.textContent('#run dd[data-key="lips_closed_time_s"]'), "none");
  const command = await page.textContent("#command");
  execFileSync("bash", ["-c", `${command.replace(/^plica/, '"$PLICA"').replace(/--out .*/, "--out again --quiet")}`], { cwd: folder, env: { ...process.env, PLICA: plica } });
  const again = JSON.parse(readFileSync(join(folder, "again/summary.json"), "utf8"));
  assert.equal(again.furrow_depth_um, Number(rows[5].furrow_depth_um), "the same to the bit");
  await page.click('.rows tr[data-row="0"] th');
  assert.match(await page.textContent("#run .notice"), /1 does not go with the others/);
  await page.focus(".rows");
  await page.press(".rows", "ArrowDown");
  assert.equal(await page.textContent("#run h2"), "Point 2");
  // A cell of the phase plot, lowest row, second column: stiffness 3, 800 Pa, two regions.
  const box = await inView(page, "#phase .layers");
  const picked = async () => {
    await page.mouse.click(box.x + 0.15 * box.width + 0.85 * box.width * 0.4, box.y + box.height - 80);
    return page.textContent("#run h2");
  };
  assert.deepEqual([await picked(), await picked(), await picked()], ["Point 5", "Point 6", "Point 5"]);
  assert.match(await page.textContent(".told"), /Young's modulus 800, stiffness 3: 2 runs, furrow depth mean/);
  await done();
});

test("verdicts colour the plots where the study has what they need", async () => {
  const { page, done } = await open("closing/report.html");
  assert.equal(await page.inputValue("#colour-by"), "verdict");
  const verdicts = await page.locator('.rows td[data-key="verdict"]').allTextContents();
  assert.deepEqual(verdicts, ["closed", "furrowed", "furrowed", "flattened", "passes through itself", "–"]);
  assert.match(await page.textContent(".told"), /or 15 µm deep; flattened: less/);
  const legend = await page.textContent("#runs-bar .ramp");
  for (const word of ["closed", "furrowed", "flattened", "passes through itself"]) assert.ok(legend.includes(word), `${word} in ${legend}`);
  assert.ok(!(await saved(page, "#save-table")).bytes.toString().includes("verdict"), "it is no column of runs.csv");
  await done();
});

test("a failed run is crossed out, and has no value but in the saved table", async () => {
  const { page, done } = await open("closing/report.html");
  assert.equal(await page.getAttribute("#scatter .layers", "data-crossed"), "1");
  assert.match(await page.textContent("#scatter"), /×: run that failed, without a result/);
  assert.match(await page.textContent(".told"), /×: failed, no result/);
  assert.deepEqual((await page.locator('.rows td[data-key="furrow_depth_um"]').allTextContents()).at(-1), "–");
  await page.fill("#filter", "furrow_depth<0");
  assert.equal(await shown(page), 0, "it does not match a filter by its last value");
  await page.fill("#filter", "");
  assert.match((await saved(page, "#save-table")).bytes.toString(), /failed,-0.1,-0.3,,0,/);
  await done();
});

test("a table has the width of the page until a run is picked", async () => {
  const { page, done } = await open("grid/report.html", { width: 1400, height: 900 });
  assert.ok(!(await page.isVisible("#run")));
  const wide = (await page.locator(".rows").boundingBox()).width;
  assert.ok(wide > 1300, `${wide}`);
  await page.click('.rows tr[data-row="5"] th');
  assert.ok((await page.locator(".rows").boundingBox()).width < wide - 300);
  await page.click("#run .close");
  assert.equal((await page.locator(".rows").boundingBox()).width, wide);
  await done();
});

test("what a study kept of a run is linked to", async () => {
  const { page, done } = await open("kept/report.html");
  await page.click('.rows tr[data-row="1"] th');
  const href = await page.getAttribute("#kept", "href");
  assert.equal(href, "points/000002/report.html");
  assert.ok(existsSync(join(folder, "kept", href)));
  const log = await page.evaluate(() => [...document.querySelectorAll("#scatter label")].filter((label) => label.offsetParent && /log/.test(label.textContent)).length);
  assert.ok(log <= 1, "stiffness varies by its logarithm, so its axis is one already");
  await done();
  execFileSync(plica, ["report", join(folder, "kept"), "--out", join(folder, "elsewhere.html")]);
  const other = await open("elsewhere.html");
  await other.page.click('.rows tr[data-row="1"] th');
  assert.equal(await other.page.getAttribute("#kept", "href"), "kept/points/000002/report.html");
  await other.done();
});

test("colours, axes and themes can be chosen", async () => {
  const { page, done } = await open("grid/report.html");
  const before = await pixels(page, "#phase .layers");
  await page.selectOption("#colour-by", "status");
  assert.ok(changed(before, await pixels(page, "#phase .layers")) > 0.3, "cells have the colours of statuses");
  await page.selectOption("#scatter-x", "vml_apical_area_ratio");
  await page.click("#axes summary");
  const axes = () => page.locator(".handle").count();
  const many = await axes();
  await page.click(`#axes input[value="${young}"]`);
  assert.equal(await axes(), many - 1);
  await page.click("#all-columns");
  assert.ok((await page.locator(".rows thead th").count()) >= 11);
  await page.click("#theme");
  await page.waitForTimeout(200);
  await done();
});

test("10 000 runs are a small file, soon seen, and as quickly filtered", async () => {
  const bytes = statSync(join(folder, "large/report.html")).size;
  assert.ok(bytes < 8e6, `${bytes} bytes`);
  const { page, done } = await open("large/report.html", { width: 1440 });
  const ms = await page.evaluate(() => performance.getEntriesByName("first-picture")[0].startTime);
  assert.ok((await page.locator(".rows tr[data-row]").count()) < 100, "only the rows that are seen are there");
  await page.locator(".rows").evaluate((box) => (box.scrollTop = box.scrollHeight));
  await page.waitForSelector('.rows tr[data-row="9999"]');
  assert.equal((await points(page)).at(-1), 10_000);
  const filtering = await page.evaluate(() => {
    const [start, filter] = [performance.now(), document.querySelector("#filter")];
    filter.value = "stiffness>=50 depth>=20";
    filter.dispatchEvent(new Event("input"));
    return performance.now() - start;
  });
  const expected = runsOf("large").filter((run) => Number(run[stiffness]) >= 50 && run.furrow_depth_um !== "" && Number(run.furrow_depth_um) >= 20);
  assert.equal(await shown(page), expected.length);
  assert.equal(await page.locator("#failures tbody tr").count(), 1, "reasons that differ in a time only are one");
  console.log(`${(bytes / 1e6).toFixed(2)} MB; first picture after ${ms.toFixed(0)} ms; filtered in ${filtering.toFixed(0)} ms`);
  await done();
});

test("on a phone nothing is wider than the screen, and a picked run comes up from below", async () => {
  for (const file of ["grid/report.html", "large/report.html"]) {
    const { page, done } = await open(file, { width: 390, height: 844 });
    const [wide, room] = await page.evaluate(() => [document.scrollingElement.scrollWidth, innerWidth]);
    assert.ok(wide <= room, `${wide} pixels wide on ${room}`);
    assert.ok(!(await page.isVisible("#run")));
    await page.locator(".rows tr[data-row]").first().click();
    const box = await page.locator("#run").boundingBox();
    assert.ok(box.y > 300 && box.y + box.height <= 845, "below");
    await page.click("#run .close");
    assert.ok(!(await page.isVisible("#run")));
    await done();
  }
});
