"""Draws the picture of docs/how-to/napari.md: the plugin with a folded sheet.

Usage: xvfb-run -a -s "-screen 0 1600x900x24" build/napari-venv/bin/python docs/pictures/plugin.py (tests/napari/run makes build/napari-venv)
"""
import sys
import warnings
from pathlib import Path

import napari
import numpy as np
from napari_plica.widget import FoldWidget
from PIL import Image
from qtpy.QtWidgets import QApplication

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/python"))
from drawn_tissues import Tube  # noqa: E402

SPACING = (1.0, 0.5, 0.5)
SIZE = (1500, 760)


def main():
    warnings.simplefilter("ignore")
    labels, _ = Tube(240, radius=60, length=80, height=12, sector=1.3, seed=3).labels(SPACING)
    viewer = napari.Viewer(show=False)
    viewer.window.resize(*SIZE)
    viewer.add_labels(labels, scale=SPACING, name="labels")
    widget = FoldWidget(viewer)
    viewer.window.add_dock_widget(widget, name="Cells and folds", area="right")
    viewer.window.show()
    widget.side.value = "outside"
    widget.make_cells()
    middle = widget.tissue.apical.mean(axis=0)[0]
    near = [abs(widget.tissue.apical[cell].mean(axis=0)[0] - middle) < 10 for cell in widget.tissue.cells]
    widget.picked.value = ", ".join(str(int(label)) for label in widget.tissue.cell_data["label"][near])
    widget.minutes.value = 2
    run = widget.simulation().run(out=ROOT / "build/napari-run", overwrite=True)
    widget.show_run(run)
    for layer in viewer.layers:
        layer.visible = layer.name == "fold"
    viewer.dims.set_point(0, len(run.frames) - 1)
    viewer.reset_view()
    viewer.camera.set_view_direction((-1, 0.9, 0.4), (0, -1, 0))
    viewer.camera.zoom *= 0.8
    for _ in range(20):
        QApplication.processEvents()
    shot = Image.fromarray(np.asarray(viewer.screenshot(canvas_only=False, flash=False))[:, :, :3])
    shot.quantize(128).save(ROOT / "docs/images/napari.png", optimize=True)


if __name__ == "__main__":
    main()
