// The report in a real browser: Debian's Chromium, without a screen or a network, driven by Playwright.
// PLICA names the program; its runs go to a temporary folder. Any console error, any request, fails the test.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const plica = process.env.PLICA ?? "plica";
const chromiumPath = process.env.CHROMIUM ?? "/usr/bin/chromium";
const quiet = ["--no-sandbox", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const software = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

const hostileTitle = `</script><script>window.hacked=1</script>"'<img src=x onerror="window.hacked=1">\u{1F9EC}${"fold ".repeat(2000)}`;
let folder;
let browser;

function run(scenario, name, ...options) {
  execFileSync(plica, ["run", scenario, "--out", join(folder, name), "--quiet", ...options]);
}

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "plica-report-"));
  run("drosophila", "drosophila");
  run("division-demo", "division", "--set", "output.frame_every_s=30");
  writeFileSync(join(folder, "hostile.toml"),
    `base = "division-demo"\ntitle = ${JSON.stringify(hostileTitle).replaceAll("\u{1F9EC}", "\\U0001F9EC")}\n[time]\nend_min = 0.2\n`);
  run(join(folder, "hostile.toml"), "hostile");
  // A strip that curls up until its ends pass through it.
  writeFileSync(join(folder, "curl.toml"), `[embryo]\nshape = "block"\nlength_um = 600\nwidth_um = 20\ncell_height_um = 10\ncells = [60, 2, 1]
[dynamics]\nsurface_drag_Pa_s_per_um = 20\n[contraction.apical]\nregion = "all"\ntension_mN_per_m = 2\nacross_ratio = 0\n[time]\nend_min = 10\n`);
  run(join(folder, "curl.toml"), "curl");
  execFileSync(plica, ["report", join(folder, "drosophila"), join(folder, "division"), "--out", join(folder, "both.html")]);
  browser = await chromium.launch({ executablePath: chromiumPath, args: [...quiet, ...software] });
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

// Opens a page and watches it; `done` fails where it said or asked for something that it should not.
async function open(file, { width = 1280, height = 900, with: opened = browser, dark = false } = {}) {
  const context = await opened.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light" });
  const page = await context.newPage();
  const wrong = [];
  const url = pathToFileURL(join(folder, file)).href;
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && wrong.push(message.text()));
  page.on("pageerror", (error) => wrong.push(String(error)));
  page.on("request", (request) => request.url() !== url && !/^(data|blob):/.test(request.url()) && wrong.push(request.url()));
  await page.goto(url);
  await page.waitForSelector("body[data-ready]");
  const done = async () => {
    await context.close();
    // Chromium's own remark on drawing without a graphics card is no fault of the page.
    assert.deepEqual(wrong.filter((text) => !/GPU stall|swiftshader|GroupMarkerNotSet/i.test(text)), []);
  };
  return { page, done };
}

// The pixels of a part of the page: rgb(x, y) in CSS pixels.
async function pixels(page, selector) {
  await page.waitForTimeout(300); // a picture that stands still is drawn once more, finely
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  const png = (await page.locator(selector).first().screenshot()).toString("base64");
  const { width, height, data } = await page.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    let text = "";
    for (let i = 0; i < data.length; i += 8192) text += String.fromCharCode(...data.subarray(i, i + 8192));
    return { width: image.width, height: image.height, data: btoa(text) };
  }, png);
  const bytes = Buffer.from(data, "base64");
  return { width, height, rgb: (x, y) => [0, 1, 2].map((i) => bytes[4 * (Math.round(y) * width + Math.round(x)) + i]) };
}

const isPaper = ([r, g, b]) => r > 250 && g > 250 && b > 250;
const difference = (a, b) => Math.max(...a.map((value, i) => Math.abs(value - b[i])));

// The part of the pixels that two pictures of one size do not share.
function changed(a, b) {
  assert.deepEqual([a.width, a.height], [b.width, b.height]);
  let count = 0;
  for (let y = 0; y < a.height; y += 2) for (let x = 0; x < a.width; x += 2) count += difference(a.rgb(x, y), b.rgb(x, y)) > 12;
  return count / ((a.width * a.height) / 4);
}

function table(file) {
  const [head, ...lines] = readFileSync(join(folder, file), "utf8").trim().split("\n");
  const columns = head.split(",");
  return lines.map((line) => Object.fromEntries(line.split(",").map((field, i) => [columns[i], field === "" ? null : Number(field)])));
}

// What the page writes as text, as a number: "1.2·10⁻¹¹" and "−3" too.
function numberOf(text) {
  const plain = text.replaceAll("−", "-").replace(/[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]/g, (c) => "-0123456789"["⁻⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(c)]);
  return Number(plain.replace("·10", "e"));
}

function near(actual, expected, relative, what) {
  assert.ok(Math.abs(actual - expected) <= relative * Math.abs(expected) + 1e-12, `${what}: ${actual} for ${expected}`);
}

const chosenFrame = (page, index) =>
  page.locator("#time").evaluate((slider, value) => {
    slider.value = String(value);
    slider.dispatchEvent(new Event("input"));
  }, index);

async function shownSeries(page) {
  return Object.fromEntries(await page.locator("#plots output").evaluateAll((all) =>
    all.map((output) => [output.dataset.column, output.textContent])));
}

test("values beside the plots are those of series.csv, at the end and in between", async () => {
  const { page, done } = await open("drosophila/report.html");
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
  await done();
});

test("the picture is the embryo: its outline, its symmetry, its colours", async () => {
  const { page, done } = await open("drosophila/report.html");
  await page.click("#view-ventral");
  for (const part of ["marks", "shell", "edges"]) await page.uncheck(`#${part}`);
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
  const { page, done } = await open("drosophila/report.html");
  await page.click("#view-cross-section");
  await page.selectOption("#field", "pressure");
  await page.uncheck("#edges");
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

test("turning by mouse and keys, zoom, cut, colour and time each change the picture", async () => {
  const { page, done } = await open("drosophila/report.html");
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
    edges: () => page.uncheck("#edges"),
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
  const { page, done } = await open("drosophila/report.html");
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
  await done();
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

test("a hostile title is text", async () => {
  const { page, done } = await open("hostile/report.html");
  assert.equal(await page.locator("#title").textContent(), hostileTitle);
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.equal((await page.title()).slice(0, 40), hostileTitle.slice(0, 40));
  assert.ok((await page.locator("#title").boundingBox()).height < 150);
  await done();
});

test("without WebGL the page says so and shows plots and tables", async () => {
  const blind = await chromium.launch({ executablePath: chromiumPath, args: [...quiet, "--disable-3d-apis"] });
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
    const paper = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.ok(paper.match(/\d+/g).every((part) => Number(part) < 60), paper);
    await page.click("#theme");
    assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), "rgb(255, 255, 255)");
    await done();
  }
});

test("the picture and the table are saved", async () => {
  const { page, done } = await open("drosophila/report.html");
  const [picture] = await Promise.all([page.waitForEvent("download"), page.click("#save-picture")]);
  assert.equal(picture.suggestedFilename(), "drosophila.png");
  const png = readFileSync(await picture.path());
  assert.equal(png.subarray(1, 4).toString(), "PNG");
  assert.ok(png.length > 50_000, `${png.length} bytes`);
  const { width } = await page.locator(".view").boundingBox();
  assert.equal(png.readUInt32BE(16), 2 * Math.round(width), "twice as fine as the screen");
  const [csv] = await Promise.all([page.waitForEvent("download"), page.click("#save-table")]);
  const [head, ...rows] = readFileSync(await csv.path(), "utf8").trim().split("\n");
  const series = table("drosophila/series.csv");
  assert.equal(rows.length, series.length);
  const [place, last] = [head.split(",").indexOf("furrow_depth_um"), rows.at(-1).split(",")];
  assert.equal(Number(last[place]), series.at(-1).furrow_depth_um);
  await done();
});

test("the page is small, and its first picture quick", async () => {
  const bytes = statSync(join(folder, "drosophila/report.html")).size;
  assert.ok(bytes < 5e6, `${bytes} bytes`);
  const { page, done } = await open("drosophila/report.html");
  const ms = await page.evaluate(() => performance.getEntriesByName("first-picture")[0].startTime);
  console.log(`${(bytes / 1e6).toFixed(2)} MB; first picture after ${ms.toFixed(0)} ms`);
  await done();
});

test("a tissue that passes through itself is announced, and none other", async () => {
  const crossing = await open("curl/report.html");
  assert.match(await crossing.page.textContent("#crossing"), /^From [\d.]+ min on, the tissue passes through itself/);
  assert.ok(await crossing.page.isVisible("#crossing"));
  assert.match(await crossing.page.textContent("#headline"), /passes through itself/);
  await crossing.done();
  const sound = await open("drosophila/report.html");
  assert.ok(!(await sound.page.isVisible("#crossing")));
  await sound.done();
});
