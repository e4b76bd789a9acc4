// plica studio in a real browser: what a person does with it, and random acts. STUDIO_PYTHON names the Python that has
// plica.studio; PLICA the program that repeats what is taken away. Any console error, any request elsewhere, fails the test.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, saved } from "./browser.mjs";
import { python, serve } from "./studio_server.mjs";

const plica = process.env.PLICA ?? "plica";
const monkeyActs = Number(process.env.STUDIO_ACTS ?? 60);
const patience = 300_000; // ms, on a busy machine
const options = { skip: python ? false : "STUDIO_PYTHON is not set" };
const folder = mkdtempSync(join(tmpdir(), "plica-studio-"));
let server;
let browser;

before(async () => {
  if (!python) return;
  writeFileSync(join(folder, "short.toml"),
    'base = "furrow-slice"\ntitle = "A short slice"\n[time]\nend_s = 240\n[output]\nframe_every_s = 15\n');
  server = await serve(folder);
  browser = await launch();
});

after(async () => {
  await browser?.close();
  await server?.stop("SIGINT");
  rmSync(folder, { recursive: true, force: true });
});

// `late`: the server's answers come after the states that follow from them, as on a fast machine.
async function open({ dark = false, late = false } = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, colorScheme: dark ? "dark"
    : "light", acceptDownloads: true });
  const page = await context.newPage();
  page.setDefaultTimeout(patience);
  if (late) {
    await page.routeWebSocket(/\/ws/, (socket) => {
      const there = socket.connectToServer();
      there.onMessage((message) => setTimeout(() => socket.send(message), /^\{"id"/.test(message) ? 1000 : 0));
    });
  }
  const wrong = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && wrong.push(message.text()));
  page.on("pageerror", (error) => wrong.push(String(error)));
  page.on("request", (request) => new URL(request.url()).host !== new URL(server.url).host &&
    !/^(data|blob):/.test(request.url()) && wrong.push(request.url()));
  await page.goto(server.url);
  const done = async (allowed = /$^/) => {
    await context.close();
    assert.deepEqual(wrong.filter((text) => !/GPU stall|swiftshader|GroupMarkerNotSet/i.test(text) &&
      !allowed.test(text)), []);
  };
  return { page, done };
}

// The first test begins with the choice of a scenario; each test may be the first.
async function openedScenario(given) {
  const opened = await open(given);
  const { page } = opened;
  await page.waitForSelector("body[data-ready], dialog[open] .file");
  if (await page.isVisible("dialog[open]")) await page.click('.file[data-source="short.toml"]');
  await page.waitForSelector("body[data-ready]");
  return opened;
}

const shownRun = (page) => page.evaluate(() => Number(document.querySelector("input[name=run]:checked").value));
const status = (page, run) => page.locator(`li[data-run="${run}"]`).getAttribute("data-status");
const ended = (page, run) => page.waitForFunction((run) => ["end_time",
  "equilibrium"].includes(document.querySelector(`li[data-run="${run}"]`)?.dataset.status), run);

// The last row of series.csv without wall times.
function lastRow(file) {
  const [head, ...lines] = readFileSync(file, "utf8").trim().split("\n");
  const names = head.split(",");
  return Object.fromEntries(lines.at(-1).split(",").map((text, i) => [names[i], text]).filter(([name]) =>
    !name.startsWith("wall")));
}

async function drag(page, from, to) {
  const box = await page.locator(".picture").first().boundingBox();
  const at = ([x, y]) => [box.x + x * box.width, box.y + y * box.height];
  await page.mouse.move(...at(from));
  await page.mouse.down();
  await page.mouse.move(...at(to), { steps: 6 });
  await page.mouse.up();
}

// A slice's cross-section fills the picture: its lower part is the ventral side.
async function paintBelow(page) {
  await page.click("#view-cross-section");
  await page.keyboard.press("b");
  await page.locator("#brush-size").evaluate((slider) => {
    slider.value = "40";
    slider.dispatchEvent(new Event("input"));
  });
  for (let x = 0.3; x < 0.7; x += 0.05) {
    await drag(page, [x, 0.62], [x + 0.05, 0.98]);
    if (Number((await page.textContent("#selected-count")).split(" ")[0]) > 0) break;
  }
  assert.ok(Number((await page.textContent("#selected-count")).split(" ")[0]) > 0, "the brush selects cells");
}

test("open, paint, set, run, cut, compare, take away, repeat", options, async () => {
  const { page, done } = await open();
  // A new folder begins with the choice of a scenario.
  await page.waitForSelector("dialog[open] .card");
  await page.waitForFunction(() => [...document.querySelectorAll(".card img")].every((one) => one.naturalWidth > 0));
  await page.click('.file[data-source="short.toml"]');
  await page.waitForSelector("body[data-ready]");
  await page.waitForFunction(() => document.querySelector("#title").textContent === "A short slice");

  await paintBelow(page);
  // A name that is missing or refused is asked for, and not lost.
  const refused = () => page.waitForFunction(() => /name/.test(document.querySelector("#problem:not([hidden])")?.textContent));
  await page.click("#make-region");
  await refused();
  await page.click("#problem .close");
  await page.fill("#new-region", "spot!");
  await page.press("#new-region", "Enter");
  await refused();
  assert.equal(await page.inputValue("#new-region"), "spot!");
  await page.fill("#new-region", "spot");
  await page.click("#make-region");
  await page.waitForSelector('[data-table="region.spot"]', { state: "attached" });
  assert.equal(await page.inputValue("#add-region"), "spot");
  await page.click("#undo");
  await page.waitForSelector('[data-table="region.spot"]', { state: "detached" });
  await page.click("#redo");
  await page.waitForSelector('[data-table="region.spot"]', { state: "attached" });

  // A slider of a selector shows on the way which cells the region has; one undo takes the drag back.
  await page.click('[data-table="region.mesoderm"] > summary');
  const cells = () => page.textContent('[data-region="mesoderm"]');
  await page.waitForFunction(() => /cell/.test(document.querySelector('[data-region="mesoderm"]').textContent));
  const before = await cells();
  await page.evaluate(() => document.querySelectorAll('[data-table="region.mesoderm"] .more').forEach((one) => (one.open = true)));
  await page.locator('[data-key="region.mesoderm.y_um/0"]').evaluate((slider) => {
    for (const value of ["-20", "-10", "0"]) {
      slider.value = value;
      slider.dispatchEvent(new Event("input"));
    }
  });
  await page.waitForFunction((before) => document.querySelector('[data-region="mesoderm"]').textContent !== before, before);
  await page.locator('[data-key="region.mesoderm.y_um/0"]').evaluate((slider) => slider.dispatchEvent(new Event("change")));
  await page.click("#undo");
  await page.waitForFunction((before) => document.querySelector('[data-region="mesoderm"]').textContent === before, before);

  // A wrong value is refused at its field as it is typed, a right one taken.
  await page.click('[data-table="cortex.apical"] > summary');
  const tension = '[data-key="cortex.apical.tension_mN_per_m"]';
  await page.fill(tension, "-3");
  await page.waitForSelector(`${tension}[aria-invalid="true"]`);
  assert.match(await page.textContent(`.field:has(${tension}) .fault`), />= 0/);
  await page.fill(tension, "1,6");
  await page.press(tension, "Enter");
  await page.waitForFunction(() => document.querySelector("#text").textContent.includes("tension_mN_per_m = 1.6"));
  assert.match(await page.textContent("#text"), /base = "furrow-slice"/);

  // A new force can be set at once.
  await page.selectOption("#add-kind", "cortex.*");
  await page.fill("#add-name", "new");
  await page.selectOption("#add-region", "spot");
  await page.click("#add");
  await page.fill('[data-key="cortex.new.tension_mN_per_m"]', "0.5");
  await page.press('[data-key="cortex.new.tension_mN_per_m"]', "Enter");
  await page.waitForFunction(() => /cortex.new\][^[]*tension_mN_per_m = 0.5/.test(document.querySelector("#text").textContent));
  await page.click("#undo");
  await page.click("#undo");
  await page.waitForFunction(() => !document.querySelector("#text").textContent.includes("cortex.new"));

  // The profile of a law as colour.
  await page.selectOption("#field", "strength of cortex.apical");
  await page.waitForFunction(() => document.querySelector("#legend").width > 0);
  await page.selectOption("#field", "region");

  // Times are typed in minutes.
  await page.click('[data-table="time"] > summary');
  assert.equal(await page.inputValue('[data-key="time.end_s"]'), "4");
  await page.fill('[data-key="time.end_s"]', "3.5");
  await page.press('[data-key="time.end_s"]', "Enter");
  await page.waitForFunction(() => document.querySelector("#text").textContent.includes("end_s = 210"));
  await page.click("#undo");
  await page.waitForFunction(() => document.querySelector("#text").textContent.includes("end_s = 240"));

  await page.selectOption("#paint-into", "spot");
  await page.fill("#until", "1");
  await page.click("#go-to");
  await page.waitForFunction(() => document.querySelector('li[data-run="1"]')?.dataset.status === "paused");
  assert.equal(await shownRun(page), 1);
  // The cells painted into a region are not those to act on.
  assert.deepEqual([await page.inputValue("#paint-into"), await page.textContent("#selected-count")], ["", "0 cells"]);
  await page.selectOption("#paint-into", "spot");
  assert.notEqual(await page.textContent("#selected-count"), "0 cells");
  assert.equal(new URL(page.url()).hash, "#run-1");
  await page.waitForFunction(() => /^[1-9]/.test(document.querySelector("#time-text").textContent) &&
    document.querySelector("#plots canvas"));

  // The movie's last picture is that of the page; each has a scale bar, and its own time.
  for (const kind of ["picture", "movie"]) {
    const { name, bytes } = await saved(page, `#save-${kind}`);
    writeFileSync(join(folder, name), bytes);
  }
  const [frames, apart, bars, times] = JSON.parse(execFileSync(python, ["-c", `if True:
    import json
    from PIL import Image, ImageChops, ImageSequence, ImageStat
    movie, page = Image.open("plica.gif"), Image.open("plica.png").convert("RGB")
    pictures = [one.convert("RGB") for one in ImageSequence.Iterator(movie)]
    apart = ImageChops.difference(pictures[-1], page.resize(movie.size, Image.Resampling.BOX))
    legend = 54
    bars = [one.crop((12, one.height - legend - 14, 52, one.height - legend - 11)).convert("L").getextrema()[1] < 80
            for one in pictures]
    times = [one.crop((8, 8, 140, 28)).convert("L").tobytes() for one in pictures]
    print(json.dumps([len(pictures), max(ImageStat.Stat(apart).mean), sum(bars), len(set(times))]))`], { cwd: folder }));
  assert.ok(frames > 2 && apart < 6, `${frames} pictures, ${apart} of 255 apart`);
  assert.equal(bars, frames, "each picture of the movie has a scale bar");
  assert.ok(times > 2 && times <= frames, `${times} times in ${frames} pictures`);

  await page.click("#clear-selection");
  await paintBelow(page);
  await page.click("#act-cut");
  await page.waitForSelector('li[data-run="2"]');
  await page.waitForFunction(() => document.querySelectorAll("#canvases .view:not([hidden])").length === 2);
  assert.equal(await shownRun(page), 2);
  await page.waitForFunction(() => document.querySelector('li[data-run="2"]').dataset.status === "paused");
  await page.click("#go");
  await ended(page, 2);
  await page.selectOption("#field", "difference");

  // Back in time, and darkness from there on.
  await page.waitForFunction(() => Number(document.querySelector("#time").max) > 200);
  await page.locator("#time").evaluate((slider) => {
    slider.value = "100";
    slider.dispatchEvent(new Event("input"));
  });
  // The page shows the frame before; a quick machine keeps few.
  await page.waitForFunction(() => Math.abs(parseFloat(document.querySelector("#time-text").textContent) - 100) < 45);
  await page.fill("#dark-strength", "0.2");
  await page.click("#act-darken");
  await page.waitForSelector('li[data-run="3"]');
  await page.waitForFunction(() => document.querySelector('li[data-run="3"]').dataset.status === "paused");
  await page.click("#go");
  await ended(page, 3);

  // What is taken away repeats the run, digit by digit.
  const text = await page.evaluate(async () =>
    (await fetch(document.querySelector('li[data-run="3"] a[download="scenario.toml"]').href)).text());
  writeFileSync(join(folder, "taken.toml"), text);
  assert.match(text, /\[ablation\.cut-1\]/);
  assert.match(text, /remaining = 0\.2/);
  execFileSync(plica, ["run", join(folder, "taken.toml"), "--out", join(folder, "taken"), "--quiet"]);
  assert.deepEqual(lastRow(join(folder, ".plica-studio/run-0003/results/series.csv")),
    lastRow(join(folder, "taken/series.csv")));
  await done();
});

test("a tissue of mine is shown with remarks before it is used", options, async () => {
  const at = [0, 1, 2, 3, 4];
  writeFileSync(join(folder, "sheet.off"), ["OFF", "25 16 0", ...at.flatMap((y) => at.map((x) => `${20 * x} ${20 * y} 0`)),
    ...at.slice(1).flatMap((_, y) => at.slice(1).map((_, x) => 5 * y + x).map((i) => `4 ${i} ${i + 1} ${i + 6} ${i + 5}`))]
    .join("\n"));
  writeFileSync(join(folder, "broken.off"), "OFF\n1 0 0\n0 0 0\n");
  const { page, done } = await openedScenario({ late: true });
  const title = await page.textContent("#title");
  await page.click("#open");
  await page.click('.file[data-source="broken.off"]');
  await page.waitForFunction(() => document.querySelector("#candidate .fault").textContent.includes("broken.off"));
  assert.ok(await page.isDisabled("#use"));
  await page.click("#open");
  await page.click('.file[data-source="sheet.off"]');
  await page.waitForFunction(() => document.querySelector("#remarks").textContent.includes("16 cells"));
  await page.waitForSelector("dialog[open]", { state: "hidden" });
  await page.waitForFunction(() => document.body.dataset.frame.startsWith("-1/"));
  assert.equal(await page.textContent("#title"), title);
  await page.fill("#ask-cell_height_um", "15");
  await page.press("#ask-cell_height_um", "Tab");
  await page.click("#use"); // while the answer is read
  await page.waitForFunction(() => document.querySelector("#title").textContent === "sheet.off");
  await page.waitForFunction(() => document.querySelector("#text").textContent.includes("cell_height_um = 15"));
  await page.waitForSelector("#candidate", { state: "hidden" });
  await page.click("#undo");
  await page.waitForFunction((title) => document.querySelector("#title").textContent === title, title);
  await done();
});

test("the server is killed and started again: the page goes on", options, async () => {
  const { page, done } = await openedScenario({ dark: true });
  await page.click("#show-0");
  await page.click("#go");
  await page.waitForFunction(() => document.querySelector("input[name=run]:checked").value !== "0");
  const run = await shownRun(page);
  await server.stop("SIGKILL");
  await page.waitForSelector("#connection:not([hidden])");
  server = await serve(folder);
  await page.waitForSelector("#connection", { state: "hidden" });
  await page.waitForFunction((run) => document.querySelector(`li[data-run="${run}"]`), run);
  if (!["end_time", "equilibrium"].includes(await status(page, run))) await page.click("#go");
  await ended(page, run);
  await done(/WebSocket|ERR_|can.t establish|interrupted/); // the browser's own remark on a lost connection
});

test(`${monkeyActs} random acts leave no error`, options, async () => {
  const { page, done } = await openedScenario();
  let seed = 7;
  const random = (count) => {
    seed = (seed * 1103515245 + 12345) % 2147483648;
    return Math.floor((seed / 2147483648) * count);
  };
  page.on("dialog", (dialog) => dialog.dismiss());
  const acts = [
    ...["b", "l", "v", " ", "s", ",", ".", "Home", "End", "1", "2", "3"].map((key) => () =>
      page.keyboard.press(key === " " ? "Space" : key)),
    () => drag(page, [Math.random(), Math.random()], [Math.random(), Math.random()]),
    () => drag(page, [0.3, 0.5], [0.7, 0.9]),
    ...["undo", "redo", "act-cut", "act-darken", "go", "step", "replay", "clear-selection", "erase", "mirror", "theme",
      "make-region"].map((id) => () => page.locator(`#${id}`).click({ timeout: 300 }).catch(() => {})),
    () => page.locator("input[name=run]").nth(random(4)).click({ timeout: 300 }).catch(() => {}),
    () => page.locator("[id^=beside-]").nth(random(3)).click({ timeout: 300 }).catch(() => {}),
    () => page.locator("[id^=remove-]").last().click({ timeout: 300 }).catch(() => {}),
    () => page.locator("#tables > details > summary").nth(random(12)).click({ timeout: 300 }).catch(() => {}),
    () => page.locator("#tables input[type=text]:visible").nth(random(6)).fill(["-1", "x", "0.5", "",
      "[1, 2]"][random(5)], { timeout: 300 }).catch(() => {}),
    () => page.locator("#field").selectOption({ index: random(8) }),
  ];
  for (let i = 0; i < monkeyActs; ++i) await acts[random(acts.length)]();
  // The session still works, and its scenario is valid.
  const text = await page.evaluate(async () => (await fetch(document.querySelector("#take-scenario").href)).text());
  writeFileSync(join(folder, "monkey.toml"), text);
  execFileSync(plica, ["check", join(folder, "monkey.toml")]);
  assert.ok(existsSync(join(folder, ".plica-studio/session.json")));
  await done();
});
