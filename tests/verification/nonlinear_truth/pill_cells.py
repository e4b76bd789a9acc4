#!/usr/bin/env python3
"""Writes pill_cells.json, what make_truth.py takes from plica about the pill: where its cells' corners lie at rest.

    plica mesh pill.toml --set embryo.elements_per_cell=[1,1,1] --out rest.vtu && python3 pill_cells.py rest.vtu

plica evens out the grid of a pill by a method of its own, which is no matter of mechanics; so its corners are given,
while the shape between them, loads and mechanics are made anew.
"""
import json
import pathlib
import sys

import vtk
from vtk.util.numpy_support import vtk_to_numpy

reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
cells = [[grid.GetCell(c).GetPointId(i) for i in range(8)] for c in range(grid.GetNumberOfCells())]
furrow = vtk_to_numpy(grid.GetCellData().GetArray("region_furrow"))
out = {"basal_corners_um": [points[c[:4]].round(12).tolist() for c in cells],
       "furrow_cells": [int(c) for c in furrow.nonzero()[0]]}
text = json.dumps(out, indent=None).replace("[[[", "[\n[[").replace("]], [[", "]],\n[[")
(pathlib.Path(__file__).resolve().parent / "pill_cells.json").write_text(text + "\n")
