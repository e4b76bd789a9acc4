"""Cells as polygons of traced outlines, of centres, and of tyssue's monolayers."""
import json
import re
import warnings

import numpy as np
import plica
import pytest

pytest.importorskip("skimage")


def cells_of_voronoi(side=7, noise=1.0):
    """Corners of irregular cells, 10 µm wide, all but those at the rim, and their centres."""
    spatial = pytest.importorskip("scipy.spatial")
    row, column = np.indices((side + 2, side + 2)).reshape(2, -1)
    centres = 10 * np.column_stack([column + row % 2 / 2, row * 0.75**0.5])
    centres += np.random.default_rng(5).normal(0, noise, centres.shape)
    tessellation = spatial.Voronoi(centres)
    inner = np.flatnonzero((row % (side + 1) > 0) & (column % (side + 1) > 0))
    return [tessellation.vertices[tessellation.regions[tessellation.point_region[cell]]] for cell in inner], centres[inner]


def apart(polygons, rings):
    """Distances of the corners of polygons from those of rings."""
    spatial = pytest.importorskip("scipy.spatial")
    return spatial.cKDTree(np.concatenate(rings)).query(polygons.points[:, :2])[0]


def sheet(polygons, tmp_path):
    """The simulation of a sheet of these polygons: plica accepts them."""
    polygons.write(tmp_path / "cells.ply")
    embryo = {"shape": "surface", "file": str(tmp_path / "cells.ply"), "cell_height_um": 10}
    return plica.Simulation(plica.Scenario({"format": 1, "embryo": embryo}))


@pytest.mark.parametrize("shift_um", [-0.4, 0.0, 0.4])
def test_outlines_traced_one_by_one_share_corners(shift_um, tmp_path):
    """Gaps (or overlaps, if negative) of twice the shift, and 0.1 µm of noise."""
    rings, _ = cells_of_voronoi()
    rng = np.random.default_rng(2)
    traced = []
    for ring in rings:
        inward = ring.mean(axis=0) - ring
        traced.append(ring + shift_um * inward / np.linalg.norm(inward, axis=1)[:, None] + rng.normal(0, 0.1, ring.shape))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        cells = plica.polygons_of_outlines(traced, y_down=False)
    said = " ".join(str(one.message) for one in told)
    assert ("overlaps were divided" in said) == (shift_um <= 0) and ("were closed" in said) == (shift_um >= 0)
    assert list(cells.cell_data["label"]) == list(range(len(rings))) and cells.pieces.max() == 0
    assert np.quantile(apart(cells, rings), 0.9) < 0.8
    assert (cells.to_tables()["edge"]["opposite"] < 0).sum() < 70
    sim = sheet(cells, tmp_path)
    # Mirrored images come back by y_down.
    flipped = plica.polygons_of_outlines([ring * [1, -1] for ring in traced])
    assert np.allclose(flipped.areas, cells.areas, rtol=0.03)
    assert len(sim.cell_data["x_um"]) == len(rings)


def test_a_tolerance_is_named_that_closes_the_gaps():
    rings, _ = cells_of_voronoi(5)
    apart_um = [ring + 0.2 * (ring.mean(axis=0) - ring) for ring in rings]
    with pytest.raises(ValueError, match=r"gaps between neighbours are wider than tolerance_um = 0.7; set tolerance_um = ") as refused:
        plica.polygons_of_outlines(apart_um, tolerance_um=0.7)
    named = float(re.search(r"set tolerance_um = ([\d.]+)", str(refused.value))[1])
    with pytest.warns(UserWarning, match="were closed"):
        assert plica.polygons_of_outlines(apart_um, tolerance_um=named).pieces.max() == 0


def feature(ring, properties, kind="Polygon"):
    corners = [*ring.tolist(), ring[0].tolist()]
    return {"type": "Feature", "id": "7f", "geometry": {"type": kind, "coordinates": [corners] if kind == "Polygon" else [[corners]]},
            "properties": properties}


def test_geojson(tmp_path):
    """Files of QuPath, of both of its formats, and of Baysor, of both of its."""
    rings, _ = cells_of_voronoi(5)
    count, hull = len(rings), np.array([[0, 0], [80, 0], [80, 80], [0, 80]])
    new = [feature(ring, {"objectType": "cell", "isLocked": False, "measurements": {"Nucleus: Area µm^2": cell, "Max": "NaN" if cell else 3}})
           for cell, ring in enumerate(rings)]
    old = [feature(ring, {"object_type": "detection", "measurements": [{"name": "Nucleus: Area µm^2", "value": cell}]}, "MultiPolygon")
           for cell, ring in enumerate(rings)]
    region = feature(hull, {"objectType": "annotation"})
    geometries = [{"type": "Polygon", "cell": 100 + cell, "coordinates": [ring.tolist()]} for cell, ring in enumerate(rings)]
    files = {"qupath": {"type": "FeatureCollection", "features": [region, *new]}, "old qupath": [*old, region],
             "baysor": {"type": "FeatureCollection", "features": [feature(ring, {}) for ring in rings]},
             "old baysor": {"type": "GeometryCollection", "geometries": [*geometries, {"type": "Polygon", "cell": 0, "coordinates": [[[3, 4], [3, 4]]]}]}}
    for name, content in files.items():
        (tmp_path / f"{name}.json").write_text(json.dumps(content), encoding="utf-8")
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            cells = plica.polygons_of_outlines(tmp_path / f"{name}.json", 0.5)
        assert np.allclose(cells.areas.sum(), sum(0.25 * plica.Polygons(np.column_stack([ring, 0 * ring[:, 0]]), [range(len(ring))]).areas[0]
                                                  for ring in rings), rtol=0.05)
        first = int(name == "qupath")
        assert list(cells.cell_data["label"]) == list(range(first, first + count))
        if name.endswith("qupath"):
            assert list(cells.cell_data["Nucleus_Area_µm_2"]) == list(range(count))
        if name == "old baysor":
            assert list(cells.cell_data["cell"]) == list(range(100, 100 + count))
        assert any("1 have fewer than three corners, or no area, and were omitted" in str(one.message) for one in told) == (name == "old baysor")
        assert any("1 arrays, such as Max, lack the number of a cell" in str(one.message) for one in told) == (name == "qupath")


def test_bad_outlines(tmp_path):
    rings, _ = cells_of_voronoi(5)
    twice = [*rings, rings[7] + 0.5]
    with pytest.raises(ValueError, match=r"outline 7 lies within outline 25 to \d+ % of its area; omit one of them"):
        plica.polygons_of_outlines(twice)
    assert len(plica.polygons_of_outlines(twice[:-1])) == 25
    far = [*rings, rings[0] + [75, 0]]
    with pytest.raises(ValueError, match=r"in 2 pieces, which share no edge, of 25, 1 cells .*keep = \"largest\""):
        plica.polygons_of_outlines(far)
    assert len(plica.polygons_of_outlines(far, keep="largest")) == 25
    assert len(plica.polygons_of_outlines(rings, 2**70)) == 25  # beyond the integers of arrays
    for bad, said in (([], "no outlines"), (7, "no outlines: .*give x and y"), ({"type": "Point"}, "no outlines"), ({"features": [7]}, "no outlines"), ([[[0, 0], [1, 1]]], "outline 0 has shape"), ([[[0, 0], [1, 1], [2, 2]]], "around an area"), ([[[0, 0], [1, 1], [np.nan, 0]]], "outline 0 has shape")):
        with pytest.raises(ValueError, match=said):
            plica.polygons_of_outlines(bad)
    with pytest.raises(ValueError, match="a part of the tissue"):
        plica.polygons_of_outlines([rings[0], rings[1], rings[2] + 3000])
    (tmp_path / "cells.wkt").write_text("POLYGON ((0 0, 1 1, 1 0))")
    with pytest.raises(plica.FileError, match=r"is no GeoJSON: .*make GeoJSON by geopandas or QuPath"):
        plica.polygons_of_outlines(tmp_path / "cells.wkt")


def test_centres_of_an_open_sheet(tmp_path):
    """Voronoi polygons; cells at the rim are about as large as others."""
    rings, centres = cells_of_voronoi()
    cells = plica.polygons_of_centres(centres, cell_data={"gene": np.arange(len(centres)) / 2})
    assert len(cells) == len(centres) and list(cells.cell_data["label"]) == list(range(len(centres)))
    assert list(cells.cell_data["gene"]) == [row / 2 for row in range(len(centres))]
    assert (cells.areas > 55).all() and (cells.areas < 125).all() and cells.areas.mean() == pytest.approx(86.6, rel=0.05)
    inner = np.linalg.norm(cells.points[:, :2] - centres.mean(axis=0), axis=1) < 20
    assert apart(cells, rings)[inner].max() < 0.5 and (cells.points[:, 2] == 0).all()
    sim = sheet(cells, tmp_path)
    assert np.allclose(sim.cell_data["x_um"], cells.centres[:, 0], atol=1.5)


def test_centres_of_a_curved_sheet(tmp_path):
    """A cap of a ball, tilted: corners lie on it, and the apical side is up."""
    _, centres = cells_of_voronoi(9)
    flat = centres - centres.mean(axis=0)
    ball = np.column_stack([flat, np.sqrt(80**2 - (flat**2).sum(axis=1))])
    turn = np.array([[0.8, 0, 0.6], [0, 1, 0], [-0.6, 0, 0.8]])
    cells = plica.polygons_of_centres(ball @ turn.T)
    radius = np.linalg.norm(cells.points, axis=1)
    assert np.abs(radius - 80).max() < 2
    for face in cells.faces:
        normal = np.cross(cells.points[face], np.roll(cells.points[face], -1, axis=0)).sum(axis=0)
        assert normal @ cells.points[face].mean(axis=0) > 0
    sheet(cells, tmp_path)


@pytest.mark.parametrize("z", ["0", "1000"])
def test_points_of_an_open_sheet_name_this_function(tmp_path, z):
    _, centres = cells_of_voronoi()
    lines = [f"{x},{y},{z}" for x, y in centres - centres.mean(axis=0)]
    (tmp_path / "centres.csv").write_text("\n".join(["x_um,y_um,z_um", *lines]))
    with pytest.raises(plica.ScenarioError, match="an open sheet is made by Python's plica.polygons_of_centres"):
        plica.Simulation(plica.Scenario({"format": 1, "embryo": {"shape": "points", "file": str(tmp_path / "centres.csv")}}))


def test_bad_centres():
    _, centres = cells_of_voronoi()
    with pytest.raises(ValueError, match="centres: 2 values are masked"):
        plica.polygons_of_centres(np.ma.masked_array(centres, mask=np.arange(len(centres))[:, None] == [3, 3]))
    near = np.concatenate([centres, centres + [83, 0]])
    with pytest.raises(ValueError, match=r"in 2 pieces, which share no edge, of 49, 49 cells .*set reach_um = ") as refused:
        plica.polygons_of_centres(near)
    named = float(re.search(r"set reach_um = ([\d.]+)", str(refused.value))[1])
    assert plica.polygons_of_centres(near, reach_um=named).pieces.max() == 0
    assert len(plica.polygons_of_centres(np.concatenate([centres, centres[:30] + [120, 0]]), keep="largest")) == 49
    above = np.concatenate([np.column_stack([centres, 0 * centres[:, 0]]), np.column_stack([centres, 0 * centres[:, 0] + 40])])
    with pytest.raises(ValueError, match=r"rows \d+ and \d+ lie above each other: the sheet overhangs"):
        plica.polygons_of_centres(above)
    for bad, said in ((centres[:5], "give .n, 2. or .n, 3."), (centres.ravel(), "give .n, 2. or .n, 3."),
                      (np.where(np.arange(98).reshape(49, 2) == 7, np.nan, centres), "row 3 is")):
        with pytest.raises(ValueError, match=said):
            plica.polygons_of_centres(bad)
    with pytest.raises(ValueError, match="cell_data: gene has no number for polygon 2"):
        plica.polygons_of_centres(centres, cell_data={"gene": np.where(np.arange(49) == 2, np.nan, 1)})
    with pytest.raises(ValueError, match="reach_um: 2; give at least half"):
        plica.polygons_of_centres(centres, reach_um=2)


def monolayer(basal_z=-6.0):
    """Two square cells as tyssue extrudes them: lateral faces are doubled between cells, and rings run outward."""
    pandas = pytest.importorskip("pandas")
    flat = [(x, y) for y in (0, 4) for x in (0, 4, 8)]
    points = [(x, y, 0) for x, y in flat] + [(x, y, basal_z - x / 4) for x, y in flat]
    faces, edges = [], []
    for cell, top in enumerate(([0, 1, 4, 3], [1, 2, 5, 4])):
        bottom = [vertex + 6 for vertex in top]
        sides = [[top[k - 1], bottom[k - 1], bottom[k], top[k]] for k in range(4)]
        for segment, ring in (("apical", top), ("basal", bottom[::-1]), *(("lateral", side) for side in sides)):
            edges += [(a, b, 10 + len(faces), 20 + cell, segment) for a, b in zip(ring, ring[1:] + ring[:1])]
            faces.append((segment, 1))
    return {"vert": pandas.DataFrame(points, columns=list("xyz")),
            "edge": pandas.DataFrame(edges, columns=["srce", "trgt", "face", "cell", "segment"]),
            "face": pandas.DataFrame(faces, columns=["segment", "is_alive"], index=range(10, 10 + len(faces))),
            "cell": pandas.DataFrame({"is_alive": 1}, index=[20, 21])}


def test_monolayers_of_tyssue(tmp_path):
    tables = monolayer()
    for flip in (False, True):  # rings that run inward throughout are turned
        if flip:
            tables["edge"][["srce", "trgt"]] = tables["edge"][["trgt", "srce"]].to_numpy()
        cells = plica.polygons_of_monolayer(tables)
        assert list(cells.cell_data["label"]) == [20, 21] and cells.cell_data["height"] == pytest.approx([6.5, 7.5])
        assert list(cells.areas) == [16, 16] and (cells.points[:, 2] == 0).all()
        x, y = cells.points[cells.faces[0]].T[:2]
        assert (x * np.roll(y, -1) - np.roll(x, -1) * y).sum() > 0
    cells.write(tmp_path / "cells.ply")
    embryo = {"shape": "surface", "file": str(tmp_path / "cells.ply"), "cell_height_array": "height"}
    sim = plica.Simulation(plica.Scenario({"format": 1, "embryo": embryo}))
    assert sorted(sim.cell_data["volume_um3"]) == pytest.approx([16 * 6.5, 16 * 7.5], rel=0.05)
    tables["face"].loc[tables["face"].index >= 16, "is_alive"] = 0
    assert list(plica.polygons_of_monolayer(tables).cell_data["label"]) == [20]


def test_monolayers_as_prisms():
    """Their corners stay where they are, and their volumes."""
    tables = monolayer()
    for flip in (False, True):
        if flip:
            tables["edge"][["srce", "trgt"]] = tables["edge"][["trgt", "srce"]].to_numpy()
        tissue = plica.tissue_of_monolayer(tables)
        assert tissue.volumes == pytest.approx([16 * 6.5, 16 * 7.5]) and list(tissue.cell_data["label"]) == [20, 21]
        assert (tissue.apical[:, 2] == 0).all() and (tissue.basal[:, :2] == tissue.apical[:, :2]).all()
        assert plica.Simulation(plica.Scenario({"format": 1}, tissue=tissue)).cell_data["volume_um3"] == pytest.approx(tissue.volumes)
    tables["edge"].loc[tables["edge"]["trgt"] == 9, "trgt"] = 8
    with pytest.raises(ValueError, match="monolayer: "):
        plica.tissue_of_monolayer(tables)


def test_monolayer_files(tmp_path):
    pytest.importorskip("tables")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of names in columns of objects
        for name, table in monolayer().items():
            table.to_hdf(tmp_path / "layer.hf5", key=name)
    assert plica.polygons_of_monolayer(tmp_path / "layer.hf5").cell_data["height"] == pytest.approx([6.5, 7.5])
    with pytest.raises(plica.ScenarioError, match="three-dimensional cells; .*plica.polygons_of_monolayer"):
        plica.Simulation(plica.Scenario({"format": 1, "embryo": {"shape": "surface", "file": str(tmp_path / "layer.hf5")}}))
    (tmp_path / "bad.hf5").write_text("no HDF5")
    with pytest.raises(plica.FileError, match="bad.hf5: is no HDF5 file with tables vert, edge, face"):
        plica.polygons_of_monolayer(tmp_path / "bad.hf5")


@pytest.mark.parametrize(("change", "said"), [
    (lambda tables: tables.pop("edge"), "there is no table edge"),
    (lambda tables: tables["face"].drop(columns="segment", inplace=True), "table face has no column segment; .*embryo.file reads"),
    (lambda tables: tables["face"].replace({"basal": "lateral"}, inplace=True), "cell 20 has no basal face"),
    (lambda tables: tables["face"].replace({"basal": "apical"}, inplace=True), "cell 20 has two apical faces"),
    (lambda tables: tables["face"].replace({"apical": "top", "basal": "bottom"}, inplace=True), "no face is apical"),
    (lambda tables: tables["edge"].drop(index=1, inplace=True), "the 3 edges of face 10 do not form one ring"),
])
def test_bad_monolayers(change, said):
    tables = monolayer()
    change(tables)
    with pytest.raises(ValueError, match=said):
        plica.polygons_of_monolayer(tables)
