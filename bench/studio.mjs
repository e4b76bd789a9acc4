// What plica studio costs: node bench/studio.mjs, with STUDIO_PYTHON, PYTHONPATH, PLICA and Chromium as for
// viewer/tests/studio.test.mjs. Prints JSON. Times are those of this machine, whatever else it does.
import { execFileSync } from "node:child_process";
import { readFileSync, rmSync } from "node:fs";
import { loadavg } from "node:os";
import { join } from "node:path";
import { end, folder, launch } from "../viewer/tests/browser.mjs";
import { serve } from "../viewer/tests/studio_server.mjs";

const plica = process.env.PLICA ?? "plica";
const repeats = Number(process.env.REPEATS ?? 5);
const large = process.env.LARGE ?? "drosophila-living"; // runs while it is looked at
const median = (numbers) => [...numbers].sort((a, b) => a - b)[Math.floor(numbers.length / 2)];
const seconds = (since) => (performance.now() - since) / 1000;

const browser = await launch();
let server;
let page;

async function open(scenario) {
  rmSync(join(folder, ".plica-studio"), { recursive: true, force: true });
  server = await serve(folder, scenario);
  page = await (await browser.newContext({ viewport: { width: 1280, height: 800 } })).newPage();
  page.setDefaultTimeout(600_000);
  await page.addInitScript(() => {
    window.pictures = 0;
    const draw = CanvasRenderingContext2D.prototype.drawImage;
    CanvasRenderingContext2D.prototype.drawImage = function (...given) {
      if (this.canvas.classList.contains("picture")) ++window.pictures;
      return draw.apply(this, given);
    };
  });
  await page.goto(server.url);
  await page.waitForSelector("body[data-ready]");
}

async function close() {
  await page.context().close();
  await server.stop("SIGINT");
}

/** Seconds from the command to the first picture. */
async function toPicture(scenario) {
  const times = [];
  for (let i = 0; i < repeats; ++i) {
    const since = performance.now();
    await open(scenario);
    times.push(seconds(since));
    await close();
  }
  return median(times);
}

const wallOf = (results) => JSON.parse(readFileSync(join(results, "summary.json"), "utf8")).wall_s;

/** Processor time of a process, or of the ended children of this one, in ticks. */
function ticksOf(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ").map(Number);
  return pid === "self" ? fields[13] + fields[14] : fields[11] + fields[12];
}

/** Time of a run that is looked at, relative to plica run, in turns: on the wall, and of the solving process alone. */
async function watching(scenario) {
  const [walls, processors] = [[], []];
  for (let i = 0; i < repeats; ++i) {
    const alone = join(folder, "alone");
    const before = ticksOf("self");
    execFileSync(plica, ["run", scenario, "--out", alone, "--overwrite", "--quiet", "--threads", "1"], { stdio: "ignore" });
    const ticks = ticksOf("self") - before;
    await open(scenario);
    await page.waitForTimeout(1000); // as a person would: the still tissue is drawn finely meanwhile
    const opened = ticksOf(server.pid);
    await page.click("#go");
    await page.waitForFunction(() => ["end_time", "equilibrium"].includes(
      document.querySelector('li[data-run="1"]')?.dataset.status));
    processors.push((ticksOf(server.pid) - opened) / ticks - 1);
    walls.push(wallOf(join(folder, ".plica-studio/run-0001/results")) / wallOf(alone) - 1);
    await close();
  }
  return { scenario, wall: median(walls), processor: median(processors) };
}

/** Pictures per second while a run is solved and its view is turned. */
async function pictures(scenario, lastingS) {
  await open(scenario);
  await page.click("#go");
  await page.waitForFunction(() => document.body.dataset.frame.startsWith("1/"));
  const canvas = page.locator(".picture").first();
  const box = await canvas.boundingBox();
  const made = () => page.evaluate(() => window.pictures);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  const [since, before] = [performance.now(), await made()];
  for (let i = 0; seconds(since) < lastingS; ++i)
    await page.mouse.move(box.x + box.width * (0.5 + 0.2 * Math.sin(i / 20)), box.y + box.height / 2);
  const perSecond = ((await made()) - before) / seconds(since);
  await page.mouse.up();
  const cells = Number(await canvas.getAttribute("data-cells"));
  await close();
  return { scenario, cells, per_s: perSecond };
}

/** Time from a selection of about 500 cells to the checked region, shown. */
async function stroke(scenario) {
  await open(scenario);
  await page.click("#tool-lasso");
  const box = await page.locator(".picture").first().boundingBox();
  const corners = [[0.35, 0.34], [0.65, 0.34], [0.65, 0.64], [0.35, 0.64]].map(([x, y]) =>
    [box.x + x * box.width, box.y + y * box.height]);
  await page.mouse.move(...corners[0]);
  await page.mouse.down();
  for (const corner of corners) await page.mouse.move(...corner, { steps: 4 });
  await page.mouse.up();
  const cells = parseInt(await page.textContent("#selected-count"));
  const times = [];
  for (let i = 0; i < repeats; ++i) {
    await page.evaluate(() => delete document.body.dataset.strokeMs);
    await page.fill("#new-region", `part-${i}`);
    await page.click("#make-region");
    await page.waitForSelector("body[data-stroke-ms]");
    times.push(Number(await page.evaluate(() => document.body.dataset.strokeMs)));
  }
  await close();
  return { scenario, cells, ms: median(times) };
}

const result = { load: loadavg()[0], repeats };
result.to_picture_s = {};
for (const scenario of ["furrow-slice", "sheet", large]) result.to_picture_s[scenario] = await toPicture(scenario);
result.watching = await watching("furrow-slice");
result.pictures = await pictures(large, 20);
result.stroke = await stroke(large);
server = await serve(folder, "furrow-slice");
result.page_kB = (await (await fetch(server.url)).arrayBuffer()).byteLength / 1000;
await server.stop("SIGINT");
result.load_at_end = loadavg()[0];
console.log(JSON.stringify(result, null, 2));
await browser.close();
await end();
