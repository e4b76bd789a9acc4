"""Widget of napari: cells from labels, then a run, then its layers."""
from __future__ import annotations

import tempfile
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from magicgui.widgets import ComboBox, Container, FileEdit, FloatSpinBox, Label, LineEdit, PushButton, TextEdit, create_widget

import napari
import plica
from napari.qt.threading import thread_worker
from qtpy.QtCore import QTimer

from .layers import FIELDS, cells_layer, frames_layer, labels_layer

if TYPE_CHECKING:
    from napari.viewer import Viewer

SIDES = ["not known", "outside", "inside", "+z", "-z", "+y", "-y", "+x", "-x"]
LAWS = {
    "format": 1,
    "region": {"picked": {"array": "picked"}},
    "elasticity": {"young_modulus_Pa": 1000, "poisson_ratio": 0.45, "corner_barrier_Pa": 100},
    "dynamics": {"surface_drag_Pa_s_per_um": 131},
    "contraction": {"apical": {"region": "picked", "edges": "apical", "stiffness_nN_per_um": 10,
                               "program": {"time_min": [0, 3], "activity": [0, 1]}}},
}
FRAMES = 20  # of a run
CLOCK_MS = 300


class FoldWidget(Container):  # type: ignore[type-arg]
    """Widget of a viewer: choose labels, make cells, choose those that contract, run."""

    def __init__(self, napari_viewer: Viewer) -> None:
        super().__init__()
        self.viewer = napari_viewer
        self.tissue: Any = None
        self.results: Any = None
        self._running, self._stopping, self._reached_min = False, False, 0.0
        self._clock = QTimer()
        self._clock.timeout.connect(self._on_clock)
        self.volume = create_widget(annotation=napari.layers.Labels, label="labels")
        self.spacing = LineEdit(label="voxel z, y, x (µm)", value="")
        self.side = ComboBox(label="apical side", choices=SIDES)
        self.make = PushButton(text="Make cells")
        self.remarks = TextEdit(label="remarks", value="")
        self.picked = LineEdit(label="contracting cells", value="", tooltip="labels, such as 3, 7-12; empty: the one selected in the layer")
        self.scenario = FileEdit(label="scenario (optional)", mode="r", filter="*.toml", nullable=True,
                                 tooltip="TOML file with laws; array \"picked\" is 1 in contracting cells")
        self.minutes = FloatSpinBox(label="run for (min)", value=10, min=0.01, max=1000)
        self.field = ComboBox(label="colour", choices=[*FIELDS])
        self.start = PushButton(text="Run", enabled=False)
        self.status = Label(value="")
        self.extend([self.volume, self.spacing, self.side, self.make, self.remarks, self.picked, self.scenario, self.minutes, self.field,
                     self.start, self.status])
        self.volume.changed.connect(self._show_scale)
        self.make.clicked.connect(self._on_make)
        self.start.clicked.connect(self._on_start)
        self.field.changed.connect(self._recolour)
        self._show_scale()

    def _show_scale(self) -> None:
        layer = self.volume.value
        if layer is not None:
            self.spacing.value = ", ".join(f"{one:g}" for one in layer.scale[-3:])

    def spacing_um(self) -> tuple[float, float, float]:
        """Return the size of a voxel, z, y, x. ValueError if the field has no three numbers."""
        words = self.spacing.value.replace(",", " ").split()
        try:
            planes, rows, columns = (float(word) for word in words)
        except ValueError:
            raise ValueError(f"voxel: {self.spacing.value!r}; give three numbers, in µm: distances of planes, rows and columns") from None
        return planes, rows, columns

    def make_cells(self) -> None:
        """Make cells of the chosen labels, and show them with the remarks. ValueError of `plica.tissue_of_labels` if they are no layer."""
        layer = self.volume.value
        if layer is None:
            raise ValueError("labels: there is no layer of labels; add one")
        side = None if self.side.value == SIDES[0] else self.side.value
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # they are shown as remarks
            self.tissue = plica.tissue_of_labels(np.asarray(layer.data), self.spacing_um(), apical=side)
        layer.scale = self.spacing_um()  # where the cells are
        self.remarks.value = "\n".join([f"cells {self.tissue.sizes}", repr(self.tissue.quality), "", *self.tissue.remarks])
        self._replace(cells_layer(self.tissue))
        self.start.enabled = True
        self.status.value = f"{len(self.tissue.cells)} cells"

    def chosen(self) -> Any:
        """Return which cells contract. ValueError if the field has other words than labels, or labels without a cell."""
        names = self.tissue.cell_data["label"]
        wanted: set[int] = set()
        for word in self.picked.value.replace(",", " ").split():
            low, _, high = word.partition("-")
            if not low.isdigit() or not (high or low).isdigit():
                raise ValueError(f"cells that contract: {word!r}; give labels, such as 3, 7-12")
            wanted |= set(range(int(low), int(high or low) + 1))
        if not wanted:
            wanted = {int(self.volume.value.selected_label)}
        found = np.isin(names, sorted(wanted))
        if not found.any():
            raise ValueError(f"cells that contract: no cell has label {', '.join(map(str, sorted(wanted)[:5]))}; "
                             f"labels of cells go from {names.min():.0f} to {names.max():.0f}")
        return found

    def simulation(self) -> Any:
        """Return the simulation of the cells and laws chosen."""
        path = self.scenario.value
        laws = str(path) if path and Path(path).is_file() else LAWS
        scenario = plica.Scenario(laws, tissue=self.tissue, arrays={"picked": self.chosen()})
        scenario.update({"time.end_min": self.minutes.value, "output.frame_every_s": 60 * self.minutes.value / FRAMES})
        return plica.Simulation(scenario)

    def show_run(self, run: Any) -> None:
        """Show a run as layers with time: cells in colours, and labels."""
        self.results = run
        self._replace(frames_layer(run, FIELDS[self.field.value]))
        self._replace(labels_layer(run, self.volume.value.data, self.spacing_um()), visible=False)
        self.viewer.layers["cells"].visible = False
        self.viewer.dims.ndisplay = 3
        self.status.value = f"{run.summary.get('outcome', run.status)}"

    def _replace(self, data: tuple[Any, dict[str, Any], str], **look: Any) -> None:
        name = data[1]["name"]
        if name in self.viewer.layers:
            self.viewer.layers.remove(name)
        self.viewer.add_layer(napari.layers.Layer.create(data[0], {**data[1], **look}, data[2]))

    def _recolour(self) -> None:
        if self.results is not None:
            self._replace(frames_layer(self.results, FIELDS[self.field.value]))

    def _on_make(self) -> None:
        self._told(self.make_cells)

    def _on_start(self) -> None:
        if self._running:
            self._stopping = True
            return
        simulation = self._told(self.simulation)
        if simulation is None:
            return
        self._running, self._stopping = True, False
        self.start.text = "Stop"
        self._clock.start(CLOCK_MS)
        worker = self._in_thread(simulation, Path(tempfile.mkdtemp(prefix="napari-plica-")) / "run")
        worker.returned.connect(self.show_run)
        worker.errored.connect(lambda error: setattr(self.status, "value", str(error)))
        worker.finished.connect(self._on_end)
        worker.start()

    def _on_end(self) -> None:
        self._clock.stop()
        self._running = False
        self.start.text = "Run"

    def _on_clock(self) -> None:
        self.status.value = f"{self._reached_min:.2g} of {self.minutes.value:g} min"

    @thread_worker  # type: ignore[misc]
    def _in_thread(self, simulation: Any, out: Path) -> Any:
        """Run a simulation to its end, or until it is to stop; return the run."""
        def after_step(simulation: Any, _: Any) -> bool:
            self._reached_min = simulation.time_min
            return self._stopping

        return simulation.run(out=out, callback=after_step)

    def _told(self, act: Any) -> Any:
        """Return what a function returns; errors of input are shown instead."""
        try:
            return act()
        except (ValueError, plica.PlicaError) as error:
            self.status.value = str(error)
            return None
