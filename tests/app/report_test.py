"""`plica report` from outside: what it writes, what it refuses. The page itself is tested in a browser (viewer/tests)."""
import base64
import csv
import json
import re
import shutil
import zlib

import support
from support import BLOCK, CommandLine, page_data, table


class Reports(CommandLine):
    def report(self, *arguments, **options):
        return self.call("report", *arguments, **options)


class Report(Reports):
    def setUp(self):
        super().setUp()
        self.run_scenario(BLOCK)

    def test_a_run_leaves_its_page_and_report_makes_it_anew(self):
        page = self.out / "report.html"
        data = page_data(page)
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
        self.assertIn("--out: missing", self.report(self.out, other, status=2).stderr)
        both = self.folder / "both.html"
        self.report(self.out, other, "--out", both)
        self.assertEqual([run["name"] for run in page_data(both)["runs"]], ["out", "other"])
        self.assertIn("already exists", self.report(self.out, "--out", both, status=4).stderr)
        self.report(self.out, "--out", both, "--overwrite")
        self.assertEqual(len(page_data(both)["runs"]), 1)
        self.assertIn(".html", self.report(self.out, "--out", self.folder / "page.pdf", status=2).stderr)

    def test_an_unfinished_run_and_one_without_frames_have_a_page(self):
        (self.out / "summary.json").unlink()
        self.report(self.out)
        self.assertIsNone(page_data(self.out / "report.html")["runs"][0]["summary"])
        (self.out / "frames.pvd").unlink()
        self.report(self.out)
        self.assertEqual(page_data(self.out / "report.html")["runs"][0]["topologies"], [])

    def test_what_is_no_run_or_damaged_is_refused(self):
        empty = self.folder / "empty"
        empty.mkdir()
        self.assertIn("contains no results", self.report(empty, status=4).stderr)
        self.assertIn("directory does not exist", self.report(self.folder / "nowhere", status=4).stderr)
        damaged = self.folder / "damaged"
        shutil.copytree(self.out, damaged)
        frame = sorted((damaged / "frames").glob("*.vtu"))[-1]
        frame.write_bytes(frame.read_bytes()[:200])
        page = (damaged / "report.html").read_bytes()
        self.assertIn(frame.name, self.report(damaged, status=4).stderr)
        self.assertEqual((damaged / "report.html").read_bytes(), page)
        self.assert_messages(self.report(damaged, status=4))


STUDY = """\
format = 1
scenario = "drosophila"
[set]
"time.end_min" = 0.05
[vary]
"time.first_step_s" = { values = [5, 2] }
"time.max_step_s" = { values = [4, 10] }
"contraction.apical.region" = { values = ["furrow", "all"] }
[design]
kind = "grid"
[keep]
measures = ["furrow_depth_um", "lips_closed_time_s"]
each = "summary"
"""


class StudyReport(Reports):
    """The page of a study: its tables, and the columns that the page makes of them."""

    def setUp(self):
        super().setUp()
        result = self.call("study", self.write(STUDY), "--out", self.out, "--jobs", 1)
        self.assertIn("out/report.html", result.stdout)

    def columns(self, page=None):
        text = (page or self.out / "report.html").read_text()
        data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)[1])
        points, rows, kept = (list(csv.reader(zlib.decompress(base64.b64decode(
            re.search(f'id="{table}">(.*?)</script>', text, re.S)[1])).decode().splitlines())) for table in ("points", "rows", "kept"))
        heads = ["point", *points[0][3:-1], "replicate", "status", *data["measures"], "steps", "wall_s", "reason"]
        whole = [row if len(row) == len(heads) else [""] * len(heads) for row in rows]
        columns = {name: [row[at] for row in whole] for at, name in enumerate(heads)}
        columns["status"] = [status or "not_run" for status in columns["status"]]
        columns["kept"] = [row[0] if row else "" for row in kept]
        self.assertEqual([len(points) - 1, len(kept)], [data["runs"]] * 2)
        return data, columns

    def test_the_page_holds_the_rows(self):
        data, columns = self.columns()
        self.assertEqual((data["design"], data["scenario_argument"], data["set"], data["runs"]), ("grid", "drosophila", ["time.end_min=0.05"], 8))
        rows, compared = table(self.out / "runs.csv"), 0
        for name in rows[0]:
            for row, value in zip(rows, columns[name]):
                self.assertEqual(value, row[name], name)
                compared += 1
        self.assertEqual(compared, 8 * 11)
        self.assertEqual(columns["status"], ["refused"] * 2 + ["end_time"] * 6, "a first step longer than the longest")
        self.assertEqual(columns["kept"], [""] * 2 + [f"{n:06}/summary.json" for n in range(3, 9)])
        self.assertIn("default-src 'none'", (self.out / "report.html").read_text(), "nothing may be fetched")

    def test_report_makes_it_anew_also_of_a_part(self):
        page = self.out / "report.html"
        first = page.read_bytes()
        page.unlink()
        self.report(self.out)
        self.assertEqual(page.read_bytes(), first)
        # Rows only, one of them half written; then the table only, in a directory that was moved.
        (self.out / "runs.csv").rename(self.folder / "runs.csv")
        rows = next((self.out / "rows").iterdir())
        text = rows.read_text()
        rows.write_text("".join(text.splitlines(keepends=True)[:3]) + "5,")
        self.report(self.out)
        statuses = self.columns()[1]["status"]
        self.assertEqual((len(statuses), statuses.count("not_run")), (8, 5))
        shutil.rmtree(self.out / "rows")
        (self.folder / "runs.csv").rename(self.out / "runs.csv")
        self.out.rename(self.folder / "moved")
        self.report(self.folder / "moved")
        self.assertEqual((self.folder / "moved/report.html").read_bytes(), first)

    def test_another_version_and_a_lost_scenario_have_a_page(self):
        begun = self.out / "study.json"
        begun.write_text(begun.read_text().replace('"plica": "', '"plica": "9.'))
        study = self.out / "study.toml"
        study.write_text(study.read_text().replace('"drosophila"', '"lost.toml"'))
        self.report(self.out)
        data, columns = self.columns()
        self.assertEqual((data["design"], data["scenario_argument"]), ("", str(self.out.resolve() / "scenario.toml")))
        self.assertEqual(columns["status"].count("end_time"), 6)

    def test_what_is_refused(self):
        self.assertIn("has its own page", self.report(self.out, self.out, "--out", self.folder / "two.html", status=2).stderr)
        elsewhere = self.folder / "elsewhere.html"
        self.report(self.out, "--out", elsewhere)
        self.assertEqual(self.columns(elsewhere)[0]["points"], "out/points")
        self.assertIn("already exists", self.report(self.out, "--out", elsewhere, status=4).stderr)
        page = (self.out / "report.html").read_bytes()
        for file, content in (("points.csv", "run,point\n"), ("study.json", "{")):
            (self.out / file).write_text(content)
            self.assert_messages(self.report(self.out, status=4))
        self.assertEqual((self.out / "report.html").read_bytes(), page)


if __name__ == "__main__":
    support.main()
