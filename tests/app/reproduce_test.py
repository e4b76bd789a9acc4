"""`plica reproduce --quick`: the page, its verdicts and its files."""
import base64
import csv
import math
import os
import re
import xml.etree.ElementTree

import support
from support import CommandLine, plica

VERDICTS = {"*reproduced*", "*reproduced under this reading*", "*not reproduced*"}


class Reproduce(CommandLine):
    def rows(self, page, heading):
        """The cells of the table below a heading, without its header."""
        lines = page.split(f"\n## {heading}\n")[1].split("\n## ")[0].splitlines()
        table = [line for line in lines if line.startswith("|")]
        return [[cell.strip() for cell in line.strip("|").split("|")] for line in table[2:]]

    def test_a_quick_reproduction(self):
        result = plica("reproduce", "--out", self.out, "--quick", timeout=280)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertRegex(result.stderr, r"\d+ of \d+ runs")
        page, html = (self.out / "reproduction.md").read_text(), (self.out / "reproduction.html").read_text()

        claims = self.rows(page, "Claims")
        self.assertGreater(len(claims), 40)
        self.assertEqual({row[5] for row in claims}, VERDICTS)
        verdict = {row[1]: row[5] for row in claims}
        self.assertEqual(verdict["The pill has 756 cells"], "*reproduced*")
        self.assertEqual(verdict["The pill's mesh has 2268 nodes"], "*not reproduced*")
        self.assertEqual(verdict["Total depth of the streak, from the shell down"], "*reproduced under this reading*")
        for row in claims:
            if row[5] == "*not reproduced*":
                self.assertTrue(row[6], f"no cause: {row}")
        counts = re.search(r"(\d+) claims: (\d+) reproduced, (\d+) reproduced under this reading, (\d+) not", result.stdout)
        self.assertEqual(int(counts[1]), len(claims))
        self.assertEqual(int(counts[2]), sum(row[5] == "*reproduced*" for row in claims))
        self.assertEqual(int(counts[4]), sum(row[5] == "*not reproduced*" for row in claims))

        readings = self.rows(page, "Readings")
        scores = [float(row[2]) for row in readings if row[2] != "–"]
        self.assertGreater(len(scores), 4)
        self.assertEqual(scores, sorted(scores))

        words = re.sub(r' src="data:image/png;base64,[^"]*"', "", html)
        for text in (page, words):
            self.assertIsNone(re.search(r"(?i)\bnan\b|\binf\b", text))
        self.assertNotIn("Missing:", page)
        self.assertIsNone(re.search(r"https?://|src=|href=|url\(", words))
        figures = re.findall(r"!\[.*?\]\((figures/.*?)\)", page)
        for name in ("fig8a-speeds", "fig8b-speeds", "mechanism"):
            self.assertIn(f"figures/{name}.svg", figures)
        for name in ("fig4-division", "fig7-pill", "fig9-sections", "fig10-ventral", "fig11-sphere"):
            self.assertIn(f"figures/{name}.png", figures)
        for figure in figures:
            content = (self.out / figure).read_bytes()
            if figure.endswith(".png"):
                self.assertTrue(content.startswith(b"\x89PNG"), figure)
                self.assertGreater(len(content), 20000, figure)
                self.assertIn(base64.b64encode(content).decode(), html)
            else:
                self.assertGreater(len(xml.etree.ElementTree.fromstring(content)), 3, figure)
        self.assertEqual(html.count("<figure>"), len(figures))
        tables = list((self.out / "figures").glob("*.csv"))
        self.assertGreaterEqual(len(tables), 5)
        for path in tables:
            for row in list(csv.reader(path.read_text().splitlines()))[1:]:
                self.assertTrue(all(value == "" or math.isfinite(float(value)) for value in row[1:]), f"{path}: {row}")

        again = plica("reproduce", "--out", self.out, "--quick")
        self.assertEqual(again.returncode, 4)
        self.assertIn("--overwrite", self.assert_messages(again)[0])

    def test_without_a_display_the_page_says_what_is_missing(self):
        bare = {**os.environ, "PATH": "/nonexistent"}
        bare.pop("DISPLAY", None)
        result = plica("reproduce", "--out", self.out, "--quick", "--quiet", timeout=280, env=bare)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        messages = self.assert_messages(result, 5)
        page = (self.out / "reproduction.md").read_text()
        for name, message in zip(("fig4", "fig7", "fig9", "fig10", "fig11"), messages):
            self.assertIn(f"missing: {name}", message)
            self.assertIn("apt-get install xvfb", message)
            self.assertRegex(page, f"Missing: {name}-.*apt-get install xvfb")
        self.assertIn("figures/fig8a-speeds.svg", page)
        self.assertFalse(list((self.out / "figures").glob("*.png")))

    def test_an_interrupted_reproduction_ends_its_runs(self):
        process = support.start("reproduce", "--out", self.out, "--quick")
        support.count_case()
        support.time.sleep(1.5)
        process.terminate()
        process.communicate(timeout=30)
        self.assertEqual(process.returncode, 143)
        self.assertFalse((self.out / "reproduction.html").exists())


if __name__ == "__main__":
    support.main()
