#!/usr/bin/python3
"""Breaks pages one by one and sees that the runner of pages notices. Needs no plica."""
import contextlib
import io
import tempfile
import unittest
from pathlib import Path

from page import PageError, mark_of_run, run_page, scenario_sections, stated_numbers


class Runner(unittest.TestCase):
    def run_text(self, text, with_slow=False):
        """How many blocks ran."""
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            page = Path(folder) / "page.md"
            page.write_text(text, encoding="utf-8")
            return run_page(page, Path("/bin/true"), Path(folder) / "reader", with_slow)

    def refused(self, text, **options):
        with self.assertRaises(PageError):
            self.run_text(text, **options)

    def test_runs_in_one_shell_with_files(self):
        self.assertEqual(self.run_text("```sh\na=b\n```\n\n```toml\n# x.toml\nkey = 1\n```\n```sh\ntest $a = b\n"
                                       "grep key x.toml\n```\n```python\nopen('x.toml')\n```\n"), 3)

    def test_commands_that_fail(self):
        self.refused("```sh\nfalse\ntrue\n```\n")
        self.refused("```sh\nfalse | cat\n```\n")
        self.refused("```sh\ntrue\n```\n```python\nraise SystemExit(1)\n```\n")

    def test_output(self):
        for shown in ("depth 28.9 um", "…epth 28.8 …", "...\ndepth 28.9 um\n..."):
            self.run_text(f"```sh\necho first\necho 'depth  28.903 um'\n```\n```text\n{shown}\n```\n")
        for shown in ("depth 28.5 um", "depth -28.9 um", "width 28.9 um", "depth 28.9 um\nfirst"):
            self.refused(f"```sh\necho first\necho 'depth 28.903 um'\n```\n```text\n{shown}\n```\n")
        self.refused("```sh\necho a\n```\n```toml output\nb = 1\n```\n")

    def test_stated_numbers(self):
        self.assertEqual(stated_numbers("| depth | 28.9 µm | `depth_um` |\n| end | 1.5 min | `time_s` |\n| part | 0.74 to 0.78 | `ratio` |\n"
                                        "| rows | 3 | in `words` |\n"),
                         {"depth_um": (28.9, 28.9), "time_s": (90, 90), "ratio": (0.74, 0.78)})

    def test_sections_of_scenarios(self):
        text = ("# `a`: first\n```sh\nplica run a --out results/a\n```\n## Results\n| x | 1 | `x` |\n## `a-b`\n<!-- slow: long -->\n"
                "```sh\nplica run a-b --out results/a-b\n```\n### Results\n| x | 2 | `x` |\n")
        sections = scenario_sections(text)
        self.assertEqual(list(sections), ["a", "a-b"])
        self.assertEqual([stated_numbers(section)["x"][0] for section in sections.values()], [1, 2])
        self.assertEqual([mark_of_run(name, section) for name, section in sections.items()], ["", "slow"])
        with self.assertRaises(PageError):
            mark_of_run("a", sections["a-b"])

    def test_marks(self):
        self.assertEqual(self.run_text("<!-- not run: it fails -->\n```sh\nfalse\n```\n```text\nx\n```\n"), 0)
        self.assertEqual(self.run_text("<!-- slow: an hour -->\n```sh\nfalse\n```\n"), 0)
        self.refused("<!-- slow: an hour -->\n```sh\nfalse\n```\n", with_slow=True)
        self.assertEqual(self.run_text("<!-- run first: echo 1 > made -->\n```sh\ngrep 1 made\n```\n"), 2)

    def test_blocks_that_nobody_would_run(self):
        self.refused("```\nwhat is this\n```\n")
        self.refused("```bash\ntrue\n```\n")
        self.refused("```sh\ntrue\n")
        self.refused("```toml\nkey = \n```\n")


if __name__ == "__main__":
    unittest.main()
