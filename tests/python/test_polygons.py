"""Cells as polygons: of frames, and in files."""
import numpy as np
import plica
import pytest

SMALL = """format = 1
[embryo]
shape = "egg"
length_um = 200
diameter_um = 100
cell_count = 150
cell_height_um = 18
[region.belly]
angle_deg = [-50, 50]
[contraction.apical]
region = "belly"
stiffness_nN_per_um = 4
profile = { shape = "gaussian", axis = "angle", sigma_deg = 25 }
[time]
end_s = 2
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return plica.Simulation(plica.Scenario(SMALL)).run(out=tmp_path_factory.mktemp("polygons") / "run")


def euler(polygons):
    tables = polygons.to_tables()
    assert (tables["edge"]["opposite"] >= 0).all()
    return len(tables["vert"]) - len(tables["edge"]) / 2 + len(tables["face"])


@pytest.mark.parametrize("side", ["apical", "basal"])
def test_frames_have_polygons(run, side):
    frame = run.frames[-1]
    polygons = frame.polygons(side)
    assert len(polygons) == 150 and euler(polygons) == 2
    # Three cells meet at every vertex, so that a polygon has six corners less 12/150 on average.
    assert np.mean([len(face) for face in polygons.faces]) == pytest.approx(6 - 12 / 150)
    assert list(polygons.cell_data["cell_id"]) == list(range(150))
    assert set(polygons.cell_data) >= {"strength", "pressure_Pa", "region_belly"}
    # Outwards is outwards: the volume inside is that within the surface.
    volume = 0
    for face, centre in zip(polygons.faces, polygons.centres):
        corners = polygons.points[face]
        volume += np.einsum("ij,ij->", np.cross(corners, np.roll(corners, -1, axis=0)), np.tile(centre, (len(face), 1))) / 6
    assert 4 / 3 * np.pi * (64 * 32 * 32 if side == "basal" else 90 * 45 * 45) < volume < 4 / 3 * np.pi * 100 * 50 * 50
    with pytest.raises(ValueError, match="apical"):
        frame.polygons("top")


def test_strengths_are_the_profile(run):
    rest = run.frames[0].polygons()
    x, y, z = rest.centres.T
    angle = np.degrees(np.arctan2(y, -z))
    inside = rest.cell_data["region_belly"] > 0
    assert np.allclose(rest.cell_data["strength"][inside], np.exp(-0.5 * (angle[inside] / 25) ** 2), atol=0.02)
    assert (rest.cell_data["strength"][~inside] == 0).all()


def test_cells_of_one_element_are_their_faces(tmp_path):
    text = SMALL.replace('"egg"', '"pill"').replace("cell_count = 150\n", "cells = [6, 4, 4]\n")
    frame = plica.Simulation(plica.Scenario(text)).run(out=tmp_path / "run").frames[0]
    assert set(frame.field_data) == {"TimeValue"}  # nothing besides
    for side in ("apical", "basal"):
        polygons = frame.polygons(side)
        assert len(polygons) == 128 and euler(polygons) == 2
        assert polygons.areas.sum() == pytest.approx({"apical": 1, "basal": 0.64 * 0.82}[side] * np.pi * 100 * 200, rel=0.1)


def test_older_frames_have_none(run):
    frame = run.frames[0]
    del frame.field_data["polygon_ends"]
    with pytest.raises(plica.FileError, match="older version"):
        frame.polygons()


def test_tables():
    # A unit square and a triangle beside it.
    polygons = plica.Polygons([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0.5, 0]], [[0, 1, 2, 3], [1, 4, 2]],
                              {"label": [7, 9]})
    tables = polygons.to_tables()
    assert list(tables["face"]["area"]) == [1, 0.5] and list(tables["face"]["num_sides"]) == [4, 3]
    assert tables["face"]["perimeter"][1] == pytest.approx(1 + 2 * np.hypot(1, 0.5)) and list(tables["face"]["label"]) == [7, 9]
    edges = tables["edge"]
    assert list(edges["srce"]) == [0, 1, 2, 3, 1, 4, 2] and list(edges["trgt"]) == [1, 2, 3, 0, 4, 2, 1]
    assert list(edges["opposite"]) == [-1, 6, -1, -1, -1, -1, 1] and edges["dx"][0] == 1 and edges.index.name == "edge"


def test_files(run, tmp_path):
    polygons = run.frames[-1].polygons()
    polygons.write(tmp_path / "cells.obj")
    lines = (tmp_path / "cells.obj").read_text().splitlines()
    assert sum(line.startswith("f ") for line in lines) == 150
    vertices = np.array([line.split()[1:] for line in lines if line.startswith("v ")], dtype=float)
    assert (vertices == polygons.points).all()
    assert [int(i) - 1 for i in lines[-1].split()[1:]] == list(polygons.faces[-1])
    with pytest.raises(ValueError, match=".ply, .vtp or .obj"):
        polygons.write(tmp_path / "cells.stl")
    with pytest.raises(plica.FileError):
        polygons.write(tmp_path / "nowhere" / "cells.obj")


def test_vtp(run, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    polygons = run.frames[-1].polygons()
    polygons.write(tmp_path / "cells.vtp")
    for surface in (pyvista.read(tmp_path / "cells.vtp"), polygons.to_pyvista()):
        assert surface.n_cells == 150 and (surface.points == polygons.points).all()
        assert (np.array(surface.get_cell(149).point_ids) == polygons.faces[149]).all()
        assert (surface.cell_data["strength"] == polygons.cell_data["strength"]).all()


def test_ply_keeps_arrays(tmp_path):
    """What is written comes back as a sheet: cells in the order of the faces, regions by the arrays."""
    spatial = pytest.importorskip("scipy.spatial")
    # A row of seven hexagons, the walls between them given once.
    turns = np.radians(60 * np.arange(6) + 30)
    centres = np.column_stack([10 * np.arange(7) - 30, np.zeros(7)])
    corners = (centres[:, None] + 10 / np.sqrt(3) * np.stack([np.cos(turns), np.sin(turns)], axis=-1)).reshape(-1, 2)
    first = [int(pair[0]) for pair in map(sorted, spatial.cKDTree(corners).query_ball_point(corners, 1e-6))]
    used, faces = np.unique(first, return_inverse=True)
    label = np.array([40, 7, 12, 3, 99, 5, 1])
    cells = plica.Polygons(np.column_stack([corners[used], np.zeros(len(used))]), faces.reshape(7, 6),
                           {"label": label, "signal": label / 3})
    cells.write(tmp_path / "cells.ply")
    scenario = plica.Scenario({
        "format": 1, "embryo": {"shape": "surface", "file": str(tmp_path / "cells.ply"), "cell_height_um": 12, "rim": "held"},
        "region": {"high": {"array": "signal", "above": 4.0}, "one": {"array": "label", "above": 98.5}},
        "contraction": {"apical": {"region": "high"}}, "time": {"end_min": 1},
    })
    sim = plica.Simulation(scenario)
    assert list(sim.regions["high"]) == list(label / 3 > 4.0) and list(sim.regions["one"]) == list(label == 99)
    assert np.allclose(sim.cell_data["x_um"], centres[:, 0], atol=1e-6) and np.allclose(sim.cell_data["y_um"], 0, atol=1e-6)
    assert np.allclose(sim.cell_data["apical_area_um2"], cells.areas)
    for name in ("mean signal", "", " signal"):
        cells.cell_data = {name: label}
        with pytest.raises(ValueError, match="one word"):
            cells.write(tmp_path / "other.ply")
    assert not (tmp_path / "other.ply").exists()


@pytest.mark.parametrize(("points", "faces", "data", "said"), [
    ([[0, 0]], [], {}, "points: give finite numbers"),
    ([[0, 0, np.nan]], [], {}, "points: give finite numbers"),
    ([[0, 0, 0], [1, 0, 0]], [[0, 1]], {}, "polygon 0 has vertices"),
    ([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 1, 3]], {}, "polygon 0 has vertices"),
    ([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 1, 2]], {"a": [1, 2]}, "cell_data: a has shape"),
])
def test_bad_polygons(points, faces, data, said):
    with pytest.raises(ValueError, match=said):
        plica.Polygons(points, faces, data)


def test_missing_numbers_are_named(tmp_path):
    """A mask, NaN or NA of an array: refused, since such a cell would have another's value, or be in no region."""
    pandas = pytest.importorskip("pandas")
    corners, faces = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    for values in (np.ma.masked_array([3, 4], [False, True]), [3, np.nan], pandas.array([3, pandas.NA], dtype="Int64"), [3, None]):
        with pytest.raises(ValueError, match="cell_data: signal has no number for polygon 1, and for 1 of 2 in all; give numbers, or"):
            plica.Polygons(corners, faces, {"signal": values})
        square = plica.Polygons(corners, faces)
        square.cell_data["signal"] = values
        for name in ("cells.ply", "cells.vtp"):
            with pytest.raises(ValueError, match="no number for polygon 1"):
                square.write(tmp_path / name)
    # The remedy.
    square = plica.Polygons(corners, faces)
    values = np.array([3, np.nan])
    left = square.select(np.isfinite(values))
    left.cell_data["signal"] = values[np.isfinite(values)]
    left.write(tmp_path / "cells.ply")
    assert list(plica.Polygons(corners, faces, {"signal": pandas.array([3, 4], dtype="Int64")}).cell_data["signal"]) == [3, 4]


def test_pieces_and_selection():
    strip = np.array([[x, y, 0] for x in range(8) for y in (0, 1)])
    quads = [[2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1] for k in (0, 2, 3, 5, 4, 6)]
    cells = plica.Polygons(strip, quads, {"number": np.arange(6)})
    assert list(cells.pieces) == [1, 0, 0, 0, 0, 0]
    assert list(cells.select(cells.pieces == 1).cell_data["number"]) == [0] and len(cells.select(cells.pieces == 1).points) == 4
    assert len(cells.select(np.zeros(6, dtype=bool))) == 0
    with pytest.raises(ValueError, match="one boolean for each of 6"):
        cells.select([0, 1])
