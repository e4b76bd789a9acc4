"""plica.reproduce: the command's table, and its errors."""
from __future__ import annotations

import os
from pathlib import Path

import pytest

import plica

EXPERIMENTS = """\
scenario = "division-demo"
draws = "draws.csv"
[experiment.reference]
question = "How many cells are there at last?"
role = "fitted"
[experiment.reference.outcome.cells]
quantity = "cells"
hit = [4, 4]
[experiment.short]
question = "How many are there before the division?"
prediction = "hit"
set = { "time.end_s" = 30 }
[experiment.short.outcome.cells]
quantity = "cells"
minus = "reference"
hit = [-1, -1]
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "draws.csv").write_text("elasticity.young_modulus_Pa\n500\n1000\n")
    path = tmp_path / "mine.toml"
    path.write_text(EXPERIMENTS)
    return path


def test_the_table(file: Path, tmp_path: Path) -> None:
    quick = plica.reproduce(file, tmp_path / "out", quick=True)
    assert list(quick.draw) == [1, 1]
    table = plica.reproduce(file, tmp_path / "out", jobs=2)
    assert list(table.experiment) == ["reference", "reference", "short", "short"]
    assert list(table.number) == [4, 4, -1, -1]
    assert set(table.judgement) == {"hit"}
    assert (tmp_path / "out/report.html").exists()


def test_errors(file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ValueError, match="not a file or built-in experiments"):
        plica.reproduce("livign", tmp_path / "out")
    file.write_text(EXPERIMENTS.replace("hit = [4, 4]", "hit = 4"))
    with pytest.raises(ValueError, match=r"mine.toml:8: experiment.reference.outcome.cells.hit: is not a pair"):
        plica.reproduce(file, tmp_path / "out")
    (tmp_path / "wrong").write_text("#!/bin/sh\necho plica 0.0.1\n")
    (tmp_path / "wrong").chmod(0o755)
    for program, words in (("/nonexistent", "cannot be run"), (os.fspath(tmp_path / "wrong"), "is plica 0.0.1, but the package is")):
        monkeypatch.setenv("PLICA", program)
        with pytest.raises(plica.FileError, match=words):
            plica.reproduce(file, tmp_path / "out")
