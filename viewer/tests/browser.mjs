// What the tests of the report share: runs in a temporary folder, a browser without a network, pixels. BROWSER=firefox takes
// Debian's Firefox instead of its Chromium, on a screen (xvfb-run), without which it offers no WebGL.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium, firefox } from "playwright-core";

const plica = process.env.PLICA ?? "plica";
export const isFirefox = process.env.BROWSER === "firefox";
export const folder = mkdtempSync(join(tmpdir(), "plica-report-"));
let browser;

export function run(scenario, name, ...options) {
  execFileSync(plica, ["run", scenario, "--out", join(folder, name), "--quiet", ...options]);
}

export function report(names, file) {
  execFileSync(plica, ["report", ...names.map((name) => join(folder, name)), "--out", join(folder, file)]);
}

export function launch({ webgl = true } = {}) {
  if (isFirefox)
    return firefox.launch({
      channel: "moz-firefox", executablePath: process.env.FIREFOX ?? "/usr/bin/firefox-esr", headless: false,
      firefoxUserPrefs: { "webgl.force-enabled": webgl, "webgl.disabled": !webgl },
    });
  const quiet = ["--no-sandbox", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
  // As on a machine without a graphics card: the processor draws the scene, and the page without a detour over WebGL.
  const drawing = webgl ? ["--disable-gpu", "--enable-unsafe-swiftshader"] : ["--disable-3d-apis"];
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: [...quiet, ...drawing] });
}

export async function begin() {
  browser = await launch();
}

export async function end() {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
}

// Opens a page and watches it; `done` fails where it said or asked for something that it should not.
export async function open(file, { width = 900, height = 640, dark = false } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light" });
  const page = await context.newPage();
  const wrong = [];
  const url = pathToFileURL(join(folder, file)).href;
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && wrong.push(message.text()));
  page.on("pageerror", (error) => wrong.push(String(error)));
  page.on("request", (request) => request.url() !== url && !/^(data|blob):/.test(request.url()) && wrong.push(request.url()));
  await page.goto(url);
  await page.waitForSelector("body[data-ready]");
  if (dark && isFirefox) await page.click("#theme"); // its driver sets no colour scheme
  const done = async () => {
    await context.close();
    // Chromium's own remark on drawing without a graphics card is no fault of the page.
    assert.deepEqual(wrong.filter((text) => !/GPU stall|swiftshader|GroupMarkerNotSet/i.test(text)), []);
  };
  return { page, done };
}

// Ticks a box, or takes its tick away. On a busy machine Firefox's driver may say that it has clicked before the page has
// heard of it, and Playwright's own `check` looks at once; a click that the page never heard of is repeated.
export async function tick(page, selector, on) {
  const isSo = ([selector, on]) => document.querySelector(selector).checked === on;
  for (let tries = 3; !(await page.evaluate(isSo, [selector, on])); --tries) {
    assert.ok(tries > 0, `${selector} does not become ${on} by clicks`);
    await page.click(selector);
    await page.waitForFunction(isSo, [selector, on], { timeout: 10_000 }).catch(() => {});
  }
}

/** What a click on the button saves: the file's name and its bytes. */
export async function saved(page, button) {
  if (!isFirefox) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.click(button)]);
    return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
  }
  // Firefox's driver does not tell of downloads: what the page offers is taken instead.
  await page.evaluate(() => {
    window.offeredName = undefined;
    const urlOf = URL.createObjectURL;
    URL.createObjectURL = (blob) => urlOf((window.offered = blob));
    HTMLAnchorElement.prototype.click = function () { window.offeredName = this.download; };
  });
  await page.click(button);
  await page.waitForFunction(() => window.offeredName);
  const [name, text] = await page.evaluate(async () => {
    const bytes = new Uint8Array(await window.offered.arrayBuffer());
    let text = "";
    for (let i = 0; i < bytes.length; i += 8192) text += String.fromCharCode(...bytes.subarray(i, i + 8192));
    return [window.offeredName, btoa(text)];
  });
  return { name, bytes: Buffer.from(text, "base64") };
}

// The pixels of a part of the page: rgb(x, y) in CSS pixels.
export async function pixels(page, selector) {
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  await page.waitForTimeout(300);
  await page.waitForFunction((selector) => { // a picture that stands still is drawn once more, finely
    const { fineness } = document.querySelector(selector).dataset;
    return fineness === undefined || Number(fineness) > 1;
  }, selector, { timeout: 5000 }).catch(() => {});
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

export const isPaper = ([r, g, b]) => r > 250 && g > 250 && b > 250;
export const difference = (a, b) => Math.max(...a.map((value, i) => Math.abs(value - b[i])));

// The part of the pixels that two pictures of one size do not share.
export function changed(a, b) {
  assert.deepEqual([a.width, a.height], [b.width, b.height]);
  let count = 0;
  for (let y = 0; y < a.height; y += 2) for (let x = 0; x < a.width; x += 2) count += difference(a.rgb(x, y), b.rgb(x, y)) > 12;
  return count / ((a.width * a.height) / 4);
}

export function table(file) {
  const [head, ...lines] = readFileSync(join(folder, file), "utf8").trim().split("\n");
  const columns = head.split(",");
  return lines.map((line) => Object.fromEntries(line.split(",").map((field, i) => [columns[i], field === "" ? null : Number(field)])));
}

// What the page writes as text, as a number: "1.2·10⁻¹¹" and "−3" too.
export function numberOf(text) {
  const plain = text.replaceAll("−", "-").replace(/[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]/g, (c) => "-0123456789"["⁻⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(c)]);
  return Number(plain.replace("·10", "e"));
}

export function near(actual, expected, relative, what) {
  assert.ok(Math.abs(actual - expected) <= relative * Math.abs(expected) + 1e-12, `${what}: ${actual} for ${expected}`);
}

export const chosenFrame = (page, index) =>
  page.locator("#time").evaluate((slider, value) => {
    slider.value = String(value);
    slider.dispatchEvent(new Event("input"));
  }, index);

export async function shownSeries(page) {
  return Object.fromEntries(await page.locator("#plots output").evaluateAll((all) =>
    all.map((output) => [output.dataset.column, output.textContent])));
}

