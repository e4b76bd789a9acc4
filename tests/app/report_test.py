"""`plica report` from outside: what it writes, what it refuses. The page itself is tested in a browser (viewer/tests)."""
import json
import re
import shutil

import support
from support import BLOCK, CommandLine, plica


class Report(CommandLine):
    def setUp(self):
        super().setUp()
        self.run_scenario(BLOCK)

    def report(self, *arguments, status=0):
        result = plica("report", *arguments)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result

    def data(self, file):
        text = file.read_text()
        return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)[1])

    def test_a_run_leaves_its_page_and_report_makes_it_anew(self):
        page = self.out / "report.html"
        data = self.data(page)
        self.assertEqual([run["name"] for run in data["runs"]], ["out"])
        self.assertEqual(data["runs"][0]["series"], (self.out / "series.csv").read_text())
        self.assertEqual(data["runs"][0]["scenario"], (self.out / "scenario.toml").read_text())
        first = page.read_bytes()
        page.unlink()
        self.assertIn("report.html", self.report(self.out).stdout)
        self.assertEqual(page.read_bytes(), first)
        self.assertIn("default-src 'none'", first.decode(), "nothing may be fetched")

    def test_several_runs_want_a_file_and_keep_one_that_is_there(self):
        other = self.folder / "other"
        self.run_scenario(BLOCK, out=other)
        self.assertIn("--out is missing", self.report(self.out, other, status=2).stderr)
        both = self.folder / "both.html"
        self.report(self.out, other, "--out", both)
        self.assertEqual([run["name"] for run in self.data(both)["runs"]], ["out", "other"])
        self.assertIn("is there already", self.report(self.out, "--out", both, status=4).stderr)
        self.report(self.out, "--out", both, "--overwrite")
        self.assertEqual(len(self.data(both)["runs"]), 1)
        self.assertIn(".html", self.report(self.out, "--out", self.folder / "page.pdf", status=2).stderr)

    def test_an_unfinished_run_and_one_without_frames_have_a_page(self):
        (self.out / "summary.json").unlink()
        self.report(self.out)
        self.assertIsNone(self.data(self.out / "report.html")["runs"][0]["summary"])
        (self.out / "frames.pvd").unlink()
        self.report(self.out)
        self.assertEqual(self.data(self.out / "report.html")["runs"][0]["topologies"], [])

    def test_what_is_no_run_or_damaged_is_refused(self):
        empty = self.folder / "empty"
        empty.mkdir()
        self.assertIn("holds no results", self.report(empty, status=4).stderr)
        self.assertIn("no such directory", self.report(self.folder / "nowhere", status=4).stderr)
        damaged = self.folder / "damaged"
        shutil.copytree(self.out, damaged)
        frame = sorted((damaged / "frames").glob("*.vtu"))[-1]
        frame.write_bytes(frame.read_bytes()[:200])
        page = (damaged / "report.html").read_bytes()
        self.assertIn(frame.name, self.report(damaged, status=4).stderr)
        self.assertEqual((damaged / "report.html").read_bytes(), page)
        self.assert_messages(self.report(damaged, status=4))


if __name__ == "__main__":
    support.main()
