"""The paper's reproduction: `plica reproduce paper`, its verdicts as published, and what the page of docs says of them."""
import re
import tomllib
from collections import Counter
from pathlib import Path

import support
from support import CommandLine, table

ROOT = Path(__file__).resolve().parents[2]


class Reproduce(CommandLine):
    def published(self):
        return table(ROOT / "docs/science/reproduction.csv")

    def test_pages_count_the_claims_of_the_file(self):
        experiments = tomllib.loads((ROOT / "scenarios/paper/experiments.toml").read_text())["experiment"]
        claims = [outcome for experiment in experiments.values() for outcome in experiment["outcome"].values()]
        verdicts = Counter(row["verdict"] for row in self.published())
        self.assertEqual(sorted(row["claim"] for row in self.published()), sorted(claim["question"] for claim in claims))
        counts = [len(claims), *(verdicts[verdict] for verdict in ("reproduced", "under this reading", "not reproduced"))]
        for page, text in (("science/reproduction.md", "Of {} claims, {} are reproduced, {} under this reading, and {} are not."),
                           ("science/README.md", "of {}, {} hold, {} under one reading, {} do not"),
                           ("developers/verification.md", "{} claims of Demongeot et al. (2016) | {} hold, {} under one reading, {} do not")):
            self.assertIn(text.format(*counts), (ROOT / "docs" / page).read_text())

    def test_a_quick_reproduction_has_the_published_numbers(self):
        result = self.call("reproduce", "--out", self.out, "--quick", timeout=280)
        rows = {(row["experiment"], row["outcome"]): row for row in table(self.out / "outcomes.csv")}
        published = {(row["experiment"], row["outcome"]): row for row in self.published()}
        self.assertEqual(rows.keys(), published.keys())
        for name, row in rows.items():
            before = published[name]
            support.count_case()
            # The other readings are not run.
            weaker = {before["verdict"], "under this reading" if before["verdict"] == "reproduced" else before["verdict"]}
            self.assertIn(row["verdict"], weaker, name)
            if row["verdict"] == "not reproduced":
                self.assertTrue(row["because"], f"no cause: {name}")
            if abs(float(before["ours"] or 0)) > 1e-4:  # else rounding
                self.assertAlmostEqual(float(row["number"]) / float(before["ours"]), 1, delta=2e-3, msg=name)
        self.assertRegex(result.stdout, r"not reproduced +pill-fixed, nodes +1516  nodes, 2268 to 2268\n")
        self.assertRegex(result.stdout, rf"paper: {len(rows)} outcomes: \d+ not reproduced, \d+ reproduced, \d+ under this reading\n  .*report.html")
        page = (self.out / "report.html").read_text()
        self.assertIn("<title>Reproduction of the paper</title>", page)
        self.assertIsNone(re.search(r'"outcomes": ?null', page))


if __name__ == "__main__":
    support.main()
