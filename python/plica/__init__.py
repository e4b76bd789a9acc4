"""Simulate how sheets of living cells fold: build a tissue, solve its mechanics, measure and draw the folds.

>>> import plica
>>> sim = plica.Simulation("drosophila")
>>> sim.run(until_min=1)
>>> round(sim.measures["furrow_depth_um"], 1)
9.9
"""
from __future__ import annotations

from ._core import version as __version__
from .answers import verdict
from .centres import polygons_of_centres
from .emulator import Emulator
from .errors import Diagnostic, FileError, MissingExtra, NumericsError, PlicaError, ScenarioError
from .experiments import reproduce
from .fits import Combination, Fit, Miss, fit
from .indices import SobolIndices
from .inference import Inference, infer
from .label_quality import LabelledTissue
from .label_shapes import LabelledShapes, shapes_of_labels
from .labels import polygons_of_labels
from .monolayers import polygons_of_monolayer, tissue_of_monolayer
from .outlines import polygons_of_outlines
from .pictures import movie, render
from .polygons import Polygons
from .posteriors import Posterior, posterior
from .results import Frame, Frames, Run
from .results import open_run as open
from .scenario import Scenario, builtin_scenarios
from .local_energy import LocalEnergy
from .simulation import Simulation, Step, load
from .studio import studio
from .study import Study
from .studies import Calibration, Comparison, Trial, calibrate, compare
from .tapes import GradientCheck, Tape, check_gradient, record
from .tissue import Tissue
from .volumes import tissue_of_labels

__all__ = [
    "Calibration",
    "Combination",
    "Comparison",
    "Diagnostic",
    "Emulator",
    "FileError",
    "Fit",
    "Frame",
    "Frames",
    "GradientCheck",
    "Inference",
    "LabelledShapes",
    "LabelledTissue",
    "LocalEnergy",
    "Miss",
    "MissingExtra",
    "NumericsError",
    "PlicaError",
    "Polygons",
    "Posterior",
    "Run",
    "Scenario",
    "ScenarioError",
    "Simulation",
    "SobolIndices",
    "Step",
    "Study",
    "Tape",
    "Tissue",
    "Trial",
    "__version__",
    "builtin_scenarios",
    "calibrate",
    "check_gradient",
    "compare",
    "fit",
    "infer",
    "load",
    "movie",
    "open",
    "polygons_of_centres",
    "polygons_of_labels",
    "polygons_of_monolayer",
    "polygons_of_outlines",
    "posterior",
    "record",
    "render",
    "reproduce",
    "shapes_of_labels",
    "studio",
    "tissue_of_labels",
    "tissue_of_monolayer",
    "verdict",
]
