// The report of one run and of two, in a real browser driven by Playwright. PLICA names the program. Any console error, any
// request, fails the test.
import assert from "node:assert/strict";
import { readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import {
  begin, changed, chosenFrame, difference, end, folder, isPaper, launch, near, numberOf, open, pixels, report, run, saved, shownSeries,
  table, tick,
} from "./browser.mjs";

const hostileTitle = `</script><script>window.hacked=1</script>"'<img src=x onerror="window.hacked=1">\u{1F9EC}${"fold ".repeat(2000)}`;

let drosophila; // an open page that tests share; each leaves it at the last frame

before(async () => {
  run("drosophila", "drosophila");
  run("division-demo", "division", "--set", "output.frame_every_s=30");
  writeFileSync(join(folder, "hostile.toml"),
    `base = "division-demo"\ntitle = ${JSON.stringify(hostileTitle).replaceAll("\u{1F9EC}", "\\U0001F9EC")}\n[time]\nend_min = 0.2\n`);
  run(join(folder, "hostile.toml"), "hostile");
  // A strip that curls up until its ends pass through it.
  writeFileSync(join(folder, "curl.toml"), `[embryo]\nshape = "block"\nlength_um = 600\nwidth_um = 20\ncell_height_um = 10\ncells = [60, 2, 1]
[dynamics]\nsurface_drag_Pa_s_per_um = 20\n[contraction.apical]\nregion = "all"\ntension_mN_per_m = 2\nacross_ratio = 0\n[time]\nend_min = 10
[monitor.whole]\nquantity = "volume"\nover = "sum"\n`);
  run(join(folder, "curl.toml"), "curl");
  // A dome that nothing contracts, and a low sheet whose contraction sets in at full force.
  const sheet = (name, height, rest) =>
    writeFileSync(join(folder, `${name}.toml`), `[embryo]\nshape = "sheet"\nlength_um = 120\nwidth_um = 100\ncell_height_um = ${height}
cell_count = 120\n${rest}\n[time]\nend_min = 5\n[output]\nframe_every_s = 60\n`);
  sheet("dome", 12, 'rim = "held"\n[pressure.lumen]\nregion = "all"\nface = "basal"\npressure_Pa = 40');
  sheet("fails", 10, '[elasticity]\ncorner_barrier_Pa = 0\n[region.stripe]\ny_um = [-20, 20]\n[contraction.apical]\nregion = "stripe"\nstiffness_nN_per_um = 20');
  run(join(folder, "dome.toml"), "dome");
  assert.throws(() => run(join(folder, "fails.toml"), "fails"), ({ status }) => status === 3);
  report(["drosophila", "division"], "both.html");
  await begin();
  drosophila = await open("drosophila/report.html");
});

after(async () => {
  await drosophila?.done();
  await end();
});

test("values beside the plots are those of series.csv, at the end and in between", async () => {
  const { page } = drosophila;
  const series = table("drosophila/series.csv");
  let compared = 0;
  for (const [frame, time] of [[null, 900], [4, 60], [20, 300]]) {
    if (frame !== null) await chosenFrame(page, frame);
    const row = series.reduce((best, candidate) => (Math.abs(candidate.time_s - time) < Math.abs(best.time_s - time) ? candidate : best));
    near(row.time_s, time, 1e-9, "a step at the frame's time");
    for (const [column, text] of Object.entries(await shownSeries(page))) {
      near(numberOf(text), row[column], 1e-3, `${column} at ${time} s`);
      ++compared;
    }
  }
  assert.ok(compared >= 30, `${compared} values compared`);
  const summary = JSON.parse(readFileSync(join(folder, "drosophila/summary.json"), "utf8"));
  for (const key of ["furrow_depth_um", "max_volume_error", "peak_speed_ratio"])
    near(numberOf(await page.locator(`#numbers tr:has(th[title="${key}"]) td`).textContent()), summary[key], 1e-4, key);
  await page.keyboard.press("End");
});

test("the picture is the embryo: its outline, its symmetry, its colours", async () => {
  const { page, done } = await open("drosophila/report.html");
  await page.click("#view-ventral");
  for (const part of ["marks", "shell", "edges"]) await tick(page, `#${part}`, false);
  const picture = await pixels(page, ".picture");
  const { width, height } = picture;
  let [left, right, top, bottom] = [width, 0, height, 0];
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      if (isPaper(picture.rgb(x, y)) || y < 60 || y > height - 40) continue; // time and scale bar are written there
      [left, right] = [Math.min(left, x), Math.max(right, x)];
      [top, bottom] = [Math.min(top, y), Math.max(bottom, y)];
    }
  // A pill of 460 by 280 um; its shortened sides are a little narrower by then.
  near((right - left) / (bottom - top), 460 / 280, 0.02, "length to width");
  // From below the two sides of the embryo mirror each other.
  const middle = (top + bottom) / 2;
  let [same, all, dark] = [0, 0, 0];
  for (let x = left + 5; x < right - 5; x += 3)
    for (let y = 4; y < (bottom - top) / 2 - 4; y += 3) {
      const [a, b] = [picture.rgb(x, middle - y), picture.rgb(x, middle + y)];
      same += difference(a, b) < 70; // light comes from one side
      dark += a[0] + a[1] + a[2] < 300;
      ++all;
    }
  assert.ok(same / all > 0.97, `${same} of ${all} mirrored`);
  assert.ok(dark / all > 0.05 && dark / all < 0.6, `${dark} of ${all} dark: the furrow`);
  await done();
});

test("on a cut, colours are those of the scale for the cell's value", async () => {
  const { page, done } = await open("drosophila/report.html", { width: 1280, height: 900 });
  await page.click("#view-cross-section");
  await page.selectOption("#field", "pressure");
  await tick(page, "#edges", false);
  const box = await page.locator(".picture").boundingBox();
  let checked = 0;
  for (const [across, down] of [[0, -0.3], [0.18, -0.25], [-0.2, -0.22], [0, 0.24]]) {
    const [x, y] = [box.width / 2 + across * box.height, box.height / 2 + 1.03 * down * box.height];
    await page.keyboard.press("Escape");
    const before = await pixels(page, ".picture");
    await page.mouse.click(box.x + x, box.y + y);
    const shown = page.locator('[data-value="pressure"]');
    if ((await shown.count()) === 0) continue;
    const value = numberOf(await shown.textContent());
    const expected = await page.evaluate((value) => {
      const data = JSON.parse(document.getElementById("data").textContent);
      const field = data.fields.find((candidate) => candidate.name === "pressure");
      const map = data.maps[field.map];
      const place = ((value - field.low) / (field.high - field.low)) * (map.length - 1);
      const low = Math.min(Math.floor(place), map.length - 2);
      const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
      return rgb(map[low]).map((part, i) => part + (place - low) * (rgb(map[low + 1])[i] - part));
    }, value);
    assert.ok(difference(before.rgb(x, y), expected) < 12, `${before.rgb(x, y)} for ${expected} at ${value} Pa`);
    ++checked;
  }
  assert.ok(checked >= 2, `${checked} cells met`);
  await done();
});

test("three cuts across follow time and colour; energies stand by law", async () => {
  const { page } = drosophila;
  await page.locator("#sections").scrollIntoViewIfNeeded();
  await page.waitForSelector("#sections[data-drawn]");
  const captions = await page.locator("#sections span").allTextContents();
  assert.deepEqual(captions, ["x = −115 µm", "x = 0 µm", "x = 115 µm"]);
  const canvas = "#sections div:nth-of-type(2) canvas";
  const last = await pixels(page, canvas);
  let inked = 0;
  for (let x = 0; x < last.width; x += 3) for (let y = 0; y < last.height; y += 3) inked += !isPaper(last.rgb(x, y));
  assert.ok(inked / (last.width * last.height / 9) > 0.2, "a ring of cells");
  await chosenFrame(page, 0);
  await page.waitForSelector('#sections[data-drawn="0"]');
  assert.ok(changed(last, await pixels(page, canvas)) > 0.05, "the furrow has gone");
  const { active, dissipated } = JSON.parse(readFileSync(join(folder, "drosophila/summary.json"), "utf8"))
    .energy_by_law_nN_um["contraction.apical"];
  const cells = page.locator('#numbers tr:has(th:text-is("contraction.apical")) td');
  near(numberOf(await cells.nth(0).textContent()), active, 1e-3, "active");
  if (dissipated > 0) near(numberOf(await cells.nth(2).textContent()), dissipated, 1e-3, "dissipated");
  await page.keyboard.press("End");
});

test("turning by mouse and keys, zoom, cut, colour and time each change the picture", async () => {
  const { page, done } = await open("drosophila/report.html", { width: 640, height: 480 });
  let last = await pixels(page, ".picture");
  const box = await page.locator(".picture").boundingBox();
  const actions = {
    drag: async () => {
      await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
      await page.mouse.down();
      await page.mouse.move(box.x + box.width / 2 + 120, box.y + box.height / 2 + 40, { steps: 5 });
      await page.mouse.up();
    },
    wheel: () => page.mouse.wheel(0, -300),
    arrow: () => page.locator(".picture").press("ArrowLeft"),
    plus: () => page.locator(".picture").press("+"),
    view: () => page.keyboard.press("3"),
    colour: () => page.selectOption("#field", "area-ratio"),
    cut: () => page.selectOption("#cut", "y"),
    "move the cut": () => page.locator("#cut-at").evaluate((slider) => {
      slider.value = "60";
      slider.dispatchEvent(new Event("input"));
    }),
    "whole again": () => page.selectOption("#cut", ""),
    edges: () => tick(page, "#edges", false),
    scrub: () => chosenFrame(page, 0),
  };
  for (const [name, act] of Object.entries(actions)) {
    await act();
    await page.waitForTimeout(60);
    const picture = await pixels(page, ".picture");
    assert.ok(changed(last, picture) > 0.004, `${name}: ${changed(last, picture)} of the picture changed`);
    last = picture;
  }
  assert.equal(await page.locator("#time-text").textContent(), "0 s");
  await done();
});

test("keys and the button play, stop at a saved frame, and step", async () => {
  const { page, done } = await open("drosophila/report.html");
  await page.keyboard.press("Home");
  assert.equal(await page.locator("#time-text").textContent(), "0 s");
  await page.keyboard.press(".");
  assert.equal(await page.locator("#time-text").textContent(), "15 s");
  await page.keyboard.press("End");
  assert.equal(await page.locator("#time-text").textContent(), "15 min");
  await page.keyboard.press("Space"); // from the end it begins anew
  const frames = await page.evaluate(async () => {
    let count = 0;
    const begin = performance.now();
    while (performance.now() - begin < 1500) {
      await new Promise(requestAnimationFrame);
      ++count;
    }
    return count / 1.5;
  });
  console.log(`756 cells play at ${frames.toFixed(0)} pictures a second, drawn without a graphics card`);
  await page.click("#play");
  assert.equal(await page.locator("#play").textContent(), "Play");
  const shown = await page.locator("#time").evaluate((slider) => Number(slider.value));
  assert.ok(shown > 1 && shown < 61, `frame ${shown}`);
  const text = await page.locator("#time-text").textContent();
  const seconds = numberOf(text.split(" ")[0]) * (text.endsWith("min") ? 60 : 1);
  near(seconds / 15, Math.round(seconds / 15), 1e-6, "a saved frame's time");
  await done();
});

test("a picked cell shows what cells.csv has of it", async () => {
  const { page } = drosophila;
  await page.click("#view-ventral");
  const box = await page.locator(".picture").boundingBox();
  await page.mouse.click(box.x + box.width / 2 + 3, box.y + box.height / 2 + 3);
  const id = numberOf(await page.locator('[data-value="cell_id"]').textContent());
  let compared = 0;
  for (const [frame, time] of [[60, 900], [4, 60]]) {
    await chosenFrame(page, frame);
    const row = table("drosophila/cells.csv").find((candidate) => candidate.cell_id === id && candidate.time_s === time);
    assert.ok(Math.abs(row.x_um) < 40 && Math.abs(row.y_um) < 40 && row.z_um < 0, "a cell in the middle of the belly");
    for (const [field, column] of [["area-ratio", "apical_area_ratio"], ["pressure", "pressure_Pa"], ["volume", "volume_um3"], ["contraction", "activity"]]) {
      near(numberOf(await page.locator(`[data-value="${field}"]`).textContent()), row[column], 2e-3, `${field} at ${time} s`);
      ++compared;
    }
  }
  assert.equal(compared, 8);
  assert.equal(await page.locator("#cell .uplot").count(), 1, "its history is plotted");
  await page.fill("#cell-id", "12");
  await page.press("#cell-id", "Enter");
  assert.equal(await page.locator('[data-value="cell_id"]').textContent(), "12");
  await page.keyboard.press("End");
});

test("division shows when it happens, and a daughter's history goes on from her mother's", async () => {
  const { page, done } = await open("division/report.html");
  const cells = table("division/cells.csv");
  const count = (time) => cells.filter((row) => row.time_s === time).length;
  const seen = async () => Number(await page.locator(".picture").getAttribute("data-cells"));
  const settled = () => pixels(page, ".picture");
  await page.keyboard.press("Home");
  await settled();
  assert.equal(await seen(), count(0));
  await page.fill("#cell-id", "1");
  await page.press("#cell-id", "Enter");
  assert.match(await page.locator("#cell").textContent(), /daughter 3.*daughter 4/);
  await page.click("text=daughter 4");
  await page.keyboard.press("End");
  await settled();
  assert.equal(await seen(), 4);
  assert.equal(await page.locator('[data-value="cell_id"]').textContent(), "4");
  await page.keyboard.press("Home");
  assert.equal(await page.locator('[data-value="cell_id"]').textContent(), "1");
  await done();
});

test("two runs: cameras and time together, curves over each other", async () => {
  const { page, done } = await open("both.html");
  assert.equal(await page.locator(".picture").count(), 2);
  const before = await pixels(page, ".view:nth-child(2) .picture");
  const box = await page.locator(".picture").first().boundingBox();
  await page.mouse.move(box.x + 200, box.y + 200);
  await page.mouse.down();
  await page.mouse.move(box.x + 260, box.y + 230, { steps: 4 });
  await page.mouse.up();
  await page.waitForTimeout(60);
  const turned = await pixels(page, ".view:nth-child(2) .picture");
  assert.ok(changed(before, turned) > 0.002, "the other camera follows");
  const runs = await page.locator('#plots output[data-column="furrow_depth_um"]').evaluateAll((all) => all.map((o) => o.dataset.run));
  assert.ok(runs.includes("drosophila"));
  assert.equal(await page.locator("#numbers thead th").filter({ hasText: "division" }).count() > 0, true);
  await done();
});

test("the words of a sheet without contraction are not those of a furrow, and its plots are not empty", async () => {
  const { page, done } = await open("dome/report.html");
  const text = await page.evaluate(() => document.body.innerText.split("Scenario\n")[0]);
  assert.doesNotMatch(text, /VML|VCE|furrow|\blips?\b|anterior|ventral|midline/i);
  assert.match(await page.textContent("#headline"), /120 cells, equilibrium at 5 min, largest displacement \d+\.\d+ µm, smallest/);
  assert.deepEqual(await page.locator("[id^=view-]").allTextContents(), ["apical", "oblique", "from −z", "from −y", "cut at x", "cut at y"]);
  const titles = await page.locator("#plots figcaption").allTextContents();
  for (const title of ["Largest displacement, µm", "Mean cell height, µm", "Smallest apical area / reference area", "Energy, nN·µm"])
    assert.ok(titles.includes(title), `${title} in ${titles}`);
  assert.ok(!titles.some((title) => /Number of cells|Volume/.test(title)), "what does not change has no plot");
  near(numberOf((await shownSeries(page)).max_displacement_um), table("dome/series.csv").at(-1).max_displacement_um, 1e-3, "displacement");
  await done();
});

const magenta = (picture) => {
  let [count, x, y] = [0, 0, 0];
  for (let j = 0; j < picture.height; ++j)
    for (let i = 0; i < picture.width; ++i) {
      const [r, g, b] = picture.rgb(i, j);
      if (r > 180 && g < 90 && b > 90 && b < 180) [count, x, y] = [count + 1, x + i, y + j];
    }
  return { count, x: x / count / picture.width, y: y / count / picture.height };
};

test("a failed run begins with what, where and when, and with its cell close up", async () => {
  const { failure, failed_cell: cell } = JSON.parse(readFileSync(join(folder, "fails/summary.json"), "utf8"));
  assert.ok(failure.includes(`cell ${cell} `), failure);
  const { page, done } = await open("fails/report.html");
  assert.match(await page.textContent("#failure"), /^Failed at 0\.\d+ s: cell \d+ is inverted/);
  assert.ok((await page.locator("#failure").boundingBox()).y < 120, "at the head");
  assert.equal(await page.textContent('[data-value="cell_id"]'), String(cell));
  const close = await pixels(page, ".picture");
  const mark = magenta(close);
  assert.ok(mark.count > 100 && Math.abs(mark.x - 0.5) < 0.08 && Math.abs(mark.y - 0.5) < 0.12, `in the middle: ${JSON.stringify(mark)}`);
  await page.click("[data-whole]");
  const whole = await pixels(page, ".picture");
  assert.ok(magenta(whole).count < 0.75 * mark.count, "smaller in the whole tissue");
  await page.click("[data-cell]");
  assert.ok(changed(close, await pixels(page, ".picture")) < 0.01, "and back again");
  await done();
});

test("the vitelline membrane is seen where it is ticked", async () => {
  const { page, done } = await open("drosophila/report.html", { width: 640, height: 480 });
  for (const view of ["antero-ventral", "cross-section"]) {
    await page.click(`#view-${view}`);
    await tick(page, "#shell", true);
    const before = await pixels(page, ".picture");
    await tick(page, "#shell", false);
    const part = changed(before, await pixels(page, ".picture"));
    assert.ok(part > 0.01, `${view}: ${part} of the picture`);
  }
  await done();
});

test("a hostile title is text", async () => {
  const { page, done } = await open("hostile/report.html");
  assert.equal(await page.locator("#title").textContent(), hostileTitle);
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.equal((await page.title()).slice(0, 40), hostileTitle.slice(0, 40));
  assert.ok((await page.locator("#title").boundingBox()).height < 150);
  await done();
});

test("without WebGL the page says so and shows plots and tables", async () => {
  const blind = await launch({ webgl: false });
  const context = await blind.newContext();
  const page = await context.newPage();
  await page.goto(pathToFileURL(join(folder, "drosophila/report.html")).href);
  await page.waitForSelector("body[data-ready]");
  assert.match(await page.locator("#problem").textContent(), /no WebGL/);
  assert.ok((await page.locator("#plots .uplot").count()) >= 5);
  near(numberOf((await shownSeries(page)).furrow_depth_um), table("drosophila/series.csv").at(-1).furrow_depth_um, 1e-3, "depth");
  await blind.close();
});

test("phone width and dark mode", async () => {
  for (const file of ["drosophila/report.html", "both.html", "hostile/report.html"]) {
    const { page, done } = await open(file, { width: 390, height: 844, dark: true });
    const [wide, room] = await page.evaluate(() => [document.scrollingElement.scrollWidth, innerWidth]);
    assert.ok(wide <= room, `${file}: ${wide} pixels wide on ${room}`);
    const { y } = await page.locator(".picture").first().boundingBox();
    assert.ok(file === "both.html" || y < 844 / 4, `${file}: the picture begins at ${y} of 844 pixels`);
    const paper = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.ok(paper.match(/\d+/g).every((part) => Number(part) < 60), paper);
    await page.click("#theme");
    assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), "rgb(255, 255, 255)");
    await done();
  }
});

test("numbers stay in one line on a phone, and have the units of their columns", async () => {
  const { page, done } = await open("drosophila/report.html", { width: 390, height: 844 });
  const numbers = await page.locator("#numbers td").evaluateAll((cells) => cells
    .filter(({ textContent }) => /^−?\d/.test(textContent))
    .map((cell) => {
      const range = document.createRange();
      range.selectNodeContents(cell);
      return { text: cell.textContent, lines: range.getClientRects().length };
    }));
  assert.ok(numbers.length >= 30, `${numbers.length} numbers`);
  assert.deepEqual(numbers.filter(({ lines }) => lines !== 1), []);
  assert.equal(await page.locator('#numbers th[title="active_work_nN_um"]').textContent(), "active work, nN·µm");
  await done();
});

test("the picture and the table are saved", async () => {
  const { page } = drosophila;
  const { name, bytes: png } = await saved(page, "#save-picture");
  assert.equal(name, "drosophila.png");
  assert.equal(png.subarray(1, 4).toString(), "PNG");
  assert.ok(png.length > 50_000, `${png.length} bytes`);
  const { width } = await page.locator(".view").boundingBox();
  assert.equal(png.readUInt32BE(16), 2 * Math.round(width), "twice as fine as the screen");
  const { bytes: csv } = await saved(page, "#save-table");
  const [head, ...rows] = csv.toString().trim().split("\n");
  const series = table("drosophila/series.csv");
  assert.equal(rows.length, series.length);
  const [place, last] = [head.split(",").indexOf("furrow_depth_um"), rows.at(-1).split(",")];
  assert.equal(Number(last[place]), series.at(-1).furrow_depth_um);
});

test("the page is small, and its first picture quick", async () => {
  const bytes = statSync(join(folder, "drosophila/report.html")).size;
  assert.ok(bytes < 5e6, `${bytes} bytes`);
  const { page } = drosophila;
  const ms = await page.evaluate(() => performance.getEntriesByName("first-picture")[0].startTime);
  console.log(`${(bytes / 1e6).toFixed(2)} MB; first picture after ${ms.toFixed(0)} ms`);
});

test("a tissue that passes through itself is announced, and none other", async () => {
  const crossing = await open("curl/report.html");
  assert.match(await crossing.page.textContent("#crossing"), /^From [\d.]+ min on, the tissue self-intersects/);
  assert.ok(await crossing.page.isVisible("#crossing"));
  assert.match(await crossing.page.textContent("#headline"), /self-intersecting/);
  const { warnings } = JSON.parse(readFileSync(join(folder, "curl/summary.json"), "utf8"));
  assert.ok("bending" in warnings);
  assert.deepEqual(await crossing.page.locator("#warnings p").allTextContents(), Object.values(warnings).map((text) => `Warning: ${text}.`));
  await crossing.done();
  assert.ok(!(await drosophila.page.isVisible("#crossing")));
});

// The canvas of a plot: its size, where it plots (in its own pixels), and the colour at a place.
const plotOf = (page, selector) => page.locator(selector).first().evaluate((root) => {
  const canvas = root.querySelector("canvas");
  const over = root.querySelector(".u-over");
  const ratio = canvas.width / canvas.clientWidth;
  const [x, y] = [over.offsetLeft * ratio, over.offsetTop * ratio];
  const { width, height } = canvas;
  const data = canvas.getContext("2d").getImageData(0, 0, width, height).data;
  const column = (at) => Array.from({ length: height }, (_, row) => [...data.slice(4 * (row * width + at), 4 * (row * width + at) + 4)]);
  return {
    left: x, top: y, wide: over.clientWidth * ratio, high: over.clientHeight * ratio, edge: column(0).concat(column(width - 1)),
    columns: Object.fromEntries([0.005, 0.25, 0.5, 0.75, 0.995].map((part) => [part, column(Math.floor(x + part * over.clientWidth * ratio))])),
  };
});

test("no label of an axis is cut", async () => {
  let plots = 0;
  for (const file of ["drosophila/report.html", "curl/report.html"]) {
    const { page, done } = await open(file, { width: 390, height: 844 });
    for (const logarithmic of [false, true]) {
      await tick(page, "#logarithmic-time", logarithmic);
      for (let i = 1; i <= (await page.locator(".chart .uplot").count()); ++i) {
        const { edge } = await plotOf(page, `:nth-match(.chart .uplot, ${i})`);
        assert.ok(edge.every(([, , , alpha]) => alpha === 0), `${file}: plot ${i} is inked up to its edge`);
        ++plots;
      }
    }
    await done();
  }
  assert.ok(plots >= 12, `${plots} plots`);
});

test("the midline's last frame shows, on a logarithmic axis too, which ends with it", async () => {
  const { page, done } = await open("drosophila/report.html");
  await page.locator("#midline").scrollIntoViewIfNeeded();
  await page.waitForSelector("#midline .uplot");
  const map = await page.evaluate(() => JSON.parse(document.getElementById("data").textContent).maps.still);
  const rows = table("drosophila/midline.csv");
  const depths = rows.map((row) => row.depth_um).filter((depth) => depth !== null);
  const [least, greatest] = [Math.min(0, ...depths), Math.max(...depths)];
  const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
  const expected = (depth) => {
    const place = ((depth - least) / (greatest - least)) * (map.length - 1);
    const below = Math.min(Math.floor(place), map.length - 2);
    return rgb(map[below]).map((part, i) => part + (place - below) * (rgb(map[below + 1])[i] - part));
  };
  const reach = 1.05 * Math.max(...rows.map((row) => Math.abs(row.ap_um)));
  let compared = 0;
  for (const logarithmic of [false, true]) {
    await tick(page, "#logarithmic-time", logarithmic);
    const plot = await plotOf(page, "#midline .uplot");
    for (const [part, time] of [[0.995, 900], ...(logarithmic ? [[0.005, 15]] : [[0.005, 0], [0.5, 450]])])
      for (const row of rows.filter((candidate) => candidate.time_s === time && Math.abs(candidate.ap_um) < 0.9 * reach)) {
        const y = Math.round(plot.top + (plot.high * (reach - row.ap_um)) / (2 * reach));
        const seen = plot.columns[part][y].slice(0, 3);
        assert.ok(difference(seen, expected(row.depth_um)) < 10, `${seen} for ${expected(row.depth_um)} at ${time} s, ${row.ap_um} µm`);
        ++compared;
      }
  }
  assert.ok(compared > 40, `${compared} compared`);
  await done();
});

test("the legend names regions, and a picked cell says in which it is", async () => {
  const { page, done } = await open("drosophila/report.html");
  await page.click("#view-ventral");
  await page.selectOption("#field", "region");
  const legend = await pixels(page, "#legend");
  const has = (wanted) => {
    for (let y = 18; y < 40; ++y)
      for (let x = 0; x < legend.width; ++x) if (difference(legend.rgb(x, y), wanted) < 8) return true;
    return false;
  };
  assert.ok(has([230, 158, 0]), "the furrow's colour is in the legend");
  assert.ok(!has([87, 181, 232]), "no colour without a region is");
  const box = await page.locator(".picture").boundingBox();
  await page.mouse.click(box.x + box.width / 2 + 3, box.y + box.height / 2 + 3);
  assert.equal(await page.locator('[data-value="region"]').textContent(), "furrow");
  await done();
});
