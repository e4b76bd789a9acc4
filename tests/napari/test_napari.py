"""The plugin of napari, without a screen: labels in, cells and remarks, a run, layers with time. tests/napari/run installs what it needs."""
import importlib
import warnings

import napari
import npe2
import numpy as np
import pytest
from drawn_tissues import Tube
from napari_plica.layers import FIELDS, cells_layer, solid
from napari_plica.widget import FoldWidget

SPACING = (1.0, 0.5, 0.5)


@pytest.fixture
def opened(make_napari_viewer_proxy, qtbot):
    labels, _ = Tube(30, radius=30, length=22, height=8, sector=0.8, seed=2).labels(SPACING)
    viewer = make_napari_viewer_proxy()
    viewer.add_labels(labels, scale=SPACING)
    return viewer, FoldWidget(viewer), labels


def test_manifest_names_the_widget():
    manifest = npe2.PluginManifest.from_distribution("napari-plica")
    assert [widget.command for widget in manifest.contributions.widgets] == ["napari-plica.fold"]
    module, _, name = manifest.contributions.commands[0].python_name.partition(":")
    assert getattr(importlib.import_module(module), name) is FoldWidget


def test_cells_and_remarks(opened):
    viewer, widget, labels = opened
    widget.volume.reset_choices()
    widget.make.clicked.emit(True)
    assert "apical is not known" in widget.status.value.replace("which side of the layer is apical", "apical")
    widget.side.value = "outside"
    widget.make.clicked.emit(True)
    cells = viewer.layers["cells"]
    assert widget.status.value == f"{len(widget.tissue.cells)} cells"
    assert "neighbours right" in widget.remarks.value and cells.metadata["remarks"] == widget.tissue.remarks
    places = np.argwhere(labels > 0) * SPACING
    assert np.allclose(cells.data[0].min(axis=0), places.min(axis=0), atol=1.5)  # where the labels are
    assert np.allclose(cells.data[0].max(axis=0), places.max(axis=0), atol=1.5)


def test_run_becomes_layers_with_time(opened, qtbot, tmp_path):
    viewer, widget, labels = opened
    widget.volume.reset_choices()
    widget.side.value = "outside"
    widget.make.clicked.emit(True)
    widget.minutes.value = 0.5
    widget.picked.value = "400"
    widget.start.clicked.emit(True)
    assert "no cell has label 400" in widget.status.value
    widget.picked.value = "3, 7-9"
    assert sorted(widget.tissue.cell_data["label"][widget.chosen()]) == [3, 7, 8, 9]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        widget.start.clicked.emit(True)
        qtbot.waitUntil(lambda: widget.results is not None, timeout=60_000)
    run = widget.results
    fold, after = viewer.layers["fold"], viewer.layers["labels of the fold"]
    frames = len(run.frames)
    assert frames > 10 and fold.ndim == 4 and after.data.shape == (frames, *labels.shape)
    assert fold.metadata["times_min"][-1] == pytest.approx(0.5)
    viewer.dims.set_point(0, frames - 1)
    number = fold.data[0][:, 0] == frames - 1
    assert fold.data[2][number].min() == pytest.approx(run.frames[-1].cell_data["apical_area_ratio"].min())
    assert set(np.unique(after.data[-1])) - {0} <= set(widget.tissue.cell_data["label"].astype(int))
    assert (after.data[0] == labels)[labels > 0].mean() > 0.9 > (after.data[-1] == after.data[0])[after.data[0] > 0].mean() - 0.1
    widget.field.value = [*FIELDS][1]
    assert viewer.layers["fold"].contrast_limits[1] == pytest.approx(max(frame.cell_data["height_um"].max() for frame in run.frames))


def test_laws_of_a_file(opened, tmp_path):
    _, widget, _ = opened
    widget.volume.reset_choices()
    widget.side.value = "outside"
    widget.make_cells()
    widget.picked.value = "5"
    (tmp_path / "laws.toml").write_text('format = 1\n[region.five]\narray = "picked"\n[cortex.apical]\nregion = "five"\ntension_mN_per_m = 1\n'
                                        "[dynamics]\nsurface_drag_Pa_s_per_um = 131\n")
    widget.scenario.value = tmp_path / "laws.toml"
    simulation = widget.simulation()
    assert simulation.cell_data["picked"].sum() == 1 and np.isfinite(simulation.activity("cortex.apical")).sum() == 1
    assert simulation.scenario["time.end_s"] == pytest.approx(600)


def test_tensions_as_colours(opened):
    viewer, widget, _ = opened
    widget.volume.reset_choices()
    widget.side.value = "outside"
    widget.make_cells()
    tensions = np.linspace(0.5, 2, len(widget.tissue.cells))
    data, look, kind = cells_layer(widget.tissue, tensions, "tensions")
    viewer.add_layer(napari.layers.Layer.create(data, look, kind))
    assert set(viewer.layers["tensions"].data[2]) == set(tensions)
    with pytest.raises(ValueError, match=r"values: shape \(3,\); give one number per cell"):
        cells_layer(widget.tissue, tensions[:3])


def test_solid_is_closed():
    top = np.array([[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], dtype=float)
    body = solid(top, top - [0, 0, 1], [np.arange(4)])
    edges = np.sort(np.concatenate([body.triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    one, two, three = (body.vertices[body.triangles[:, k]] for k in range(3))
    assert abs((one * np.cross(two, three)).sum()) / 6 == pytest.approx(1)
