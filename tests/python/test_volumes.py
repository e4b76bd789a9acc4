"""Cells as prisms of volumes of labels. damaged_volumes.py makes many more damages."""
import functools
import os
import re
import subprocess
import sys
import tomllib
import warnings
from pathlib import Path

import damaged_volumes
import numpy as np
import plica
import pytest
from drawn_tissues import Cyst, Tube, disagreement, pairs_of
from plica.volumes import large_cells
from plica.voxel_columns import evened, without_idle

pytest.importorskip("scipy")
HALF = (0.5, 0.5, 0.5)


@functools.cache
def drawn(kind, spacing=HALF):
    tissue = {"cyst": lambda: Cyst(80, axes=(14, 14, 14), height=6, seed=2),
              "egg": lambda: Cyst(120, axes=(24, 12, 12), height=6, seed=2),
              "tube": lambda: Tube(80, radius=12, length=30, height=6, seed=2),
              "sheet": lambda: Tube(80, radius=30, length=34, height=8, sector=1.2, seed=2)}[kind]()
    labels, origin = tissue.labels(spacing)
    return labels, origin, tissue


def made(labels, spacing=HALF, apical="outside", **how):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return plica.tissue_of_labels(labels, spacing, apical=apical, **how)


def test_figures_of_drawn_tissues():
    """Neighbours, corners, volumes and elements of each kind, against the drawing."""
    shares, off, volumes, jacobians = [], [], [], []
    for kind, apical in (("cyst", "inside"), ("egg", "outside"), ("tube", "inside"), ("sheet", "outside")):
        labels, origin, drawing = drawn(kind)
        tissue = made(labels, apical=apical)
        assert len(tissue.cells) == len(drawing.seeds), kind
        assert not any("two cells may have one label" in remark for remark in tissue.remarks), kind
        right, far = disagreement(tissue, drawing, origin, apical)
        shares.append(right)
        off += far.tolist()
        volumes += abs(tissue.quality.volume_error).tolist()
        jacobians.append(tissue.quality.scaled_jacobian.min())
    assert np.mean(shares) > 0.98, shares
    assert np.median(off) / 0.5 < 1 and np.median(volumes) < 0.03
    assert min(jacobians) > 0.15, jacobians


def test_apical_side():
    labels, origin, drawing = drawn("cyst")
    inside, outside = made(labels, apical="inside"), made(labels)
    assert np.allclose(inside.apical, outside.basal) and np.allclose(inside.basal, outside.apical)
    far = np.linalg.norm(outside.apical + origin, axis=1)
    assert np.median(far) == pytest.approx(17, abs=0.5)
    axis = np.argwhere(np.ones(labels.shape)).reshape(*labels.shape, 3) * 0.5 + origin[::-1]
    assert np.allclose(made(labels, apical=np.linalg.norm(axis, axis=3)).apical, outside.apical)
    with pytest.raises(ValueError, match="apical is not known; the layer is bent around an inside: give \"outside\" or"):
        plica.tissue_of_labels(labels, HALF)
    with pytest.raises(ValueError, match="no side of the layer faces there"):
        plica.tissue_of_labels(labels, HALF, apical="+z")
    sheet = drawn("sheet")[0]
    up = made(sheet, apical="+z")
    assert np.median(up.apical[:, 2] - up.basal[:, 2]) > 5
    assert np.allclose(made(sheet, apical="-z").apical, up.basal)


def test_cells_have_their_numbers():
    labels, _, _ = drawn("tube")
    tissue = made(np.where(labels > 0, labels.astype(np.int64) * 1000 + 7, 0), apical="outside")
    assert set(tissue.cell_data["label"]) <= {1000 * label + 7 for label in range(1, 81)}
    worst = tissue.cell_data["label"][np.argmax(abs(tissue.quality.volume_error))]
    assert f"at most, in cell {worst:.0f}\n" in repr(tissue.quality)
    assert np.median(tissue.cell_data["height_um"]) == pytest.approx(6, rel=0.05)
    assert np.median(tissue.cell_data["taper"]) == pytest.approx(15 / 9, rel=0.1)
    volume = (labels == tissue.cell_data["label"][0] // 1000).sum() / 8
    assert tissue.cell_data["label_volume_um3"][0] == pytest.approx(volume, rel=1e-12)


@pytest.mark.parametrize(("damage", "kind", "spacing", "said"), [
    ("noise", "cyst", HALF, "small pieces given to the surroundings"),
    ("holes", "egg", HALF, "small holes? filled"),
    ("gaps", "tube", HALF, "gaps between cells were closed: .. % of the tissue, the first at plane"),
    ("merged", "cyst", HALF, "two cells may have one label"),
    ("split", "sheet", HALF, None),
    ("missing", "cyst", HALF, "openings? of .* edges in the layer, .*at plane"),
    ("cut", "sheet", HALF, "cut by the border of the image, and omitted: .* cells .*; the first at plane"),
    ("lower", "cyst", HALF, None),
    ("rough_walls", "cyst", damaged_volumes.FLAT, None),
    ("missing", "sheet", damaged_volumes.FLAT, "flat or turned corners were evened out in"),
])
def test_damage_is_repaired_and_reported(damage, kind, spacing, said):
    labels, _, drawing = drawn(kind, spacing)
    volume = damaged_volumes.DAMAGES[damage](labels, np.random.default_rng(4))
    tissue = made(volume, spacing)
    if damage == "cut":  # what the border of the image does not touch, and nothing else
        border = {label for axis in range(3) for place in (0, -1) for label in np.unique(np.take(volume, place, axis))}
        assert set(tissue.cell_data["label"]) == {*np.unique(volume)} - border - {0}
    else:
        assert len(tissue.cells) > 0.5 * len(drawing.seeds)
    assert len(pairs_of(tissue) & drawing.neighbours()) > 0.9 * len(pairs_of(tissue)), damage
    assert tissue.quality.scaled_jacobian.min() > 0.1
    if said:
        assert any(re.search(said, remark) for remark in tissue.remarks), tissue.remarks


def places(remarks, margin=0):
    """Return remarks with their places moved by a margin."""
    return [re.sub(r"(plane|row|column) (-?\d+)", lambda found: f"{found[1]} {int(found[2]) - margin}", one) for one in remarks]


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("ends", [(True, True), (True, False), (False, True)])
def test_cut_cells_are_kept_as_in_an_image_with_a_margin(axis, ends):
    """The border does not join cells at opposite ends of the image, also with gaps between cells."""
    along = np.moveaxis(drawn("tube")[0], 2, 0)
    volume = np.moveaxis(along[9 * ends[0]:len(along) - 9 * ends[1]], 0, axis)
    assert (np.take(volume, 0, axis).any(), np.take(volume, -1, axis).any()) == ends
    for one, gap_px in ((volume, 1), (damaged_volumes.gaps(volume, None), 1), (volume, 3)):
        kept, wide = made(one, keep_cut=True, gap_px=gap_px), made(np.pad(one, 2), gap_px=gap_px)
        assert np.array_equal(kept.cell_data["label"], wide.cell_data["label"])
        assert np.allclose(kept.apical + 1, wide.apical) and np.allclose(kept.basal + 1, wide.basal)
        assert kept.quality.neighbours_right > 0.95 and pairs_of(kept) == pairs_of(wide)
        assert [remark for remark in kept.remarks if "-1" in remark] == []
        assert kept.remarks == places(wide.remarks, 2)
        assert gap_px > 1 or one is not volume or not any("gaps" in remark for remark in kept.remarks)


def test_wide_gaps_are_closed_in_the_tissue_only():
    """Labels that begin a voxel from the border are closed as those far from it."""
    labels = drawn("sheet")[0]
    box = tuple(slice(max(at.min() - 1, 0), at.max() + 2) for at in np.nonzero(labels))
    near, far = made(labels[box], gap_px=3), made(np.pad(labels[box], 8), gap_px=3)
    assert np.allclose(near.apical + 4, far.apical) and pairs_of(near) == pairs_of(far)
    assert near.remarks == places(far.remarks, 8)


def test_large_cells_of_a_tissue_with_cells_of_many_sizes_are_not_suspected():
    """Logarithms of areas of a frog's epithelium (ForSys) vary by 0.4: some cells have twice the usual size."""
    sizes = np.random.default_rng(1).normal(size=100)
    for spread, suspected in ((0.1, True), (0.4, False)):
        assert large_cells(np.append(np.exp(spread * sizes), 2))[-1] == suspected


def test_corners_of_two_cells_only_are_left_out():
    """Along the common edge of two cells, both polygons cannot be convex at a corner."""
    rings = {1: [0, 1, 2, 6, 7, 3], 2: [2, 4, 5, 3, 7, 6], 3: [1, 8, 4, 2]}  # 6 and 7 between 2 and 3; three cells meet at 2
    assert without_idle(rings) == {1: [0, 1, 2, 3], 2: [2, 4, 5, 3], 3: [1, 8, 4, 2]}
    triangles = {1: [0, 1, 2], 2: [0, 2, 1]}
    assert without_idle(triangles) == triangles


def test_turned_corners_are_evened_out():
    """A hexagonal prism with a corner pushed to the other side becomes convex and upright; a right one stays."""
    angles = np.arange(6) * np.pi / 3
    middle = np.column_stack([np.zeros(6), np.sin(angles), np.cos(angles)])
    first, second = middle - [1, 0, 0], middle + [1, 0, 0]
    same = evened(first, second, middle, {1: [*range(6)]}, 0.1)
    assert same.moved == same.flawed == [] and np.array_equal(same.first, first)
    first[0] = -0.5 * first[0] - [1, 0, 0]
    found = evened(first, second, middle, {1: [*range(6)]}, 0.1)
    assert found.moved == [1] and found.flawed == []
    spokes = found.first[:, 1:] - found.first[:, 1:].mean(axis=0)
    ways = np.roll(spokes, -1, axis=0) - spokes
    turns = ways[:, 0] * np.roll(ways, -1, axis=0)[:, 1] - ways[:, 1] * np.roll(ways, -1, axis=0)[:, 0]
    assert (turns < 0).all() or (turns > 0).all()


def test_scutoids_are_counted():
    labels, _ = Tube(60, radius=30, length=30, height=10, sector=1.0, seed=5, exchange=1.5).labels(HALF)
    tissue = made(labels)
    assert any("touch on one side only (scutoids)" in remark for remark in tissue.remarks), tissue.remarks
    assert len(tissue.cells) >= 58


@pytest.mark.parametrize(("volume", "spacing", "said"), [
    (np.zeros((4, 5, 6), int), HALF, "no cells; every voxel has label 0"),
    (np.zeros((4, 5), int), HALF, "one plane; plica.polygons_of_labels reads flat"),
    (np.zeros((4, 5), int), None, "one plane; plica.polygons_of_labels reads flat"),
    (np.zeros((2, 2, 4, 5, 6), int), HALF, "one channel and one time"),
    (np.full((4, 5, 6), 0.5), HALF, "values that are no whole numbers"),
    (np.random.default_rng(1).integers(0, 60_000, (30, 30, 30)), HALF, "as intensities have; segment the image first"),
    (np.random.default_rng(1).integers(0, 256, (30, 30, 30)), HALF, "labels lie in .* pieces, as intensities do; segment the image first"),
    (np.ones((9, 9, 9), int), HALF, "no cell reaches from one free side to the other; .* both sides$"),
    (np.ones((9, 9, 9), bool), HALF, "two values"),
    (255 * np.pad(np.ones((9, 9, 9), np.uint8), 2), HALF, "two values, which are no label of each cell"),
    (np.ones((9, 9, 9), int), (1, 0, 1), r"spacing_um: \(1, 0, 1\); give three numbers above 0"),
    (np.ones((9, 9, 9), int), None, "spacing_um: None; give three numbers"),
])
def test_bad_volumes(volume, spacing, said):
    with pytest.raises(ValueError, match=said):
        plica.tissue_of_labels(volume, spacing, apical="outside")


def test_wide_gaps_are_named():
    labels = damaged_volumes.gaps(drawn("tube")[0], None)
    with pytest.raises(ValueError, match=r"7. of 80 cells have no wall to another: raise gap_px, now 0$"):
        made(labels, gap_px=0)


def test_sizes_and_spacings_are_told():
    """Median sizes, and remarks on a spacing in another unit or order."""
    labels = drawn("tube")[0]
    right = made(labels)
    height, width, *extent = (float(word) for word in re.findall(r"\d[\d.]*", right.sizes))
    assert height == pytest.approx(6, rel=0.05) and width == pytest.approx((2 * np.pi * 12 * 30 / 80)**0.5, rel=0.1)
    assert extent == pytest.approx([30, 30, 30], abs=1) and right.sizes in repr(right)
    assert not any("spacing" in remark for remark in right.remarks)
    for spacing, said in (((500, 500, 500), r"cells are 61.0 µm high \(median\): check that the spacing is in µm"),
                          ((5e-7, 5e-7, 5e-7), "cells are 6.0.e-06 µm high"),
                          ((0.3, 0.3, 0.5), r"spacing_um = \(0.3, 0.3, 0.5\): rows and columns differ; check the order, which is planes, rows"),
                          ((0.3, 0.5, 0.5), "planes are finer than columns")):
        assert re.search(said, made(labels, spacing).remarks[0]), spacing
    assert not any("spacing" in remark for remark in made(labels, (1, 0.5, 0.5)).remarks)


def test_equal_remarks_are_one():
    """Labels that stand for two cells each, and several openings."""
    labels = drawn("tube")[0]
    for count, said in ((1, "^a piece of cell 1 .* was taken for a cell of its own"), (3, "^3 pieces of cells 1, 2, 3 were taken for cells of")):
        twice = np.where((labels > 40) & (labels <= 40 + count), labels - 40, labels)
        assert len([remark for remark in made(twice).remarks if re.search(said, remark)]) == 1, count
    middle = drawn("tube")[2].seeds.mean(axis=0)
    gone = 1 + drawn("tube")[2].tree.query(middle + [[0, 12, 0], [0, -12, 0]])[1]
    remarks = made(np.where(np.isin(labels, gone), 0, labels)).remarks
    assert any(re.search(r"^2 openings of \d, \d edges in the layer, the first at plane \d+", remark) for remark in remarks), remarks


def test_prisms_make_scenarios_and_files(tmp_path):
    tissue = made(drawn("sheet")[0])
    scenario = plica.Scenario({"format": 1, "time": {"end_s": 1}}, tissue=tissue)
    assert scenario["embryo.shape"] == "prisms"
    simulation = plica.Simulation(scenario)
    assert np.allclose(simulation.cell_data["label"], tissue.cell_data["label"])
    tissue.write(tmp_path / "cells.ply")
    read = plica.Simulation(plica.Scenario({"format": 1, "embryo": {"shape": "prisms", "file": str(tmp_path / "cells.ply")}}))
    places = [one.positions[np.lexsort(one.positions.round(6).T)] for one in (read, simulation)]  # in another order
    assert np.allclose(*places, atol=1e-9)
    with pytest.raises(ValueError, match="has no arrays"):
        tissue.write(tmp_path / "cells.obj")


def test_prisms_from_arrays():
    square = np.array([[0, 0], [10, 0], [20, 0], [0, 10], [10, 10], [20, 10]], dtype=float)
    basal = np.column_stack([square, np.zeros(6)])
    apical = np.column_stack([square * 1.2 + [3, 0], np.full(6, 30.0)])
    tissue = plica.Tissue.from_prisms(apical, basal, [[0, 1, 4, 3], [1, 2, 5, 4]], cell_data={"gene": [1, 2]}, regions={"left": [True, False]})
    assert tissue.volumes == pytest.approx([30 * 100 * (1 + 1.2 + 1.44) / 3] * 2)
    simulation = plica.Simulation(plica.Scenario({"format": 1, "region": {"left": {"array": "left"}}}, tissue=tissue))
    assert simulation.cell_data["gene"].tolist() == [1, 2]
    for changed, said in (({"basal": basal[:5]}, "basal: shape"), ({"cells": [[0, 1, 9]]}, "faces: polygon 0 has vertices")):
        with pytest.raises(ValueError, match=said):
            plica.Tissue.from_prisms(**{"apical": apical, "basal": basal, "cells": [[0, 1, 4, 3]], **changed})
    with pytest.raises(plica.ScenarioError, match="order corners counter-clockwise seen from the apical side"):
        plica.Simulation(plica.Scenario({"format": 1}, tissue=plica.Tissue.from_prisms(apical, basal, [[0, 3, 4, 1]])))


def test_files(tmp_path):
    labels, _, _ = drawn("tube")
    np.save(tmp_path / "a.npy", labels)
    np.savez(tmp_path / "a.npz", labels)
    files = [("a.npy", None), ("a.npz", None)]
    if tifffile := pytest.importorskip("tifffile"):
        tifffile.imwrite(tmp_path / "a.tif", labels)
        tifffile.imwrite(tmp_path / "ij.tif", labels, imagej=True, resolution=(4, 4), metadata={"spacing": 0.5, "unit": "um", "axes": "ZYX"})
        tifffile.imwrite(tmp_path / "b.ome.tif", labels, metadata={"axes": "ZYX", "PhysicalSizeX": 250, "PhysicalSizeXUnit": "nm",
                                                                 "PhysicalSizeY": 0.25, "PhysicalSizeZ": 0.5})
        files += [("a.tif", None), ("ij.tif", (0.5, 0.25, 0.25)), ("b.ome.tif", (0.5, 0.25, 0.25))]
    from plica.label_files import read_labels

    for name, spacing in files:
        found, of_file = read_labels(tmp_path / name)
        assert np.array_equal(found, labels), name
        assert of_file == pytest.approx(spacing) if spacing else of_file is None, name
    with pytest.raises(plica.FileError, match="there is no such file"):
        read_labels(tmp_path / "b.tif")
    with pytest.raises(plica.FileError, match="is no volume of labels; give .tif"):
        read_labels(tmp_path / "b.czi")
    (tmp_path / "c.tif").write_text("nothing")
    with pytest.raises(plica.FileError, match="c.tif: cannot be read"):
        read_labels(tmp_path / "c.tif")


def test_zarr(tmp_path):
    zarr = pytest.importorskip("zarr")
    from plica.label_files import read_labels

    labels, _, _ = drawn("tube")
    zarr.save(str(tmp_path / "a.zarr"), labels)
    assert np.array_equal(read_labels(tmp_path / "a.zarr")[0], labels)
    group = zarr.open_group(str(tmp_path / "b.zarr"), mode="w")
    group["0"] = labels
    axes = [{"name": name, "type": "space", "unit": "micrometer"} for name in "zyx"]
    group.attrs["multiscales"] = [{"axes": axes, "datasets": [{"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [0.5, 0.2, 0.2]}]}]}]
    found, spacing = read_labels(tmp_path / "b.zarr")
    assert np.array_equal(found, labels) and spacing == pytest.approx((0.5, 0.2, 0.2))
    several = zarr.open_group(str(tmp_path / "c.zarr"), mode="w")
    several["nuclei"], several["cells"] = labels + 1, labels
    with pytest.raises(plica.FileError, match="give the path of one array"):
        read_labels(tmp_path / "c.zarr")
    assert np.array_equal(read_labels(tmp_path / "c.zarr/cells")[0], labels)


def test_command(tmp_path):
    np.save(tmp_path / "labels.npy", drawn("tube")[0])
    words = [sys.executable, "-m", "plica", "labels", str(tmp_path / "labels.npy"), "--spacing-um", "0.5", "0.5", "0.5", "--out",
             str(tmp_path / "cells.vtp")]
    asked = subprocess.run(words, capture_output=True, text=True)
    assert asked.returncode == 2 and "which side of the layer is apical is not known" in asked.stderr
    done = subprocess.run([*words, "--apical", "inside"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert re.search(r"cells.vtp: 80 cells, 6.11 µm high and 5.36 µm wide .*; tissue 30.5 × .* µm \(x, y, z\)\nneighbours right: ", done.stdout), done.stdout
    assert "\ngood: neighbours over 95 %" in done.stdout
    lines = done.stdout.split("In a scenario:\n")[1]
    scenario = plica.Scenario({"format": 1, **tomllib.loads(lines)})
    assert len(plica.Simulation(scenario).cell_data["label"]) == 80
    again = subprocess.run([*words, "--apical", "inside"], capture_output=True, text=True)
    assert again.returncode == 4 and "exists; set --overwrite" in again.stderr
    down = subprocess.run([*words, "--apical", "-z", "--overwrite"], capture_output=True, text=True)
    assert 'apical: "-z", but no side of the layer faces there' in down.stderr
    np.save(tmp_path / "cut.npy", drawn("tube")[0][:, :, 9:-9])
    words[4] = str(tmp_path / "cut.npy")
    cut = subprocess.run([*words, "--apical", "inside", "--overwrite"], capture_output=True, text=True)
    assert "; --keep-cut keeps them\n" in cut.stdout and "keep_cut" not in cut.stdout, cut.stdout
    words[6] = "0.8"
    swapped = subprocess.run([*words, "--apical", "inside", "--overwrite"], capture_output=True, text=True)
    assert "note: --spacing-um" not in swapped.stdout
    words[6:9] = ["0.5", "0.5", "0.8"]
    swapped = subprocess.run([*words, "--apical", "inside", "--overwrite"], capture_output=True, text=True)
    assert "note: --spacing-um 0.5 0.5 0.8: rows and columns differ; check the order" in swapped.stdout
    nowhere = subprocess.run([*words[:5], *words[9:], "--apical", "inside", "--overwrite"], capture_output=True, text=True)
    assert "cut.npy: --spacing-um: not in the file; give three numbers" in nowhere.stderr


@pytest.mark.skipif("PLICA" not in os.environ, reason="PLICA names the program")
def test_the_program_hands_over(tmp_path):
    np.save(tmp_path / "labels.npy", drawn("tube")[0])
    path = {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    words = [os.environ["PLICA"], "labels", str(tmp_path / "labels.npy"), "--spacing-um", "0.5", "0.5", "0.5", "--apical", "inside"]
    done = subprocess.run([*words, "--out", str(tmp_path / "cells.ply")], env={**os.environ, **path}, capture_output=True, text=True)
    assert done.returncode == 0 and "cells.ply: 80 cells" in done.stdout, done.stderr
    refused = subprocess.run(words, env={**os.environ, **path}, capture_output=True, text=True)
    assert refused.returncode == 2 and "--out" in refused.stderr
    own, whole = (subprocess.run([*one, "labels", "--help"], capture_output=True, text=True).stdout
                  for one in ([os.environ["PLICA"]], [sys.executable, "-m", "plica"]))
    assert {*re.findall(r"--[a-z-]+", own)} == {*re.findall(r"--[a-z-]+", whole)}
