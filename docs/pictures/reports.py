"""Pictures of report pages for docs/how-to: report.png, report_runs.png and study_report.png in docs/images.

Usage: reports.py PROGRAM RESULTS [NAME...], of: report report_runs study_report; without, all. Runs that are not in RESULTS are
made there first, minutes in all. Needs Chromium, Node.js and viewer/node_modules (`npm ci` in viewer/), and Pillow.
"""
import re
import subprocess
import sys
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
IMAGES = ROOT / "docs/images"
PROGRAM, RESULTS = (Path(argument).resolve() for argument in sys.argv[1:3])
# Opens a page at a width in CSS pixels, acts on it, and saves a picture 1440 pixels wide.
SCRIPT = """
import { chromium } from "playwright-core";
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
const page = await browser.newPage({ viewport: { width: WIDTH, height: HEIGHT }, deviceScaleFactor: 1440 / WIDTH });
await page.goto("file://FILE");
await page.waitForSelector("body[data-ready]");
const choose = (id, value) => page.selectOption(id, value);
const set = (id, value) => page.locator(id).evaluate((one, value) => {
  one.value = String(value);
  one.dispatchEvent(new Event("input"));
  one.dispatchEvent(new Event("change"));
}, value);
ACTIONS
await page.waitForTimeout(3000);
await page.screenshot({ path: "PICTURE" });
await browser.close();
"""


def plica(*arguments):
    subprocess.run([PROGRAM, *map(str, arguments)], check=True)


def screenshot(page, name, width, height, actions):
    picture = RESULTS / f"{name}.png"
    script = SCRIPT.replace("ACTIONS", actions)
    for word, value in (("WIDTH", width), ("HEIGHT", height), ("FILE", page.resolve()), ("PICTURE", picture)):
        script = script.replace(word, str(value))
    subprocess.run(["node", "--input-type=module", "-e", script], cwd=ROOT / "viewer", check=True)
    Image.open(picture).convert("RGB").save(IMAGES / f"{name}.png", optimize=True)
    print(f"drawn: {IMAGES / name}.png")


def run(name, scenario, *options):
    if not (RESULTS / name / "summary.json").is_file():
        plica("run", scenario, "--out", RESULTS / name, "--quiet", "--overwrite", *options)
    return RESULTS / name


def block_of_page(page, start):
    """The code block of a page that starts with these words."""
    (text,) = re.findall(rf"^```\w+\n({re.escape(start)}.*?)^```", (ROOT / "docs/how-to" / page).read_text(encoding="utf-8"), re.M | re.S)
    return text


def report():
    """The whole embryo that closes, cut across, with a cell of the furrow picked."""
    results = run("living", "drosophila-living", "--set", 'embryo.mirror=["x","y"]')
    plica("report", results)
    screenshot(results / "report.html", "report", 1020, 800, """
await page.click("#view-cross-section");
await choose("#field", "area-ratio");
await page.check("#edges");
await set("#time", await page.locator("#time").evaluate((one) => Math.round(0.8 * one.max)));
await page.mouse.click(338, 530);  // a cell of the furrow
""")


def report_runs():
    """The runs of the page, as it makes them."""
    if not (RESULTS / "sweep.html").is_file():
        subprocess.run(["bash", "-ec", block_of_page("report.md", "for ")], cwd=RESULTS, check=True,
                       env={"PATH": f"{PROGRAM.parent}:/usr/bin:/bin", "HOME": "/tmp"})
    screenshot(RESULTS / "sweep.html", "report_runs", 1060, 985, """
await page.click("#view-cross-section");
await page.fill("#filter", "tension>=0.4");
await page.waitForTimeout(2000);
await page.mouse.click(127, 875);  // a cell of the deepest furrow
""")


def study_report():
    """The phase diagram of the page on studies, coloured by the verdict."""
    if not (RESULTS / "phases/report.html").is_file():
        (RESULTS / "phases.toml").write_text(block_of_page("answers.md", "# phases.toml").replace('each = "full"', 'each = "summary"'))
        plica("study", RESULTS / "phases.toml", "--out", RESULTS / "phases", "--quiet", "--overwrite")
    screenshot(RESULTS / "phases/report.html", "study_report", 1020, 990, "")


RESULTS.mkdir(parents=True, exist_ok=True)
for name in sys.argv[3:] or ("report", "report_runs", "study_report"):
    globals()[name]()
