"""Contents of a parameter study: its keys, its runs, and their table."""
from __future__ import annotations

import io
import json
import os
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

from . import _core
from .arguments import path_of, text_of
from .errors import FileError, needed
from .results import _pandas
from .scenario import GIVEN, _items, _toml_of
from .study_workers import Spec

if TYPE_CHECKING:
    import pandas


class StudyTable:
    """Study as its evaluations need it: keys, runs and table; `Study` runs it."""

    def __init__(self, source: Union[str, os.PathLike[str], Mapping[str, Any]]) -> None:
        if isinstance(source, Mapping):
            name, file, text = "study", GIVEN, _toml_of(source)
        elif isinstance(source, str) and "\n" in source:
            name, file, text = "study", GIVEN, text_of(source, "source")
        else:
            path = Path(path_of(source, "source"))
            name, file, text = path.stem, str(path), "" if path.is_dir() else _text_of(path)
        self._rows: dict[int, str] = {}
        self._directory: Optional[Path] = None
        if text:
            self._core = _core.Study(name, file, text)
        else:
            self._directory = path
            begun = json.loads(_text_of(path / "study.json"))
            name, file, text = begun["name"], begun["file"], _text_of(path / "study.toml")
            directory, self._core = _core.StudyDirectory.open(str(path))
            self._rows = dict(directory.rows)
        self._spec = Spec(name, file, text, self._core.points_csv, tuple(self._core.measures), "")

    @property
    def kind(self) -> str:
        """Kind of the design, such as "grid" or "sobol"."""
        return str(self._given["design.kind"])

    @property
    def _given(self) -> dict[str, Any]:
        """Contents of the study file, by dotted keys."""
        return dict(_items(tomllib.loads(self._spec.text)))

    def _run_directory(self, run: int) -> Path:
        """Return the directory of the kept files of a run, counted from 0."""
        return Path(self._directory or ".") / "points" / self._core.name_of(run)

    @property
    def keys(self) -> list[str]:
        """Keys that vary."""
        return self._core.keys

    @property
    def measures(self) -> list[str]:
        """Output variables in the table."""
        return self._core.measures

    @property
    def points(self) -> pandas.DataFrame:
        """Runs in order: point, replicate, and values of the keys."""
        table = self.table
        return table[["point", "replicate", *self.keys]]

    @property
    def table(self) -> pandas.DataFrame:
        """Results, one row per run: point, keys, replicate, status, output variables, steps, wall_s, reason.

        Runs that have not been made have status ``not_run``.
        """
        rows = [self._rows.get(run) or self._core.not_run(run) for run in range(len(self))]
        text = io.StringIO("\n".join([self._core.header, *rows]))
        table: pandas.DataFrame = _pandas("the table of a study").read_csv(text, float_precision="round_trip")
        return table

    def to_xarray(self) -> Any:
        """Return output variables over the keys: one dimension per key for a grid, else over points.

        Returns
        -------
        xarray.Dataset
        """
        needed("xarray", "a study as an xarray")
        table = self.table
        replicates = ["replicate"] if table.replicate.nunique() > 1 else []
        dimensions = [key for key in self.keys if table[key].nunique() > 1] + replicates
        is_grid = not table.duplicated(dimensions).any() and len(table) == table[dimensions].nunique().prod()
        index = dimensions if is_grid and dimensions else ["point", *replicates]
        kept = [*([] if is_grid else self.keys), "status", *self.measures, "steps"]
        return table.set_index(index)[kept].to_xarray()

    def __len__(self) -> int:
        return self._core.runs


def _text_of(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"{path}: cannot be read: {error}") from error
