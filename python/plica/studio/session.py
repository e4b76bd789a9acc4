"""What the studio does: one draft, its runs, and acts on them. Kept in a folder, so that a killed server resumes it."""
from __future__ import annotations

import contextlib
import json
import math
import os
import re
import shutil
import threading
import tomllib
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, Optional

from .. import _core
from ..errors import PlicaError
from ..scenario import Scenario, _items, builtin_scenarios
from ..simulation import Simulation
from .acts import act, end_of_act, running_acts, time_of_act
from .draft import STARTS, Draft, Table, begun, defaults_of, differences, row_of, schema, text_of, typed
from .rest import Rest
from .run import StudioRun
from .tissues import ENDINGS, Candidate

FOLDER = ".plica-studio"
MOST_FILES, MOST_SEEN, MOST_FILE_BYTES, MOST_RUNS = 500, 20_000, 500_000_000, 100
MOST_NAMED = 2  # changes in the title of a run
NAME = re.compile(r"[A-Za-z0-9_-]{1,60}")


class Refused(Exception):
    """Order that cannot be carried out; the message names the reason and the remedy."""


class Session:
    """The studio's state and orders (methods `do_…`).

    Orders come one at a time; `told` is called after every change."""

    def __init__(self, folder: Path, told: Callable[[], None], threads: Optional[int] = None) -> None:
        self.folder, self.told, self.threads = folder.resolve(), told, threads
        self.home = self.folder / FOLDER
        self.home.mkdir(exist_ok=True)
        self.lock, self._saving, self._saved_over = threading.RLock(), threading.Lock(), set[int]()
        self.tables = schema()
        self.draft: Optional[Draft] = None
        self.runs: dict[int, StudioRun] = {}
        self.jobs: dict[str, str] = {}  # results that are being written: name, and what became of it
        self.revision = 0
        self.rest, self.candidate = Rest(told, 0), Candidate(told, self.home / "candidate")
        self._restore()

    # State, saved and shown

    def _save(self) -> None:
        with self._saving:
            self._write_state()

    def _write_state(self) -> None:
        known = list(self.runs.values())
        self._saved_over = {run.number for run in known if run.is_over}
        runs = [{"number": run.number, "title": run.title, "base": run.base, "parent": run.parent and run.parent.number,
                 "act_s": run.act_s, "status": run.status if run.is_over else "paused", "failure": run.failure,
                 "failed_cell": run.failed_cell} for run in known]
        text = json.dumps({"format": 1, "draft": self.draft and self.draft.state(), "runs": runs})
        part = self.home / "session.json.part"
        part.write_text(text)
        os.replace(part, self.home / "session.json")

    def _restore(self) -> None:
        with contextlib.suppress(FileNotFoundError):
            saved = json.loads((self.home / "session.json").read_text())
            self.draft = saved["draft"] and Draft.restored(saved["draft"])
            for row in saved["runs"]:
                directory = self._directory(row["number"])
                scenario = Scenario(tomllib.loads((directory / "scenario.toml").read_text()))
                run = StudioRun(row["number"], directory, scenario, self._run_told, base=row["base"],
                    title=row["title"],
                                parent=self.runs.get(row["parent"]), act_s=row["act_s"], threads=self.threads)
                run.status, run.failure, run.failed_cell = row["status"], row["failure"], row["failed_cell"]
                self.runs[run.number] = run
        if self.draft is not None:
            self._draft_changed(save=False)

    def _directory(self, number: int) -> Path:
        return self.home / f"run-{number:04d}"

    def _run_told(self) -> None:
        if {run.number for run in list(self.runs.values()) if run.is_over} != self._saved_over:
            self._save()
        self.told()

    def _draft_changed(self, save: bool = True) -> None:
        assert self.draft is not None
        self.revision += 1
        self.rest.build(partial(Scenario, self.draft.table))
        if save:
            self._save()
        self.told()

    def draft_state(self) -> Table:
        """Return what the page shows of the draft."""
        draft = self.draft
        state: Table = {"revision": self.revision, "folder": str(self.folder), "rest": self.rest.version,
                        "problem": self.rest.problem, "advice": self.rest.advice, "candidate": self.candidate.state()}
        if draft is not None:
            state |= {"table": draft.table, "base": draft.base, "base_table": draft.base_table, "text": draft.text(),
                      "defaults": defaults_of(draft.table),
                      "undo": draft.place > 0, "redo": draft.place < len(draft.history) - 1}
        return state

    def runs_state(self) -> Table:
        runs = [run.summary() for run in list(self.runs.values())]
        return {"runs": runs, "jobs": self.jobs}

    def close(self) -> None:
        self.rest.close()
        self.candidate.close()
        for run in self.runs.values():
            run.close()
        self._save()

    # Orders

    def order(self, name: str, given: Table) -> Table:
        """Carry out an order by name. Refused, ScenarioError, PlicaError, ValueError: it changed nothing."""
        method = getattr(self, f"do_{name}", None) if name.isidentifier() else None
        if method is None:
            raise Refused(f"{name[:60]}: unknown order; reload the page")
        with self.lock:
            return method(**given) or {}

    def _drafted(self) -> Draft:
        if self.draft is None:
            raise Refused("no scenario is open; open one")
        return self.draft

    def _run(self, number: Any) -> StudioRun:
        if number not in self.runs:
            raise Refused(f"run {number}: does not exist; choose another")
        return self.runs[number]

    def _inside(self, path: str) -> Path:
        """Return a path below the start folder. Links that lead out of it are refused."""
        full = (self.folder / path).resolve()
        if not full.is_relative_to(self.folder) or full.is_relative_to(self.home):
            raise Refused(f"{path}: lies outside {self.folder}; start plica studio in a folder above it")
        return full

    def do_gallery(self) -> Table:
        """List tissues to paint, built-in scenarios and the files of the folder that can be opened."""
        files, seen = [], 0
        for folder, inner, names in os.walk(self.folder):
            inner[:] = sorted(name for name in inner if not name.startswith("."))
            seen += len(names)
            for path in (Path(folder) / name for name in names):
                if path.suffix.lower() in (".toml", *ENDINGS) and path.is_file() and not path.name.startswith("."):
                    files.append((path.stat().st_mtime, str(path.relative_to(self.folder))))
            if seen > MOST_SEEN:
                break
        recent = [name for _, name in sorted(files, reverse=True)[:MOST_FILES]]
        titles = {name: table["title"] for name, table in STARTS.items()}
        return {"scenarios": titles | builtin_scenarios(), "files": recent, "folder": str(self.folder)}

    def do_open(self, source: str) -> Table:
        """Open a built-in scenario, or a scenario or tissue file of the folder."""
        if source in _core.scenarios or source in STARTS:
            self.open(Draft.of(source))
            return {}
        path = self._file(source)
        if path.suffix != ".toml":
            raise Refused(f"{source}: not a scenario; open a .toml file")
        draft = Draft.of(path)
        self._typed({key: value for key, value in draft.table.items() if key != "format"})
        self.open(draft)
        return {}

    def _file(self, source: str) -> Path:
        path = self._inside(source)
        if not path.is_file():
            raise Refused(f"{source}: not a file of this folder; choose one of the list")
        if path.stat().st_size > MOST_FILE_BYTES:
            raise Refused(f"{source}: is larger than {MOST_FILE_BYTES // 10**6} MB; use plica run")
        return path

    def do_look_at(self, source: str, options: Optional[Table] = None) -> Table:
        """Read a tissue file of the folder, to be shown with remarks before it is used."""
        path = self._file(source)
        if path.suffix.lower() not in ENDINGS:
            raise Refused(f"{source}: not a tissue; choose a file that ends in {', '.join(ENDINGS)}")
        self.candidate.look_at(path, source, options or {})
        self.told()
        return {}

    def do_use(self) -> Table:
        """Begin a scenario with the tissue that is shown."""
        self.open(self.candidate.draft())
        return {}

    def open(self, draft: Draft) -> None:
        if self.draft is not None:
            earlier = self.draft
            earlier.go_to(draft.table)
            draft.history, draft.place = earlier.history, earlier.place
        self.draft = draft
        self._draft_changed()

    def _typed(self, changes: Table) -> Table:
        """Convert texts of fields to values. Files are those of the folder."""
        values = {}
        for key, value in changes.items():
            row = row_of(key, self.tables)
            if key in ("base", "format"):
                raise Refused(f"{key}: cannot be changed; open another scenario")
            values[key] = typed(value, row.get("type", ""))
        for key, value in _items(values):
            if row_of(key, self.tables).get("is_path") and isinstance(value, str):
                self._inside(value)
        return values

    def do_check(self, changes: Table) -> Table:
        """Check changes without making them."""
        self._drafted().with_changes(self._typed(changes))
        return {}

    def do_set(self, changes: Table, drag: str = "") -> Table:
        self._drafted().set(self._typed(changes), str(drag))
        self._draft_changed()
        return {"revision": self.revision}

    def do_add(self, kind: str, name: str, region: str) -> Table:
        """Add a table of a kind, "cortex" say, that acts in a region."""
        if not NAME.fullmatch(name):
            raise Refused(f"{name[:60] or 'name'}: not a valid name of a table; use letters, digits, _ and -")
        draft = self._drafted()
        if name in draft.table.get(kind, {}):
            raise Refused(f"{kind}.{name}: exists; give another name")
        draft.set({f"{kind}.{name}": begun(kind, region, draft.table, self.tables)})
        self._draft_changed()
        return {"revision": self.revision}

    def do_paint(self, region: str, ids: list[int]) -> Table:
        """Make a region the given cells, whatever selected them before."""
        if not NAME.fullmatch(region) or region == "all":
            raise Refused(f"{region[:60]}: not a valid name of a region; use letters, digits, _ and -")
        ids = sorted({int(cell) for cell in ids})
        self._drafted().set({f"region.{region}": {"ids": ids} if ids else None})
        self._draft_changed()
        return {"revision": self.revision}

    def do_undo(self) -> Table:
        self._drafted().undo()
        self._draft_changed()
        return {}

    def do_redo(self) -> Table:
        self._drafted().redo()
        self._draft_changed()
        return {}

    def _new_run(self, table: Table, base: str, title: str, parent: Optional[StudioRun], act_s: float) -> StudioRun:
        if len(self.runs) >= MOST_RUNS:
            raise Refused(f"{MOST_RUNS} runs are kept; remove some")
        number = max(self.runs, default=0) + 1
        directory = self._directory(number)
        shutil.rmtree(directory, ignore_errors=True)
        directory.mkdir()
        scenario = Scenario(table)
        (directory / "scenario.toml").write_text(scenario.to_toml())
        run = StudioRun(number, directory, scenario, self._run_told, base=base, title=title, parent=parent, act_s=act_s,
                        threads=self.threads)
        self.runs[number] = run
        self._save()
        return run

    def do_start(self, until_s: Optional[float] = None) -> Table:
        """Run the draft from rest."""
        draft = self._drafted()
        run = self._new_run(draft.table, draft.base, self._title(draft), None, 0.0)
        run.go(math.inf if until_s is None else float(until_s))
        self.told()
        return {"run": run.number}

    def _title(self, draft: Draft) -> str:
        """Return the scenario's title or, where a run of nearly the same scenario exists, what is different from it."""
        for run in reversed(self.runs.values()):
            earlier = run.scenario.to_dict()
            values = differences(draft.table, earlier)
            changes = [*values, *(key for key in differences(earlier, draft.table) if key not in values)]
            if not changes:
                return f"run {run.number} again"
            if len(changes) <= MOST_NAMED:
                return f"run {run.number} with " + ", ".join(_change(key, values.get(key)) for key in changes)
        return str(draft.table.get("title") or "scenario")

    def do_go(self, run: int, until_s: Optional[float] = None) -> Table:
        self._run(run).go(math.inf if until_s is None else float(until_s))
        return {}

    def do_step(self, run: int) -> Table:
        self._run(run).step()
        return {}

    def do_pause(self, run: int) -> Table:
        self._run(run).pause()
        return {}

    def do_remove(self, run: int) -> Table:
        """Delete a run that no other continues."""
        gone = self._run(run)
        if any(other.parent is gone for other in self.runs.values()):
            raise Refused(f"run {run}: another run continues it; remove that one first")
        gone.close()
        del self.runs[run]
        shutil.rmtree(gone.directory, ignore_errors=True)
        self._save()
        self.told()
        return {}

    def do_act(self, run: int, at_s: float, kind: str, cells: list[int], strength: float = 0.0,
        name: str = "") -> Table:
        """Act on cells of a run at a time: another run, which continues the first from there on."""
        before = self._run(run)
        at_s, table = time_of_act(float(at_s)), before.scenario.to_dict()
        if kind == "end":
            changes, title = end_of_act(name, table, at_s)
        else:
            # A scenario names cells of the tissue at rest: an act on a daughter is one on all daughters of that cell.
            founders, named = before.founders(), {int(cell) for cell in cells}
            chosen = sorted({founders.get(cell, cell) for cell in named})
            if not chosen:
                raise Refused("no cells are selected; select some with the brush or the lasso")
            changes, title = act(kind, table, chosen, at_s, float(strength))
            if named & founders.keys():
                title += " with all their daughters"
        draft = Draft(table, before.base)
        draft.set(changes)
        before.pause()
        made = self._new_run(draft.table, before.base, f"{title} at {_clock(at_s)}", before, at_s)
        if self.draft is not None:
            self.draft.go_to(draft.table)
            self._draft_changed()
        made.go(at_s)
        self.told()
        return {"run": made.number}

    def do_results(self, run: int, name: str) -> Table:
        """Write the results directory of a run's scenario, from rest, and compare its end with what was shown."""
        if not NAME.fullmatch(name):
            raise Refused(f"{name[:60]}: not a valid name of a directory; use letters, digits, _ and -")
        shown, out = self._run(run), self._inside(name)
        if out.exists():
            raise Refused(f"{name}: exists; give another name")
        self.jobs[name] = "being written"
        threading.Thread(target=self._write_results, args=(shown, name, out), daemon=True).start()
        return {}

    def _write_results(self, shown: StudioRun, name: str, out: Path) -> None:
        try:
            sim = Simulation(shown.scenario, threads=self.threads)
            last_s = shown.time_s
            sim.run(out=out, callback=lambda sim, _: sim.time_s >= last_s)
            frames = shown.file.frames
            same = bool(frames) and frames[-1].time_s == sim.time_s and \
                (shown.file.positions(len(frames) - 1) == sim.positions.astype("f4").ravel()).all()
            self.jobs[name] = f"written up to {_clock(sim.time_s)}; " + (
                "the same positions as shown" if same else "differs from what was shown; report this as a bug")
        except (PlicaError, ValueError, OSError) as error:
            self.jobs[name] = f"failed: {error}"
        self.told()

    # What is taken away as a file

    def scenario_text(self, number: int) -> str:
        """Return the scenario of a run, or of the draft (0), as TOML."""
        if number == 0:
            return self._drafted().text()
        run = self._run(number)
        table = run.scenario.to_dict()
        return text_of(table, run.base)

    def script_text(self, number: int) -> str:
        """Return a Python script that does the same."""
        text = self.scenario_text(number).replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
        return f'import plica\n\nscenario = plica.Scenario("""\n{text}""")\n' \
               'run = plica.Simulation(scenario).run(out="results", overwrite=True, progress=True)\n' \
               'print(run.summary)\n'

    def frame_messages(self, want: Table) -> list[bytes]:
        """Return what a page lacks of a run, or of the tissue at rest (0)."""
        number = want["run"]
        for still in (self.rest, self.candidate):
            if number == still.number:
                return still.frame_message(want)
        return self.runs[number].frame_message(want) if number in self.runs else []


def _change(key: str, value: Any) -> str:
    if value is None:
        return f"no {key}"
    return f"other {key}" if isinstance(value, list) else f"{key} = {value}"


def _clock(time_s: float) -> str:
    return f"{time_s:g} s" if time_s < 120 else f"{time_s / 60:.4g} min"
