"""Cells as polygons of label images."""
import functools
import re
import warnings

import numpy as np
import plica
import pytest

skimage = pytest.importorskip("skimage")
scipy = pytest.importorskip("scipy")  # which it needs
from scipy import ndimage, spatial  # noqa: E402
from skimage import measure, morphology, segmentation  # noqa: E402


@functools.cache
def voronoi(count, size, seed):
    """Labels of evened random points, and the points, by row and column."""
    points = np.random.default_rng(seed).uniform(0, size, (count, 2))
    pixels = np.stack(np.mgrid[:size, :size], axis=-1).reshape(-1, 2)
    for _ in range(4):
        nearest = spatial.cKDTree(points).query(pixels)[1]
        points = np.column_stack([np.bincount(nearest, pixels[:, axis], count) / np.bincount(nearest, minlength=count) for axis in (0, 1)])
    return 1 + spatial.cKDTree(points).query(pixels)[1].reshape(size, size), points


def voronoi_labels(count, size, seed):
    labels, points = voronoi(count, size, seed)
    return labels.copy(), points


def bricks(size=150, side=30):
    """Square cells in rows that are shifted by half a cell."""
    rows, columns = np.mgrid[:size, :size]
    return 1 + rows // side * 10 + (columns + side // 2 * (rows // side % 2)) // side


def quietly(image, um=1.0, **how):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return plica.polygons_of_labels(image, um, **how)


def same(one, other, px=0.0):
    """Whether cells have the same labels, and each vertex has one of the others within `px`."""
    near = [np.linalg.norm(a.points[:, None] - b.points, axis=2).min(axis=1).max() <= px for a, b in ((one, other), (other, one))]
    return list(one.cell_data["label"]) == list(other.cell_data["label"]) and all(near)


def test_labels_give_back_voronoi_polygons():
    size, um = 400, 0.25
    labels, seeds = voronoi_labels(150, size, 1)
    found = plica.polygons_of_labels(labels, um)
    true = spatial.Voronoi(seeds)
    rim = {*labels[0], *labels[-1], *labels[:, 0], *labels[:, -1]}
    assert set(found.cell_data["label"]) == set(range(1, 151)) - rim
    same = 0
    for face, label, area in zip(found.faces, found.cell_data["label"], found.areas):
        corners = true.vertices[true.regions[true.point_region[label - 1]]]
        corners = um * np.column_stack([corners[:, 1], size - 1 - corners[:, 0]])
        ours = found.points[face][:, :2]
        # To 1.5 pixels: edges shorter than that are one corner.
        assert max(spatial.cKDTree(ours).query(corners)[0].max(), spatial.cKDTree(corners).query(ours)[0].max()) < 1.5 * um
        assert area == pytest.approx((labels == label).sum() * um**2, rel=0.06)
        x, y = ours.T
        assert (x * np.roll(y, -1) - np.roll(x, -1) * y).sum() > 0
        same += len(corners) == len(ours)
    assert same > 0.7 * len(found)
    # Neighbours share their edges: every half-edge inside has its opposite.
    edges = found.to_tables()["edge"]
    assert ((edges["opposite"] >= 0).sum() / len(edges)) > 0.7


def test_lines_between_labels_are_shared_out():
    labels, _ = voronoi_labels(60, 300, 2)
    lines = labels.copy()
    lines[segmentation.find_boundaries(labels, mode="inner")] = 0
    plain, closed = plica.polygons_of_labels(labels, 1), plica.polygons_of_labels(lines, 1)
    assert list(plain.cell_data["label"]) == list(closed.cell_data["label"])
    assert np.allclose(plain.areas, closed.areas, rtol=0.15)
    # Outside of the tissue there is nothing: cells at its rim do not grow.
    island = np.where((np.indices(labels.shape) - 150).astype(float).__pow__(2).sum(axis=0) < 100**2, labels, 0)
    whole = plica.polygons_of_labels(island, 1)
    assert np.linalg.norm(whole.points[:, :2] - [150, 149], axis=1).max() < 101.5


@pytest.mark.parametrize(("image", "um", "said"), [
    (np.zeros((4, 5, 6), int), 1, r"a stack of planes; only flat label images of shape \(rows, columns\)"),
    (np.zeros((4, 4), complex), 1, "whole numbers of shape"),
    ("labels.tif", 1, "image: 'labels.tif'; give an array, by skimage.io.imread"),
    (np.zeros((0, 4), int), 1, "whole numbers of shape"),
    (np.zeros((9, 9), int), 1, "no cell has three corners"),
    (np.full((4, 4), 0.5), 1, r"0.5 at \(0, 0\); give whole numbers"),
    (np.where(np.eye(4) > 0, np.nan, 1.0), 1, r"4 pixels are not finite, the first at \(0, 0\)"),
    (np.ma.masked_equal(np.eye(4, dtype=int), 1), 1, r"4 pixels are masked, the first at \(0, 0\); image.filled\(0\)"),
    (np.random.default_rng(1).integers(0, 50, (60, 60)), 1, "as intensities do"),
    (np.random.default_rng(1).integers(0, 50, (60, 60, 3)), 1, "channels of colours differ"),
    (np.indices((80, 80)).sum(axis=0) // 20 % 2, 1, "two values, 0 and 1, which are no label of each cell"),
    (np.ones((4, 4), int), 0, "um_per_pixel: 0"),
    (np.ones((4, 4), int), float("nan"), "um_per_pixel: nan"),
    (np.ones((9, 9), int), 1, "no cell has three corners"),
])
def test_bad_labels(image, um, said):
    with pytest.raises(ValueError, match=said):
        plica.polygons_of_labels(image, um)


def lined(width, size=160, spacing=30.0):
    """Hexagons with lines of background, `width` pixels wide, along their walls."""
    steps = np.arange(-1, 8)
    centres = np.array([[row * spacing * 0.75**0.5, (column + row % 2 / 2) * spacing] for row in steps for column in steps])
    centres += np.random.default_rng(4).normal(0, 2.5, centres.shape)
    pixels = np.indices((size, size)).reshape(2, -1).T
    first, second = np.argsort(np.linalg.norm(pixels[:, None] - centres, axis=2), axis=1)[:, :2].T
    way = centres[first] - centres[second]
    to_wall = ((pixels - (centres[first] + centres[second]) / 2) * way).sum(axis=1) / np.linalg.norm(way, axis=1)
    return np.where(to_wall < width / 2, 0, first + 1).reshape(size, size)


def test_lines_as_wide_as_promised_are_closed():
    """Up to twice gap_px, at junctions as well: one tissue, with corners where they are without lines."""
    whole = plica.polygons_of_labels(lined(0), 1)
    for width, gap_px in ((1, 1), (2, 1), (3, 2), (4, 2), (6, 3)):
        closed = plica.polygons_of_labels(lined(width), 1, gap_px=gap_px)
        inner = closed.select(np.isin(closed.cell_data["label"], whole.cell_data["label"]))
        assert len(inner) >= len(whole) - 1 and abs(len(closed) - len(whole)) <= 4
        apart = np.linalg.norm(inner.points[:, None] - whole.points, axis=2).min(axis=1)
        assert np.quantile(apart, 0.95) < 2.5, (width, apart)
        free = (closed.to_tables()["edge"]["opposite"] < 0).sum()
        assert free <= (whole.to_tables()["edge"]["opposite"] < 0).sum() + 8, width


@pytest.mark.parametrize(("width", "gap_px"), [(1, 0), (4, 1), (6, 2), (12, 3)])
def test_wider_lines_name_a_gap_that_closes_them(width, gap_px):
    image = lined(width)
    with pytest.raises(ValueError, match=f"wider than {2 * gap_px} pixels; set gap_px = ") as refused:
        plica.polygons_of_labels(image, 1, gap_px=gap_px)
    named = int(re.search(r"set gap_px = (\d+)", str(refused.value))[1])
    assert len(plica.polygons_of_labels(image, 1, gap_px=named)) >= 15 and named <= width / 2 + 1


def test_an_opening_stays_open():
    """A cell that is missing leaves a hole, and the outside is not closed."""
    labels = bricks()
    whole = plica.polygons_of_labels(labels, 1)
    missing = whole.cell_data["label"][4]
    labels[labels == missing] = 0
    with pytest.warns(UserWarning, match="openings in the tissue: 1, the largest of 8.. pixels at row 79, column "):
        cells = plica.polygons_of_labels(labels, 1)
    assert list(cells.cell_data["label"]) == [cell for cell in whole.cell_data["label"] if cell != missing]


def test_small_pieces_and_holes_are_given_to_their_surroundings():
    clean = plica.polygons_of_labels(bricks(), 1)
    for value, said in ((24, r"piece of cell 24 \(1 pixel at row 75, column 75\)"), (99, r"cell 99 \(1 pixel at row 75, "),
                        (-7, r"cell -7 \(1 pixel"), (0, r"hole in cell 23 \(1 pixel ")):
        labels = bricks()
        labels[75, 75] = value
        with pytest.warns(UserWarning, match=said):
            assert same(plica.polygons_of_labels(labels, 1), clean)
    labels = bricks()
    labels[65:80, 65:80] = 0
    with pytest.warns(UserWarning, match=r"hole in cell 23 \(225 pixels at row 65, column 65\)"):
        assert same(plica.polygons_of_labels(labels, 1), clean)
    labels[65:80, 65:80] = 99
    with pytest.warns(UserWarning, match=r"hole in cell 23 \(225 pixels"):
        assert same(plica.polygons_of_labels(labels, 1), clean)


def test_a_cell_within_a_cell_is_refused():
    image = bricks()
    image[62:88, 62:85] = 99
    with pytest.raises(ValueError, match=r"hole in cell 23 \(598 pixels at row 62, column 62\) contains cell 99; ") as refused:
        plica.polygons_of_labels(image, 1)
    exec(re.search(r"99; (.*) fills it", str(refused.value))[1], {"image": image, "scipy": scipy})
    assert same(plica.polygons_of_labels(image, 1), plica.polygons_of_labels(bricks(), 1))


def test_cells_in_pieces_are_named():
    image = bricks()
    image[image == 22] = 34
    with pytest.raises(ValueError, match=r"cell 34 is in pieces, of 900 pixels at row 60, .*skimage.measure.label\(image, connectivity=1"):
        plica.polygons_of_labels(image, 1)
    assert len(plica.polygons_of_labels(measure.label(image, connectivity=1), 1)) == len(plica.polygons_of_labels(bricks(), 1))
    # Pieces that the border cuts are no cells, whatever their number.
    image = bricks()
    image[(image == 21) | (image == 25)] = 7
    assert same(plica.polygons_of_labels(image, 1), plica.polygons_of_labels(bricks(), 1))


@pytest.mark.parametrize("thickness", [1, 4])
def test_outlines_are_labelled(thickness):
    """Lines of an image of two values are found, whichever value they have; the remark names the call that gives its labels."""
    lines = segmentation.find_boundaries(bricks(), mode="inner")
    lines = morphology.skeletonize(lines) if thickness == 1 else morphology.dilation(lines, np.ones((3, 3)))
    lines[:, [0, -1]] = lines[[0, -1]] = True  # as Tissue Analyzer draws them
    white = np.where(lines, 255, 0).astype(np.uint8)
    labelled = plica.polygons_of_labels(measure.label(~lines, connectivity=1), 1)
    assert len(labelled) > 8
    for image in (lines, ~lines, white, 255 - white, np.dstack([white] * 3), np.dstack([white] * 3 + [np.full_like(white, 255)]),
                  white[None], white / 255.0):
        with pytest.warns(UserWarning, match="was taken for lines around") as told:
            assert same(plica.polygons_of_labels(image, 1), labelled)
        call = str(told[0].message).split("labels are those of ")[1]
        names = {"image": image, "numpy": np, "skimage": skimage}
        assert set(labelled.cell_data["label"]) <= set(np.unique(eval(call, names)))


def test_outside_of_outlines_is_no_cell():
    lines = np.zeros((200, 200), dtype=bool)
    for row in range(20, 181, 40):
        lines[row, 20:181] = True
    for column in range(20, 181, 40):
        lines[20:181, column] = True
    framed = lines.copy()
    framed[:, [0, -1]] = framed[[0, -1]] = True  # as images of ForSys are
    for image in (lines, framed):
        cells = quietly(image)
        assert len(cells) == 16 and cells.areas == pytest.approx(1600, rel=0.06)


def test_tissue_in_pieces():
    labels = bricks(300)
    labels[150:210] = 0
    labels[:, :20] = labels[:, 280:] = labels[280:] = 0
    labels[210:, 100:] = 0
    with pytest.raises(ValueError, match=r"the tissue is in 2 pieces, which share no edge, of 38, 10 cells \(cell 72 is in the "
                                         r"second\); keep = \"largest\" omits all but the first"):
        plica.polygons_of_labels(labels, 1)
    cells = plica.polygons_of_labels(labels, 1, keep="largest")
    assert cells.pieces.max() == 0 and len(cells) > 30 and cells.cell_data["label"].max() < 60
    with pytest.raises(ValueError, match="keep: 'first'; give \"all\" or \"largest\""):
        plica.polygons_of_labels(labels, 1, keep="first")


def test_cells_at_the_rim_are_whole():
    """A cell that has few neighbours, or none, keeps the corners of its own."""
    labels = np.zeros((120, 120), dtype=int)
    labels[20:60, 20:60], labels[20:60, 60:100] = 4, 9
    pair = plica.polygons_of_labels(labels, 1)
    assert pair.areas == pytest.approx([1600, 1600], rel=0.06) and [len(face) for face in pair.faces] == [4, 4]
    labels[labels == 9] = 0
    assert plica.polygons_of_labels(labels, 1).areas == pytest.approx([1600], rel=0.06)


def test_openings_that_meet_at_a_point_are_parted(tmp_path):
    rows, columns = np.mgrid[:150, :150]
    labels = 1 + rows // 30 * 5 + columns // 30
    labels[(labels == 7) | (labels == 13)] = 0
    with pytest.warns(UserWarning, match="cells that met at a point only were parted there by a pixel, at 1 places"):
        cells = plica.polygons_of_labels(labels, 1, keep_cut=True)
    assert len(cells) == 23 and len(cells.points) == 37 and cells.areas == pytest.approx(900, rel=0.08)
    cells.write(tmp_path / "cells.ply")
    embryo = {"shape": "surface", "file": str(tmp_path / "cells.ply"), "cell_height_um": 20}
    assert len(plica.Simulation(plica.Scenario({"format": 1, "embryo": embryo})).cell_data["x_um"]) == 23


def test_a_thin_cell_is_refused_with_a_filter_that_helps():
    rng = np.random.default_rng(76)
    image = bricks(120, 20)
    image[np.isin(image, rng.choice(np.unique(image), 12))] = 0
    at = rng.integers(0, 120, (2, 400))
    image[tuple(at)] = rng.choice(np.unique(image), 400)
    with pytest.raises(ValueError, match="cell 44 is too thin or winding") as refused:
        quietly(image, keep_cut=True, keep="largest")
    pytest.importorskip("skimage.filters.rank")
    filtered = eval(str(refused.value).split("smooth all: ")[1], {"image": image, "skimage": skimage})
    assert len(quietly(filtered, keep_cut=True, keep="largest")) == 28


def test_a_stack_is_for_the_function_that_the_error_names():
    with pytest.raises(ValueError, match="a stack of planes.*plica.tissue_of_labels makes cells of a stack"):
        plica.polygons_of_labels(np.stack([bricks()] * 5), 1)


def test_whole_numbers_in_floats_are_labels():
    assert same(plica.polygons_of_labels(bricks().astype(np.float32), 1), plica.polygons_of_labels(bricks(), 1))


def test_colours_become_labels_by_the_call_that_the_error_names():
    flat = bricks()
    image = np.stack([flat % 7, flat % 11, flat % 13], axis=-1).astype(np.uint8)
    with pytest.raises(ValueError, match="channels of colours differ") as refused:
        plica.polygons_of_labels(image, 1)
    call = re.search(r"give (image\[.*2\]) after", str(refused.value))[1]
    cells = plica.polygons_of_labels(eval(call, {"image": image.astype(int)}), 1)
    assert len(cells) == len(plica.polygons_of_labels(flat, 1))


def test_damaged_images_become_a_tissue_or_an_error_with_a_remedy(tmp_path):
    """Lines, salt, missing cells, a region cut out, merged labels: plica accepts the polygons."""
    accepted = 0
    for seed in range(8):
        rng = np.random.default_rng(seed)
        image = bricks(140, 20)
        if rng.random() < 0.5:
            image[ndimage.distance_transform_edt(~segmentation.find_boundaries(image, mode="inner")) < rng.uniform(0.5, 3)] = 0
        if rng.random() < 0.5:
            image[tuple(rng.integers(0, 140, (2, 150)))] = rng.choice(np.unique(image), 150)
        if rng.random() < 0.4:
            image[np.isin(image, rng.choice(np.unique(image), 4))] = 0
        if rng.random() < 0.4:
            image[((np.indices(image.shape) - rng.uniform(50, 90, 2)[:, None, None]) ** 2).sum(axis=0) > rng.uniform(40, 70) ** 2] = 0
        if rng.random() < 0.2:
            one, other = rng.choice(np.unique(image[image > 0]), 2)
            image[image == one] = other
        try:
            cells = quietly(image, keep_cut=bool(rng.random() < 0.5), keep="largest")
        except ValueError as error:
            assert re.match("image: .*; ", str(error))
            continue
        cells.write(tmp_path / "cells.ply")
        embryo = {"shape": "surface", "file": str(tmp_path / "cells.ply"), "cell_height_um": 12}
        plica.Simulation(plica.Scenario({"format": 1, "embryo": embryo}))
        accepted += 1
    assert accepted >= 6
