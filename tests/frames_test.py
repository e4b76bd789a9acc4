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
CELL_ARRAYS = {"cell_id": 1, "mother_id": 1, "generation": 1, "volume_um3": 1, "volume_error": 1,
               "apical_area_ratio": 1, "pressure_Pa": 1, "activity": 1, "region_furrow": 1}
CELLS, NODES, FURROW_CELLS = 756, 1516, 70
END_S, FRAME_EVERY_S = 2, 1

checks, failures = 0, []


def check(holds, text):
    global checks
    checks += 1
    if not holds:
        failures.append(text)


def values_of(array):
    return [array.GetTuple(i) for i in range(array.GetNumberOfTuples())]


def check_arrays(data, expected, count, where):
    for name, components in expected.items():
        array = data.GetArray(name)
        check(array is not None, f"{where}: no array {name}")
        if array is None:
            continue
        check(array.GetNumberOfComponents() == components, f"{where}: {name} has {array.GetNumberOfComponents()} components")
        check(array.GetNumberOfTuples() == count, f"{where}: {name} has {array.GetNumberOfTuples()} values, not {count}")
        check(all(math.isfinite(x) for value in values_of(array) for x in value), f"{where}: {name} is not finite")


def corner_jacobian(points, ids):
    """det J at node 0 of a hexahedron in VTK's order: positive when the faces are where the contract has them."""
    o, a, b, c = (points[ids[i]] for i in (0, 1, 3, 4))
    u, v, w = ([p[i] - o[i] for i in range(3)] for p in (a, b, c))
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0]))


def read(file):
    reader = vtkXMLUnstructuredGridReader()
    check(reader.CanReadFile(str(file)) == 1, f"{file.name}: VTK does not take it for its own")
    reader.SetFileName(str(file))
    reader.Update()
    check(reader.GetErrorCode() == 0, f"{file.name}: error {reader.GetErrorCode()} on reading")
    return reader.GetOutput()


def check_frame(file, time_s, rest):
    """Returns the points, which are the rest for the frames that follow."""
    grid, name = read(file), file.name
    check(grid.GetNumberOfPoints() == NODES, f"{name}: {grid.GetNumberOfPoints()} points")
    check(grid.GetNumberOfCells() == CELLS, f"{name}: {grid.GetNumberOfCells()} cells")
    points = [grid.GetPoint(i) for i in range(grid.GetNumberOfPoints())]
    check(all(math.isfinite(x) for point in points for x in point), f"{name}: points are not finite")
    for i in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(i)
        ids = [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]
        check(cell.GetCellType() == VTK_HEXAHEDRON and corner_jacobian(points, ids) > 0,
              f"{name}: cell {i} is no upright hexahedron")
    check_arrays(grid.GetPointData(), POINT_ARRAYS, NODES, name)
    check_arrays(grid.GetCellData(), CELL_ARRAYS, CELLS, name)
    if failures:
        return points
    time = grid.GetFieldData().GetArray("TimeValue")
    check(time is not None and time.GetValue(0) == time_s, f"{name}: its TimeValue is not {time_s}")
    cells = {key: [value[0] for value in values_of(grid.GetCellData().GetArray(key))] for key in CELL_ARRAYS}
    check(set(cells["region_furrow"]) == {0, 1} and sum(cells["region_furrow"]) == FURROW_CELLS,
          f"{name}: {sum(cells['region_furrow'])} cells in region_furrow, not {FURROW_CELLS}")
    check(sorted(cells["cell_id"]) == list(range(CELLS)), f"{name}: cell_id is not 0 to {CELLS - 1}")
    check(max(map(abs, cells["volume_error"])) <= 1e-9, f"{name}: a volume error over 1e-9")
    displacements = values_of(grid.GetPointData().GetArray("displacement_um"))
    reference = rest or points
    check(all(math.dist([p[k] - d[k] for k in range(3)], r) < 1e-9
              for p, d, r in zip(points, displacements, reference)), f"{name}: points are not rest plus displacement")
    return points


def main():
    program, out = sys.argv[1], Path(sys.argv[2])
    command = [program, "run", "drosophila", "--out", str(out), "--overwrite", "--quiet", "--set", f"time.end_s={END_S}",
               "--set", f"output.frame_every_s={FRAME_EVERY_S}"]
    status = subprocess.run(command, capture_output=True, text=True)
    # 1: the scenario's expectations are missed, of course, two seconds after the start.
    check(status.returncode in (0, 1), f"plica run ended with {status.returncode}: {status.stderr}")
    frames = [(float(entry.get("timestep")), out / entry.get("file"))
              for entry in ElementTree.parse(out / "frames.pvd").getroot().iter("DataSet")]
    times = [time for time, _ in frames]
    check(times == [0, 1, 2], f"frames at {times}, not at 0, 1, 2 s")
    check({file.name for _, file in frames} == {file.name for file in (out / "frames").iterdir()},
          "frames.pvd does not list the files of frames/")
    rest = None
    for time, file in frames:
        points = check_frame(file, time, rest)
        rest = rest or points
    summary = json.loads((out / "summary.json").read_text())
    check((summary["cells"], summary["nodes"]) == (CELLS, NODES), "summary.json counts other cells or nodes")
    print(f"Read {len(frames)} frames, {checks} checks, {len(failures)} failed.")
    for text in failures[:20]:
        print(text)
    sys.exit(1 if failures else 0)


main()
