"""A run of the studio: a recorded `plica run` in a thread of its own, whose frames and states are kept.

What is shown is always the run of a scenario file. An act during a run makes another scenario, which differs from a
time on; its run continues from a state that both share. Steps never end where the user pauses, so a run is bitwise
identical to one from the command line."""
from __future__ import annotations

import csv
import math
import os
import shutil
import threading
from collections.abc import Callable
from pathlib import Path
from time import monotonic
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from ..errors import FileError, NumericsError, PlicaError
from ..scenario import Scenario
from ..simulation import Simulation
from .acts import running_acts
from .frames import Frame, FrameFile
from .messages import packed
from .shapes import ends_of_colours, shape_message, values_now

FRAME_APART_S = 0.04  # of wall time, between frames that are kept beside those of the scenario
MOST_KEPT = 64
INSTANT_S = 1e-6


class StudioRun:
    """Run in a directory of the session. `parent` and `from_s`: the run and the time of the state that it continues."""

    def __init__(self, number: int, directory: Path, scenario: Scenario, told: Callable[[], None], *, base: str = "",
                 title: str = "", parent: Optional[StudioRun] = None, act_s: float = 0.0,
                 threads: Optional[int] = None) -> None:
        self.number, self.directory, self.scenario, self.base, self.title = number, directory, scenario, base, title
        self.parent, self.act_s, self.threads = parent, act_s, threads
        self.results, self.kept = directory / "results", directory / "kept"
        self.kept.mkdir(parents=True, exist_ok=True)
        self.file = FrameFile(directory / "frames.bin")
        self.shapes = sorted(directory.glob("shape-*.bin"))
        self.columns: list[str] = []
        self.rows: list[list[Optional[float]]] = []
        self.notes: list[str] = []
        self.status, self.failure = "paused", ""
        self.failed_cell: Optional[int] = None
        self.from_s = 0.0
        self.end_s = float(scenario["time.end_s"])
        self.lasting = running_acts(scenario.to_dict(), math.inf)
        self._told, self._goal_s, self._steps_left = told, -math.inf, 0
        self._order = threading.Condition()
        self._thread: Optional[threading.Thread] = None
        self._closing = False
        self._hexahedra: Optional[NDArray[np.int32]] = None  # of the last shape
        self._shown_at, self._checkpoint = -math.inf, (0, 0)
        self._read_rows()

    # Orders, from any thread

    def go(self, until_s: float = math.inf) -> None:
        """Run to the first step at or after a time."""
        self._give(until_s, 0)

    def step(self) -> None:
        self._give(-math.inf, 1)

    def pause(self) -> None:
        self._give(-math.inf, 0)

    def _give(self, goal_s: float, steps: int) -> None:
        with self._order:
            self._goal_s, self._steps_left = goal_s, steps
            if not self.is_over and not self._closing and self._thread is None and (goal_s > -math.inf or steps):
                self.status = "running"
                self._thread = threading.Thread(target=self._work, name=f"plica studio run {self.number}", daemon=True)
                self._thread.start()
            self._order.notify()

    def close(self) -> None:
        """End the thread after the step under way; the run can be resumed."""
        with self._order:
            self._closing = True
            self._order.notify()
            thread = self._thread
        if thread is not None:
            thread.join()

    @property
    def is_over(self) -> bool:
        return self.status in ("equilibrium", "end_time", "failed")

    @property
    def time_s(self) -> float:
        return float(self.rows[-1][0] or 0.0) if self.rows else self.from_s

    def summary(self) -> dict[str, Any]:
        return {"number": self.number, "title": self.title, "status": self.status, "time_s": self.time_s,
                "end_s": self.end_s, "steps": len(self.rows) - 1 if self.rows else 0,
                "failure": self.failure, "failed_cell": self.failed_cell,
                "parent": self.parent and self.parent.number, "act_s": self.act_s, "from_s": self.from_s,
                "notes": self.notes, "running": self.status == "running", "lasting": self.lasting}

    # The thread

    def _work(self) -> None:
        try:
            sim = self._begin()
            self._show(sim, force=True)
            self._loop(sim)
        except (PlicaError, ValueError, OSError, MemoryError) as error:
            self._end("failed", str(error) or type(error).__name__, getattr(error, "cell", None))
        finally:
            with self._order:
                self._thread = None

    def _loop(self, sim: Simulation) -> None:
        while not sim.finished:
            with self._order:
                while not self._closing and self._steps_left == 0 and self._goal_s <= self.time_s:
                    if self.status != "paused":
                        self._show(sim, force=True)
                        self.status = "paused"  # from now on, the last frame is that of the last step
                        self._told()
                    self._order.wait()
                if self._closing:
                    return
                self._steps_left = max(self._steps_left - 1, 0)
            if self.status != "running":
                self.status = "running"
                self._told()
            try:
                self._take_step(sim)
            except NumericsError as error:
                self._show(sim, force=True)
                sim._core.end_record()
                return self._end("failed", error.reason, error.cell)
        self._show(sim, force=True)
        if sim._core.is_recording:
            sim._core.end_record()
        self._end(sim.status, "", None)

    def _end(self, status: str, failure: str, cell: Optional[int]) -> None:
        self.status, self.failure, self.failed_cell = status, failure, cell
        self._told()

    def _take_step(self, sim: Simulation) -> None:
        if not sim._core.step(math.inf):
            return
        self.rows.append(self._row(sim))
        texts = [*sim._core.warnings]
        if (sim.measures.get("self_intersections") or 0) > 0:
            texts.append(sim._core.crossing_warning)
        self.notes += [text for text in texts if text not in self.notes]
        self._show(sim)

    def _row(self, sim: Simulation) -> list[Optional[float]]:
        measures = sim.measures
        self.columns = self.columns or list(measures)
        return [sim.time_s, *(measures[name] for name in self.columns[1:])]

    # Beginning: at rest, from the run's own checkpoint, or from a state of its parent

    def _begin(self) -> Simulation:
        has_begun = (self.results / "checkpoint.h5").exists()
        sim = None if has_begun else self._continued()
        if sim is None:
            sim = Simulation(self.scenario, threads=self.threads)
        if not has_begun:
            self.from_s = sim.time_s
            self._take_over_rows()
        self.notes += sim._core.begin_record(str(self.results), "resume" if has_begun else "overwrite")
        if not sim._core.is_recording:  # it ended, but the server was killed before it could note this
            sim = self._loaded(self.results / "checkpoint.h5")
        self.file.forget_after(sim.time_s)
        self.rows = [row for row in self.rows if (row[0] or 0.0) <= sim.time_s + INSTANT_S]
        if not self.rows:
            self.rows.append(self._row(sim))
        return sim

    def _continued(self) -> Optional[Simulation]:
        """Continue the newest kept state from which this and its parent's scenario take equal steps; None: from rest.

        Before the last snapshot at or before the act, steps end on the same times in both scenarios. A record begins
        before the first division."""
        every_s = float(self.scenario["output.frame_every_s"])
        shared_s, run, origin = math.inf, self, self.parent
        while origin is not None:
            # A state of an earlier run also has to come before the act that parted the two.
            shared_s = min(shared_s, math.floor(run.act_s / every_s + INSTANT_S) * every_s if every_s > 0 else 0.0,
                           *(float(row["birth_s"]) for row in origin._births()))
            for bound_s, path in reversed(origin.kept_states()):
                if bound_s > shared_s + 4 * every_s:  # certainly too late
                    continue
                try:
                    sim = self._loaded(path)
                except FileError:
                    return None  # another law, say: its memory does not fit
                if sim.time_s <= shared_s + INSTANT_S and not sim._core.divisions:
                    return sim
            run, origin = origin, origin.parent
        return None

    def _loaded(self, checkpoint: Path) -> Simulation:
        """Return this scenario's simulation in the state of a checkpoint, which may be of another scenario."""
        sim = object.__new__(Simulation)
        sim._resume(self.scenario, self.threads or 0, checkpoint.read_bytes())
        return sim

    def _take_over_rows(self) -> None:
        if self.parent is not None and not self.rows and self.from_s > 0:
            self.columns = self.parent.columns
            self.rows = [row for row in self.parent.rows if (row[0] or 0.0) <= self.from_s + INSTANT_S]

    def _read_rows(self) -> None:
        """Read what an earlier server has recorded."""
        file = self.results / "series.csv"
        if not file.exists():
            return
        with file.open(newline="") as lines:
            table = list(csv.reader(lines))
        self.columns = table[0]
        own = [[float(text) if text else None for text in row] for row in table[1:] if len(row) == len(self.columns)]
        self.from_s = own[0][0] or 0.0 if own else 0.0
        if self.parent is not None:
            self.rows = [row for row in self.parent.rows if (row[0] or 0.0) < self.from_s - INSTANT_S]
        self.rows += own

    def _births(self) -> list[dict[str, str]]:
        """Return the rows of lineage.csv: this run's divisions after those of its parent."""
        file = self.results / "lineage.csv"
        before = self.parent._births() if self.parent is not None else []
        if not file.exists():
            return before
        with file.open(newline="") as lines:
            return before + list(csv.DictReader(lines))

    def founders(self) -> dict[int, int]:
        """Return the cell at rest from which each daughter of a division descends."""
        found: dict[int, int] = {}
        for row in self._births():
            mother = int(row["mother_id"])
            found[int(row["cell_id"])] = found.get(mother, mother)
        return found

    # States that acts continue

    def _keep_state(self, sim: Simulation) -> None:
        """Keep the newest checkpoint by a second link to it: the recorder replaces the file, and does not change it."""
        checkpoint = self.results / "checkpoint.h5"
        try:
            found = os.stat(checkpoint)
        except FileNotFoundError:
            return
        if (found.st_ino, found.st_mtime_ns) == self._checkpoint:
            return
        self._checkpoint = (found.st_ino, found.st_mtime_ns)
        state = self.kept / f"{sim.steps:08d} {sim.time_s!r}.h5"
        state.unlink(missing_ok=True)
        try:
            os.link(checkpoint, state)
        except OSError:  # a file system without links
            shutil.copyfile(checkpoint, state)
        states = self.kept_states()
        if len(states) > MOST_KEPT:
            for _, path in states[1 : MOST_KEPT // 2 : 2]:
                path.unlink()

    def kept_states(self) -> list[tuple[float, Path]]:
        """Return the kept states with a time at or before which each was, oldest first."""
        return [(float(path.stem.split(" ")[1]), path) for path in sorted(self.kept.glob("*.h5"))]

    # Frames

    def _follow_shape(self, sim: Simulation) -> None:
        """Add the first shape, or the one that follows a division, an exchange or an extrusion."""
        hexahedra = sim.hexahedra
        if self._hexahedra is not None and np.array_equal(hexahedra, self._hexahedra):
            return
        self._hexahedra = hexahedra
        path = self.directory / f"shape-{len(self.shapes):04d}.bin"
        path.write_bytes(shape_message(sim, f"{self.number}/{len(self.shapes)}"))
        self.shapes.append(path)

    def _show(self, sim: Simulation, force: bool = False) -> None:
        now = monotonic()
        last_s = self.file.frames[-1].time_s if self.file.frames else -math.inf
        is_due = force or now - self._shown_at >= FRAME_APART_S or self._scenario_keeps(last_s, sim.time_s)
        if last_s >= sim.time_s or self.file.is_full or not is_due:
            return
        self._shown_at = now
        self._keep_state(sim)
        self._follow_shape(sim)
        self.file.add(sim.time_s, len(self.shapes) - 1, sim.positions.astype("f4"), values_now(sim))
        self._told()

    def _scenario_keeps(self, after_s: float, to_s: float) -> bool:
        """Is a time of `output.frame_every_s` among those after the one, up to the other? However quick the machine is."""
        every_s = float(self.scenario["output.frame_every_s"])
        return every_s > 0 and math.floor(to_s / every_s + INSTANT_S) * every_s > after_s + INSTANT_S

    @property
    def _inherited(self) -> list[tuple[StudioRun, int]]:
        if self.parent is None or self.from_s <= 0:
            return []
        return [(run, i) for run, i in self.parent.all_frames() if run.file.frames[i].time_s < self.from_s - INSTANT_S]

    def all_frames(self) -> list[tuple[StudioRun, int]]:
        """Return the frames of the run and, before the state that it continues, of its parent."""
        return [*self._inherited, *((self, i) for i in range(len(self.file.frames)))]

    def frame_message(self, want: dict[str, Any]) -> list[bytes]:
        """Return what the page lacks: the frame it asks for, its shape, rows of measures; nothing if all is known."""
        frames = self.all_frames()
        if not frames:
            return []
        at_s = want.get("at_s")
        index = len(frames) - 1
        if at_s is not None:
            times = [run.file.frames[i].time_s for run, i in frames]
            index = max((n for n, time_s in enumerate(times) if time_s <= at_s + INSTANT_S), default=0)
        if index == want.get("known") and len(self.rows) == want.get("rows"):
            return []
        run, i = frames[index]
        return run._pack(i, self, index, len(frames), want)

    def _pack(self, i: int, shown: StudioRun, index: int, count: int, want: dict[str, Any]) -> list[bytes]:
        frame: Frame = self.file.frames[i]
        shape = f"{self.number}/{frame.shape}"
        field = want["field"]
        arrays = {"positions": self.file.positions(i)}
        head: dict[str, Any] = {"kind": "frame", "slot": want["slot"], "run": shown.number, "index": index,
            "count": count,
                                "time_s": frame.time_s, "shape": shape, "field": field}
        if field in self.file.ends:
            arrays["values"] = self.file.values(i, field)
            ends = [run.file.ends[field] for run in (self, shown) if field in run.file.ends]
            head["range"] = ends_of_colours(field, min(low for low, _ in ends), max(high for _, high in ends))
        first = int(want.get("rows", 0))
        head |= {"columns": shown.columns, "first_row": first, "rows": shown.rows[first:]}
        known = shape in want.get("shapes", [])
        return [*([] if known else [self.shapes[frame.shape].read_bytes()]), packed(head, arrays)]
