"""Shapes of cells in movies of labels: places, areas, corners, noise, wrong labels, links and refusals."""
import functools
import warnings

import numpy as np
import plica
import pytest
from drawn_tissues import Cyst
from plica.frame_labels import voxels_of
from plica.whole_cells import label_moments

spatial = pytest.importorskip("scipy.spatial")
draw = pytest.importorskip("skimage.draw")
PIXEL_UM, SIDE = 0.25, 120
TIMES = np.arange(7.0)


def places(time):
    """Seeds of 36 cells, which move steadily, in pixels."""
    seeds = (np.indices((6, 6)).reshape(2, -1).T + 0.5) * SIDE / 6 + np.random.default_rng(1).uniform(-4, 4, (36, 2))
    away = seeds - SIDE / 2
    return seeds - 0.008 * time * away * (1 + away[:, :1] / SIDE)


@functools.cache
def drawn(speed=1):
    pixels = np.indices((SIDE, SIDE)).reshape(2, -1).T
    movie = [1 + spatial.cKDTree(places(speed * time)).query(pixels)[1].reshape(SIDE, SIDE) for time in TIMES]
    cells = plica.polygons_of_labels(movie[0], PIXEL_UM)
    return movie, cells


def shapes_of(movie, cells, **how):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return plica.shapes_of_labels(dict(zip(TIMES, movie)), PIXEL_UM, cells=cells, **how)


def test_places_areas_and_corners_of_images():
    movie, cells = drawn()
    shapes = shapes_of(movie, cells)
    assert list(shapes) == TIMES.tolist() and len(shapes) == 7 and not shapes.doubtful.any() and not shapes.remarks
    assert np.array_equal(shapes.labels, cells.cell_data["label"])
    assert np.isnan(shapes[3]["centres_um"][:, 2]).all() and np.isnan(shapes.heights_um).all()
    for time in (0, 6):
        for cell, label in enumerate(shapes.labels):
            row, column = np.argwhere(movie[time] == label).mean(axis=0)
            assert shapes[time]["centres_um"][cell, :2] == pytest.approx([PIXEL_UM * column, PIXEL_UM * (SIDE - 1 - row)])
            assert shapes[time]["areas_um2"][cell] == pytest.approx(PIXEL_UM**2 * (movie[time] == label).sum())
    known = np.isfinite(shapes.corners_um[0, :, 0])  # but not corners of one cell with two that are cut, of which it may have several
    assert known.mean() > 0.5 and np.array_equal(shapes.corners_um[0, known, :2], cells.points[known, :2])
    again = plica.polygons_of_labels(movie[6], PIXEL_UM)
    seen = np.isfinite(shapes.corners_um[6, :, 0])
    apart = spatial.cKDTree(again.points[:, :2]).query(shapes.corners_um[6, seen, :2])[0]
    assert seen.sum() > 0.8 * known.sum() and apart.max() < 1e-9
    assert 0.01 * PIXEL_UM < shapes.noise_um < 0.5 * PIXEL_UM
    table = shapes.table()
    assert len(table) == 7 * len(cells) and table[table.time_min == 6].x_um.to_numpy() == pytest.approx(shapes.centres_um[6, :, 0])
    outline = set(shapes.rim.tolist())
    edges = [frozenset(pair) for face in cells.faces for pair in zip(face.tolist(), np.roll(face, -1).tolist())]
    assert outline == {corner for edge in edges if edges.count(edge) == 1 for corner in edge}


def test_wrong_labels_are_doubtful_and_links_join_daughters():
    movie, cells = drawn()
    clean = shapes_of(movie, cells)
    label, other = clean.labels[5], clean.labels[6]
    wrong = [image.copy() for image in movie]
    wrong[2][wrong[2] == other] = label                       # merged
    upper = (wrong[4] == label) & (np.indices((SIDE, SIDE))[0] < np.argwhere(wrong[4] == label)[:, 0].mean())
    wrong[4][upper] = 999                                     # cut in two
    shapes = shapes_of(wrong, cells)
    assert set(np.flatnonzero(shapes.doubtful[:, 5])) == {2, 4} and shapes.doubtful.sum() == 2
    assert np.isnan(shapes[2.0]["areas_um2"][[5, 6]]).all() and np.isnan(shapes[4.0]["centres_um"][5]).all()
    assert np.isfinite(shapes.areas_um2[2, 5]) and np.isnan(shapes.areas_um2[2, 6])
    assert f"1 cell is doubtful in 2 of {len(TIMES)} frames: {label}" in shapes.remarks
    assert shapes.noise_um == pytest.approx(clean.noise_um, rel=0.3)
    # Daughters are taken together, and each frame may have other numbers.
    links = [(time, name, name) for time in TIMES for name in np.unique(wrong[int(time)]) if name != 999]
    joined = shapes_of(wrong, cells, links=[*links, (4, 999, label)])
    assert not joined.doubtful[4].any() and joined.areas_um2[4, 5] == clean.areas_um2[4, 5]
    renamed = [image + 1000 * number for number, image in enumerate(movie)]
    numbers = [(time, name + 1000 * int(time), name) for time in TIMES for name in np.unique(movie[0])]
    assert np.array_equal(shapes_of(renamed, cells, links=numbers).centres_um, clean.centres_um, equal_nan=True)


@pytest.mark.parametrize("how", [
    "right, gone, right, merged, cut, cut, right",     # taken away one by one, 2 and 6 went and 4 and 5 stayed
    "gone, cut, right, merged, right, merged, right",  # none was left
])
def test_wrong_labels_around_a_gap_are_told_together(how):
    movie, cells = drawn()
    label, other = cells.cell_data["label"][5:7].astype(int)
    images = [image.copy() for image in movie]
    for image, one in zip(images, how.split(", ")):
        if one == "merged":
            image[image == other] = label
        elif one != "right":
            upper = np.indices(image.shape)[0] < np.argwhere(image == label)[:, 0].mean()
            image[(image == label) & (upper | (one == "gone"))] = 999
    wrong = [one in ("merged", "cut") for one in how.split(", ")]
    doubtful = shapes_of(images, cells).doubtful
    assert doubtful[:, 5].tolist() == wrong and doubtful.sum() == sum(wrong)


def test_a_wrong_first_frame_leaves_later_ones():
    movie, cells = drawn()
    shapes = shapes_of(movie, cells)
    label, other = shapes.labels[5], shapes.labels[6]
    first = np.where(movie[0] == other, label, movie[0])
    merged = plica.polygons_of_labels(first, PIXEL_UM)
    shapes = shapes_of([first, *movie[1:]], merged)
    cell = int(np.flatnonzero(shapes.labels == label)[0])
    assert shapes.doubtful[0, cell] and not shapes.doubtful[1:, cell].any() and shapes.doubtful.sum() == 1


def test_missing_cells_make_no_others_doubtful():
    movie, cells = drawn(speed=4)
    later = [image.copy() for image in movie]
    later[3][np.isin(later[3], np.unique(movie[0][:, 5 * SIDE // 8:]))] = 0
    shapes = shapes_of(later, cells)
    assert np.isnan(shapes.areas_um2[3]).sum() > 5 and not shapes.doubtful.any()


def test_a_first_label_of_two_cells_is_left_out():
    movie, cells = drawn()
    label, other = shapes_of(movie, cells).labels[5:7]
    first = np.where(movie[0] == other, label, movie[0])
    shapes = shapes_of([first, *movie[1:]], plica.polygons_of_labels(first, PIXEL_UM))
    cell = int(np.flatnonzero(shapes.labels == label)[0])
    assert all(np.isnan(shapes[time]["areas_um2"][cell]) for time in TIMES) and np.isfinite(shapes[3]["areas_um2"]).sum() == len(shapes.labels) - 1


def test_a_label_that_passes_to_another_cell_is_left_out():
    """As where two cells are merged in a frame, and one of them is missing from then on."""
    movie, cells = drawn()
    right = shapes_of(movie, cells)
    alike = np.abs(np.log(right.areas_um2[0][:, None] / right.areas_um2[2])) < 0.05
    near = np.linalg.norm(right.centres_um[0][:, None, :2] - right.centres_um[2][:, :2], axis=2) < 1.5 * np.sqrt(np.median(right.areas_um2[0]))
    cell, other = np.argwhere(alike & near & ~np.eye(len(alike), dtype=bool))[0]
    later = [image.copy() for image in movie]
    for image in later[2:]:
        image[image == right.labels[cell]] = 999
        image[image == right.labels[other]] = right.labels[cell]
    shapes = shapes_of(later, cells)
    assert shapes.doubtful[:, cell].tolist() == 2 * [True] + 5 * [False]
    assert all(np.isnan(shapes[time]["centres_um"][cell]).all() for time in TIMES) and np.isfinite(shapes[1]["areas_um2"]).sum() == len(alike) - 2


def test_moments_of_labels():
    numbers = np.random.default_rng(1).integers(0, 4, (5, 6, 7))
    spacing, origin = np.array([0.5, 0.3, 0.2]), np.array([1.0, 2, 3])
    volumes, centroids, moments = label_moments(numbers, 2, spacing, origin)
    for cell in (0, 1):
        places = (np.argwhere(numbers == cell + 1) * spacing + origin)[:, ::-1]
        spread = np.cov(places.T, bias=True) + np.diag(spacing[::-1]**2) / 12
        assert volumes[cell] == pytest.approx(len(places) * 0.03) and centroids[cell] == pytest.approx(places.mean(axis=0))
        assert moments[cell] == pytest.approx(spread[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]])


def test_volumes():
    drawing = Cyst(60, axes=(12, 12, 12), height=5, seed=2)
    labels, _ = drawing.labels((0.5, 0.5, 0.5))
    shifted = np.roll(labels, 1, axis=2)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        tissue = plica.tissue_of_labels(labels, (0.5, 0.5, 0.5), apical="inside")
        shapes = plica.shapes_of_labels({0: labels, 1: shifted}, (0.5, 0.5, 0.5), cells=tissue, apical="inside")
    for moved in (shapes.centres_um[1] - shapes.centres_um[0], shapes[1]["centroids_um"] - shapes[0]["centroids_um"]):
        assert moved == pytest.approx(np.tile([0.5, 0, 0], (len(tissue.cells), 1)), abs=1e-9)
    assert shapes[1]["moments_um2"] == pytest.approx(shapes[0]["moments_um2"]) and list(shapes[1]) == ["centroids_um", "moments_um2"]
    sizes = np.bincount(labels.ravel())[shapes.labels] / 8  # before repairs
    assert shapes.volumes_um3[0] == pytest.approx(sizes, rel=0.02)
    assert shapes.corners_um[0] == pytest.approx(tissue.apical) and shapes.corners_um[1] == pytest.approx(tissue.apical + [0.5, 0, 0])
    assert shapes.heights_um[1] == pytest.approx(tissue.heights) and len(shapes.rim) == 0
    assert shapes.noise_um == 0.25 and "noise_um is half a pixel" in shapes.remarks[-1]


def test_tensions_follow_from_images(tmp_path):
    """Images of a sheet of 16 cells before and after it has contracted: hidden factors are recovered."""
    pixel_um, laws = 0.4, {"cortex": {"apical": {"region": "all", "tension_mN_per_m": 2, "saturation_ratio": 0.2}},
                           "elasticity": {"young_modulus_Pa": 300}, "time": {"end_min": 1}, "stop": {"at_equilibrium": False}}
    first = np.pad(1 + np.arange(16).reshape(4, 4).repeat(30, axis=0).repeat(30, axis=1), 10)
    cells = plica.polygons_of_labels(first, pixel_um)
    cells.write(tmp_path / "cells.ply")
    scenario = plica.Scenario({"embryo": {"shape": "surface", "file": str(tmp_path / "cells.ply"), "cell_height_um": 8, "rim": "held"}, **laws})
    truth = np.exp(0.4 * np.random.default_rng(3).normal(size=16))
    moved = plica.record(scenario, strengths={"cortex.apical": truth}).positions() / pixel_um
    simulation = plica.Simulation(scenario)
    second = np.zeros_like(first)
    for facet, cell in zip(simulation.hexahedra[:, 4:], simulation.hexahedron_cell):
        second[draw.polygon(len(first) - 1 - moved[facet, 1], moved[facet, 0], first.shape)] = cells.cell_data["label"][cell]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        shapes = plica.shapes_of_labels({0: first, 1: second}, pixel_um, cells=cells)
    found = plica.infer(scenario, shapes, of="cortex.apical", noise_um=0.05)
    assert np.corrcoef(np.log(found.factors["cortex.apical"]), np.log(truth))[0, 1] > 0.9


def test_tensions_follow_from_volumes():
    """Voxels of a sheet of 16 cells that contracts on a substrate: hidden factors are recovered from whole cells. bench/movie_to_tensions.py
    adds blur, photons, a watershed and wrong labels."""
    spacing, times = (0.5, 0.5, 0.5), [0, 1, 2, 3]
    laws = {"cortex": {"apical": {"region": "all", "tension_mN_per_m": 1, "saturation_ratio": 0.2,
                                  "program": {"time_min": [0, 3], "activity": [0, 1]}}},
            "elasticity": {"young_modulus_Pa": 200, "poisson_ratio": 0.45, "corner_barrier_Pa": 30},
            "foundation": {"substrate": {"region": "all", "faces": "basal", "stiffness_nN_per_um3": 0.5, "resists": "normal"}},
            "dynamics": {"surface_drag_Pa_s_per_um": 50}, "time": {"end_min": 3}, "stop": {"at_equilibrium": False}}
    drawn = plica.Scenario({"embryo": {"shape": "sheet", "length_um": 32, "width_um": 32, "cell_count": 16, "cell_height_um": 5, "seed": 2}, **laws})
    simulation = plica.Simulation(drawn)
    truth = np.exp(0.4 * np.random.default_rng(3).normal(size=16))
    tape = plica.record(drawn, at_min=times, strengths={"cortex.apical": truth})
    low = simulation.positions.min(axis=0)[::-1] - 3
    shape = np.ceil((np.ptp(simulation.positions, axis=0)[::-1] + 6) / spacing).astype(int)
    frames = {time: voxels_of(tape.positions(time), simulation.hexahedra, simulation.hexahedron_cell + 1, np.array(spacing), low, tuple(shape))
              for time in times}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        tissue = plica.tissue_of_labels(frames[0], spacing, apical="+z")
        shapes = plica.shapes_of_labels(frames, spacing, cells=tissue, apical="+z")
    model = plica.Scenario({"embryo": {}, **laws}, tissue=tissue)
    found = plica.infer(model, shapes, of="cortex.apical", noise_um=0.03, drift="xy")
    hidden = truth[shapes.labels - 1]
    assert len(hidden) == 16 and np.corrcoef(np.log(found.factors["cortex.apical"]), np.log(hidden))[0, 1] > 0.95


WRONG = [
    (dict(frames=[1, 2]), "frames: a value of type list; give a mapping of times in minutes to labels"),
    (dict(frames={1: 0}), "frames: begin at 1 min; give that of the cells at 0"),
    (dict(frames={-1: 0}), "frames: -1; give times in minutes, 0 or later"),
    (dict(frames={0: 0, 1: 1}), "frames[1]: shape (60, 120) and spacing (0.25,) µm; that at 0 has (120, 120)"),
    (dict(frames={0: 2}), "frames[0]: has 0 of 16 cells by their labels; give the frame that cells are made of"),
    (dict(frames={0: 0, 1: 2}), "frames[1]: has 0 of 16 cells by their labels; track the labels, or give links"),
    (dict(frames={0: 3}), "give labels of shape (rows, columns), because cells are of such a frame"),
    (dict(spacing_um=0), "spacing_um: 0; give the size of a pixel in µm"),
    (dict(links=[[1, 2]]), "give rows of time in minutes, label, and label at 0"),
    (dict(links=[[5, 2, 2]]), "links: there is no frame at 5 min; give times of frames"),
    (dict(links=[[0, 2, 2], [0, 2, 3]]), "links: label 2 at 0 min is linked to 2 and 3; link it once"),
    (dict(cells=3), "cells: 3; give what polygons_of_labels or tissue_of_labels returned"),
    (dict(cells=plica.Polygons([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])), 'cells: have no array "label"'),
    (dict(gap_px=-1), "gap_px: -1; give a width in pixels"),
    (dict(apical="+z"), "apical: '+z', but images show one surface only; omit it, or give volumes"),
]


@pytest.mark.parametrize("arguments, message", WRONG)
def test_bad_arguments_are_told(arguments, message):
    movie, cells = drawn()
    images = [movie[0], movie[0][:60], movie[0] + 5000, np.zeros((2, 3, 4), dtype=int)]
    given = {"frames": {0: 0}, "spacing_um": PIXEL_UM, "cells": cells, **arguments}
    if isinstance(given["frames"], dict):
        given["frames"] = {time: images[number] for time, number in given["frames"].items()}
    with pytest.raises((ValueError, TypeError)) as raised:
        plica.shapes_of_labels(**given)
    assert message in str(raised.value)
