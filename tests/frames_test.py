#!/usr/bin/python3
"""Runs the Drosophila scenario for two seconds and reads what it leaves with VTK's own reader, as ParaView would.

Usage: frames_test.py PLICA OUT; the run is left in OUT. Needs Debian's python3-vtk9.
"""
import json
import math
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

# The contract: arrays and numbers of components.
POINT_ARRAYS = {"displacement_um": 3, "velocity_um_per_s": 3, "force_nN": 3}
CELL_ARRAYS = dict.fromkeys(("cell_id", "mother_id", "generation", "volume_um3", "volume_error", "apical_area_ratio", "pressure_Pa",
                             "activity", "region_furrow"), 1)
CELLS, NODES, FURROW_CELLS = 756, 1516, 70


def check(holds, text):
    if not holds:
        sys.exit(text)


def values_of(data, name, components, count):
    array = data.GetArray(name)
    check(array is not None, f"no array {name}")
    check((array.GetNumberOfComponents(), array.GetNumberOfTuples()) == (components, count), f"{name} has another size")
    values = [array.GetTuple(i) for i in range(count)]
    check(all(math.isfinite(x) for value in values for x in value), f"{name} is not finite")
    return values


def corner_jacobian(points, ids):
    """det J at node 0 of a hexahedron in VTK's order: positive when the faces are where the contract has them."""
    o, a, b, c = (points[ids[i]] for i in (0, 1, 3, 4))
    u, v, w = ([p[i] - o[i] for i in range(3)] for p in (a, b, c))
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0]))


def check_frame(file, time_s, rest):
    """Returns the points, which are the rest for the frames that follow."""
    reader, name = vtkXMLUnstructuredGridReader(), file.name
    check(reader.CanReadFile(str(file)) == 1, f"{name}: VTK does not take it for its own")
    reader.SetFileName(str(file))
    reader.Update()
    check(reader.GetErrorCode() == 0, f"{name}: error {reader.GetErrorCode()} on reading")
    grid = reader.GetOutput()
    check((grid.GetNumberOfPoints(), grid.GetNumberOfCells()) == (NODES, CELLS), f"{name}: other numbers of points and cells")
    points = [grid.GetPoint(i) for i in range(NODES)]
    for i in range(CELLS):
        cell = grid.GetCell(i)
        ids = [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]
        check(cell.GetCellType() == VTK_HEXAHEDRON and corner_jacobian(points, ids) > 0, f"{name}: cell {i} is no upright hexahedron")
    of_points = {key: values_of(grid.GetPointData(), key, components, NODES) for key, components in POINT_ARRAYS.items()}
    of_cells = {key: [value[0] for value in values_of(grid.GetCellData(), key, 1, CELLS)] for key in CELL_ARRAYS}
    check(grid.GetFieldData().GetArray("TimeValue").GetValue(0) == time_s, f"{name}: its TimeValue is not {time_s}")
    check(set(of_cells["region_furrow"]) == {0, 1} and sum(of_cells["region_furrow"]) == FURROW_CELLS, f"{name}: another region_furrow")
    check(sorted(of_cells["cell_id"]) == list(range(CELLS)), f"{name}: cell_id is not 0 to {CELLS - 1}")
    check(max(map(abs, of_cells["volume_error"])) <= 1e-9, f"{name}: a volume error over 1e-9")
    check(all(math.dist([p[k] - d[k] for k in range(3)], r) < 1e-9 for p, d, r in zip(points, of_points["displacement_um"], rest or points)),
          f"{name}: points are not rest plus displacement")
    return points


def main():
    program, out = sys.argv[1], Path(sys.argv[2])
    command = [program, "run", "drosophila", "--out", out, "--overwrite", "--quiet", "--set", "time.end_s=2", "--set", "output.frame_every_s=1"]
    status = subprocess.run(command, capture_output=True, text=True)
    # 1: the scenario's expectations are missed, of course, two seconds after the start.
    check(status.returncode in (0, 1), f"plica run ended with {status.returncode}: {status.stderr}")
    frames = [(float(entry.get("timestep")), out / entry.get("file"))
              for entry in ElementTree.parse(out / "frames.pvd").getroot().iter("DataSet")]
    check([time for time, _ in frames] == [0, 1, 2], "frames are not at 0, 1, 2 s")
    check({file for _, file in frames} == set((out / "frames").iterdir()), "frames.pvd does not list the files of frames/")
    rest = None
    for time, file in frames:
        points = check_frame(file, time, rest)
        rest = rest or points
    summary = json.loads((out / "summary.json").read_text())
    check((summary["cells"], summary["nodes"]) == (CELLS, NODES), "summary.json counts other cells or nodes")
    print(f"Read {len(frames)} frames.")


main()
