// Drives plica studio in a real browser and photographs it: node studio.mjs FOLDER. Called by studio.py, which makes the
// pictures and the animation of the documentation.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { end, folder, launch, saved } from "../../viewer/tests/browser.mjs";
import { serve } from "../../viewer/tests/studio_server.mjs";

const out = process.argv[2];
const server = await serve(folder);
const browser = await launch();
const page = await (await browser.newContext({ viewport: { width: 1280, height: 800 }, colorScheme: "light" })).newPage();
page.setDefaultTimeout(60_000);
const film = []; // names of pictures and for how long each is shown, ms

async function shot(name) {
  await page.waitForTimeout(300); // a picture that stands still is drawn once more, finely
  await page.screenshot({ path: join(out, `${name}.png`) });
}

async function filmed(ms) {
  const name = `film-${String(film.length).padStart(3, "0")}`;
  await shot(name);
  film.push([name, ms]);
}

// A browser's pictures lack the pointer.
const pointer = () => page.evaluate(() => {
  const mark = document.createElement("div");
  mark.style.cssText = "position:fixed;z-index:9;width:22px;height:22px;margin:-11px;border-radius:50%;pointer-events:none;" +
    "background:rgb(200 40 90 / 0.35);border:2px solid rgb(200 40 90)";
  document.body.append(mark);
  document.addEventListener("mousemove", ({ clientX, clientY }) => {
    mark.style.left = `${clientX}px`;
    mark.style.top = `${clientY}px`;
  });
});

const place = async ([x, y]) => {
  const box = await page.locator(".picture").first().boundingBox();
  return [box.x + x * box.width, box.y + y * box.height];
};

/** Drag over the picture in parts of its size, film `pictures` of it. */
async function stroke(from, to, pictures) {
  await page.mouse.move(...(await place(from)));
  await page.mouse.down();
  for (let i = 1; i <= pictures; ++i) {
    const at = [0, 1].map((k) => from[k] + ((to[k] - from[k]) * i) / pictures);
    await page.mouse.move(...(await place(at)), { steps: 3 });
    await filmed(120);
  }
  await page.mouse.up();
}

const slideTo = (id, value) => page.locator(`#${id}`).evaluate((slider, value) => {
  slider.value = String(value);
  slider.dispatchEvent(new Event("input"));
}, value);

const click = async (selector, ms = 500) => {
  await page.hover(selector);
  await page.click(selector);
  if (ms > 0) await filmed(ms);
};

const ended = (run) => page.waitForFunction((run) => ["end_time", "equilibrium"].includes(
  document.querySelector(`li[data-run="${run}"]`)?.dataset.status), run, { timeout: 300_000 });

/** Film a run from its beginning to its end, by its slider. */
async function replayed(untilS, pictures) {
  for (let i = 0; i <= pictures; ++i) {
    await slideTo("time", (untilS * i) / pictures);
    await filmed(120);
  }
}

await page.goto(server.url);
await page.waitForSelector("dialog[open] .card");
await pointer();
await page.click('.card[data-source="sheet"]');
await page.waitForSelector("body[data-ready]");
await filmed(800);

// Paint a stripe, make it contract.
await slideTo("brush-size", 44);
await click("#tool-brush", 400);
await stroke([0.3, 0.5], [0.7, 0.5], 8);
await page.fill("#new-region", "stripe");
await click("#make-region", 0);
await page.waitForSelector('[data-table="region.stripe"]', { state: "attached" });
await filmed(700);
await page.selectOption("#add-kind", "cortex.*");
await page.fill("#add-name", "apical");
await click("#add", 0);
const tension = '[data-key="cortex.apical.tension_mN_per_m"]';
await page.waitForSelector(tension);
await page.fill(tension, "3");
await page.press(tension, "Enter");
await page.waitForFunction(() => document.querySelector("#text").textContent.includes("tension_mN_per_m = 3"));
await page.waitForFunction(() => !document.querySelector("#advice").textContent.includes("no force acts"));
await page.click("#clear-selection");
await page.click("#tool-rotate");
await filmed(900);
await shot("paint");

// Fold.
await click("#go", 0);
await ended(1);
await page.click("#view-antero-ventral");
await replayed(1200, 14);
await filmed(1200);
await page.click("#view-cross-section");
await filmed(1500);
await shot("fold");

// Cut at 2 min, and compare.
await page.click("#view-apical");
await slideTo("time", 120);
await filmed(500);
await slideTo("brush-size", 30);
await click("#tool-brush", 0);
await stroke([0.46, 0.5], [0.54, 0.5], 3);
await click("#act-cut", 0);
await page.waitForSelector('li[data-run="2"]');
await page.click("#tool-rotate");
await page.click("#go");
await ended(2);
await page.click("#clear-selection").catch(() => {});
await page.click("#view-antero-ventral");
await replayed(1200, 10);
await filmed(2500);
await shot("cut");
const { bytes } = await saved(page, "#save-picture");
writeFileSync(join(out, "sheet.png"), bytes);

// What is taken away.
const text = await page.evaluate(async () => (await fetch(document.querySelector('li[data-run="2"] a').href)).text());
writeFileSync(join(out, "taken.toml"), text);
writeFileSync(join(out, "film.json"), JSON.stringify(film));
await browser.close();
await server.stop("SIGINT");
await end();
