"""Directories of results from Python: of finished, running, killed and broken runs."""
import subprocess
import sys

import numpy as np
import plica
import pytest
from plica import frame_labels


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    s = plica.Scenario("drosophila")
    s["time.end_min"] = 1
    return plica.Simulation(s).run(out=tmp_path_factory.mktemp("results") / "run")


def test_tables(run):
    assert run.series["time_s"].iloc[-1] == 60 and run.summary["time_s"] == 60 and run.status == "end_time"
    assert set(run.cells["cell_id"]) == set(range(756)) and len(run.midline) > 0 and len(run.cross_section) > 0
    with pytest.raises(plica.FileError, match="divide"):
        run.lineage
    assert run.scenario["time.end_s"] == 60


def test_frames(run):
    frames = run.frames
    assert len(frames) == len(frames.times_s) >= 5 and frames[-1].time_min == 1 and frames.at(0.3).time_s == 15
    frame = frames[-1]
    assert frame.points.shape[1] == 3 and frame.hexahedra.shape == (756, 8)
    assert np.allclose(frame.points - frames[0].points, frame.point_data["displacement_um"], atol=1e-9)
    assert set(frame.cell_data) >= {"volume_um3", "region_furrow"}
    assert [one.time_s for one in frames[1:3]] == [15, 30]
    with pytest.raises(IndexError):
        frames[99]
    assert "elements" in repr(frame) and "Frames" in repr(frames)


def test_frames_as_labels(tmp_path):
    """Voxels of cells: their numbers, places and volumes, in a sheet of hexagons whose elements fill it."""
    sheet = {"embryo": {"shape": "sheet", "length_um": 20, "width_um": 20, "cell_count": 12, "cell_height_um": 6},
             "region": {"middle": {"y_um": [-4, 4]}}, "cortex": {"pull": {"region": "middle", "tension_mN_per_m": 0.3}}, "time": {"end_s": 2}}
    run = plica.Simulation(plica.Scenario(sheet)).run(out=tmp_path / "flat")
    frame = run.frames[-1]
    volume = run.labels(1, (0.2, 0.25, 0.25))
    names, number = np.unique(volume.labels, return_counts=True)
    assert names.tolist() == [*range(13)]
    of_cell = dict(zip(frame.cell_data["cell_id"].astype(int), frame.cell_data["volume_um3"]))
    assert number[1:] * 0.0125 == pytest.approx([of_cell[cell] for cell in range(12)], rel=0.03)
    assert volume.labels.sum() > 0 == volume.labels[0].sum() == volume.labels[:, :, -1].sum()  # a margin
    cell = int(np.argmax(frame.points[frame.hexahedra].mean(axis=1)[:, 0]))  # at the end along x
    place = np.argwhere(volume.labels == frame.cell_data["cell_id"][cell] + 1).mean(axis=0) * volume.spacing_um + volume.origin_um
    middle = frame.points[frame.hexahedra[frame.cell_data["cell_id"] == frame.cell_data["cell_id"][cell]]].mean(axis=(0, 1))
    assert place[::-1] == pytest.approx(middle, abs=0.7)
    part = frame.labels((0.2, 0.25, 0.25), shape=(10, 20, 30))
    assert part.origin_um == (0, 0, 0) and part.labels.shape == (10, 20, 30)
    same = frame.labels((0.2, 0.25, 0.25), shape=volume.labels.shape, origin_um=volume.origin_um)
    assert np.array_equal(same.labels, volume.labels)
    for how, said in (({"spacing_um": (1, 0, 1)}, "spacing_um"), ({"spacing_um": 1}, "spacing_um"), ({"shape": (0, 1, 1)}, "shape"),
                      ({"origin_um": (0, np.nan, 0)}, "origin_um")):
        with pytest.raises(ValueError, match=said):
            frame.labels(**{"spacing_um": (1, 1, 1), **how})


def test_words_fit_the_tissue(tmp_path):
    sheet = {"embryo": {"shape": "sheet", "length_um": 40, "width_um": 40, "cell_count": 30, "cell_height_um": 10},
             "region": {"middle": {"y_um": [-8, 8]}}, "cortex": {"pull": {"region": "middle", "tension_mN_per_m": 0.3}}, "time": {"end_s": 2}}
    sim = plica.Simulation(plica.Scenario(sheet))
    flat = sim.run(out=tmp_path / "flat")
    assert "frames: fold depth " in repr(flat) and "largest displacement" in repr(flat)
    for looks in (flat._repr_html_(), sim._repr_html_()):
        assert "furrow_depth_um" in looks and "max_displacement_um" in looks
    assert not {name for name in [*flat.series, *flat.summary] if name.startswith(("vml", "lip", "contact", "lumen"))}
    assert set(sim.measures) == set(flat.series)
    assert [axes.get_ylabel() for axes in flat.plot().axes] == ["fold depth (µm)", "max node speed (µm/s)"]
    closed = plica.Simulation({"embryo": {"shape": "sphere", "axes": ["x", "y", "z"]}, "time": {"end_s": 1, "step_s": 1}})
    closed = closed.run(out=tmp_path / "closed")
    assert [axes.get_ylabel() for axes in closed.plot().axes] == ["max displacement (µm)", "max node speed (µm/s)"]
    with pytest.raises(plica.FileError, match='set "fold" was not measured'):
        closed.midline


def test_looks(run):
    assert "frames: furrow depth" in repr(run)
    assert "end_time" in repr(run) and "furrow_depth_um" in run._repr_html_()
    figure = run.plot("furrow_depth_um")
    assert figure.axes[0].get_ylabel() == "furrow depth (µm)"
    with pytest.raises(ValueError, match="one matplotlib Axes per column .2"):
        run.plot(ax=figure.axes[0])
    with pytest.raises(ValueError, match="furrow_depth_um"):
        run.plot("depth")


def test_show(run):
    pytest.importorskip("IPython")
    if not (run.directory / "report.html").exists():
        pytest.skip("built without the report's page")
    assert "<iframe" in run.show().data


def test_compare(run, tmp_path):
    s = run.scenario
    s["contraction.apical.stiffness_nN_per_um"] = 2
    other = plica.Simulation(s).run(out=tmp_path / "other")
    comparison = plica.compare(run, other)
    assert list(comparison.scenario) == ["contraction.apical.stiffness_nN_per_um"]
    assert comparison.summary.loc["furrow_depth_um", "difference"] > 0
    assert 0 < comparison.nodes.mean_um < comparison.nodes.max_um
    assert plica.compare(run, run.directory).nodes.max_um == 0
    assert plica.compare(run, other, time_min=0).nodes.max_um == 0
    assert "keys differ" in repr(comparison)
    told = str(comparison)
    assert "contraction.apical.stiffness_nN_per_um" in told and "furrow_depth_um" in told and len(told.splitlines()) < 20
    assert "wall_s" not in told and str(plica.compare(run, run)).count("\n") == 0


def test_render(run, tmp_path):
    pytest.importorskip("pyvista")
    for color in ("displacement", "region", "area-ratio"):
        picture = plica.render(run, tmp_path / "fold.png", color=color, size=(400, 300))
        assert picture.shape == (300, 400, 3) and len(np.unique(picture.reshape(-1, 3), axis=0)) > 50
        assert (tmp_path / "fold.png").stat().st_size > 1000
    assert plica.render(run.frames[0], view="cross-section", size=(300, 300)).std() > 1
    with pytest.raises(ValueError, match="area-ratio"):
        plica.render(run, color="colour")
    same = [plica.render(run.frames[-1], color="area-ratio", limits=limits, size=(200, 150)) for limits in (None, (0, 2), (0, 20))]
    assert (same[0] == plica.render(run.frames[-1], color="area-ratio", size=(200, 150))).all() and (same[1] != same[2]).any()
    with pytest.raises(ValueError, match="the lower one first"):
        plica.render(run, limits=(1, 1))


def test_render_of_several_times_and_views(run, tmp_path):
    pytest.importorskip("pyvista")
    quick = {"size": (300, 200), "bar": False}
    one, two = plica.render(run, view="ventral", **quick), plica.render(run, view=["ventral"], time_min=[0, 1], **quick)
    assert one.shape == two.shape == (200, 300, 3) and (one != two).any()
    assert (plica.render(run, edges=False, **quick) != plica.render(run, **quick)).any()
    assert (plica.render(run, shell=True, **quick) != plica.render(run, **quick)).any()
    for options in ({"strip": True}, {"sections": True, "time_min": 1}, {"at_x_um": [-100, 0]}):
        assert plica.render(run, tmp_path / "fold.png", **options, **quick).std() > 1
    sim = plica.Simulation(run.scenario)
    sim.cell_data["signal"] = sim.cell_data["x_um"] ** 2
    assert (plica.render(sim, color="signal", **quick) != plica.render(sim, **quick)).any()
    for options, said in (({"at_x_um": 900}, "outside the tissue"), ({"size": (3, 4)}, "from 100"), ({"view": ["nowhere"]}, "ventral"),
                          ({"time_min": "soon"}, "time_min"), ({"path": "fold.jpg"}, r"\.png")):
        with pytest.raises((ValueError, TypeError), match=said):
            plica.render(run, **options)
    with pytest.raises(ValueError, match="require a run"):
        plica.render(sim, strip=True)


class Squares:
    """In place of Scene, to try encoders without PyVista: squares that turn brighter."""

    def __init__(self, *how):
        self.brightness = 0

    def range_over(self, source):
        return 0, 1

    def draw(self, columns, limits):
        self.brightness += 20
        return np.full((151, 201, 3), self.brightness, dtype=np.uint8)


@pytest.mark.parametrize("scene", ["pyvista", "squares"])
def test_movie(run, tmp_path, monkeypatch, scene):
    images = pytest.importorskip("imageio.v3")
    pytest.importorskip("imageio_ffmpeg")
    if scene == "squares":
        monkeypatch.setattr("plica.pictures.Scene", Squares)
        monkeypatch.setattr("plica.results.Frame.to_pyvista", lambda frame: None)
    else:
        pytest.importorskip("pyvista")
    for name, plugin in (("fold.gif", "pillow"), ("fold.mp4", "FFMPEG")):
        plica.movie(run, tmp_path / name, size=(201, 151), bar=False)
        drawn = images.imread(tmp_path / name, plugin=plugin)
        assert len(drawn) == len(run.frames)
        if scene == "squares":
            assert (np.diff(drawn[:, 75, 100, 0].astype(int)) > 5).all()
    with pytest.raises(ValueError, match=r"\.gif or \.mp4"):
        plica.movie(run, tmp_path / "fold.avi")
    with pytest.raises(plica.FileError, match="cannot be written"):
        plica.movie(run, tmp_path / "nowhere" / "fold.gif")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fold.gif", "fold.mp4"]


@pytest.mark.parametrize("call, said", [
    (lambda run: plica.render(run), "render needs pyvista, which is not installed; pip install pyvista, .*'plica\\[plot\\]'"),
    (lambda run: plica.movie(run, "fold.gif"), "movie needs imageio, .* pip install imageio, .*'plica\\[movie\\]'"),
])
def test_missing_packages_are_named(run, monkeypatch, call, said):
    for name in ("pyvista", "imageio.v2"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(plica.MissingExtra, match=said):
        call(run)


def test_surface_distance(run):
    pytest.importorskip("pyvista")
    assert plica.compare(run, run).surface.max_um < 1e-3


def test_running_and_killed(tmp_path):
    code = (
        "import plica, sys\n"
        "sim = plica.Simulation('drosophila')\n"
        f"sim.run(out={str(tmp_path / 'run')!r}, callback=lambda s, step: s.steps == 5 and (print('there', flush=True), sys.stdin.read()))\n"
    )
    child = subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "there\n"
    run = plica.open(tmp_path / "run")
    assert run.status == "running" and run.summary == {} and len(run.series) == 6
    with pytest.raises(plica.FileError):
        plica.Simulation("drosophila").run(out=tmp_path / "run", overwrite=True)
    child.kill()
    child.wait()
    assert run.status == "killed" and len(run.frames) >= 1
    again = plica.Simulation("drosophila").run(out=tmp_path / "run", resume=True, until_min=1)
    assert again.series["time_s"].is_monotonic_increasing and again.status == "interrupted"


def test_no_run(tmp_path):
    for place in (tmp_path, tmp_path / "none"):
        with pytest.raises(plica.FileError, match=str(place)):
            plica.open(place)


def test_damaged(run, tmp_path):
    file = run.frames[1].path
    whole = file.read_bytes()
    for cut in (0, 10, 500, len(whole) // 2, len(whole) - 300):
        file.write_bytes(whole[:cut])
        with pytest.raises(plica.FileError, match="cannot be read"):
            run.frames[1]
    file.write_bytes(whole)
    saved = tmp_path / "moment.h5"
    plica.Simulation(run.scenario).save(saved)
    whole = saved.read_bytes()
    for cut in (0, 100, len(whole) // 2, len(whole) - 1):
        saved.write_bytes(whole[:cut])
        with pytest.raises(plica.FileError, match="moment.h5"):
            plica.load(saved)
    with pytest.raises(plica.FileError, match="cannot be read"):
        plica.load(tmp_path / "none.h5")


def test_calibrate():
    seen = []
    found = plica.calibrate("division-demo", {"elasticity.young_modulus_Pa": (500, 2000)}, {"steps": (50, 1000)}, callback=seen.append)
    assert found.end == "met" and found.trials == seen and found.best.failure == ""
    assert found.scenario["elasticity.young_modulus_Pa"] == found.best.values["elasticity.young_modulus_Pa"]
    with pytest.raises(ValueError, match="depth"):
        plica.calibrate("division-demo", {"elasticity.young_modulus_Pa": (500, 2000)}, {"depth": (1, 1)})
    with pytest.raises(plica.ScenarioError):
        plica.calibrate("division-demo", {"elasticity.young": (500, 2000)}, {"steps": (1, 1)})


@pytest.mark.parametrize("vary, targets, said", [
    ({}, {"steps": (1, 1)}, "at least one key"),
    ({"elasticity.young_modulus_Pa": (500, 500)}, {"steps": (1, 1)}, "bounds 500 and 500 are not increasing finite numbers; give the lower one first"),
    ({"elasticity.young_modulus_Pa": (500, float("inf"))}, {"steps": (1, 1)}, "bounds 500 and inf"),
    ({"elasticity.young_modulus_Pa": (500, 600)}, {"steps": (1, 0)}, "1 with tolerance 0; give two numbers, the tolerance above 0"),
    ({"elasticity.young_modulus_Pa": (500, 600)}, {"steps": (float("nan"), 1)}, "target nan with tolerance 1"),
])
def test_calibrate_refuses_what_is_no_search(vary, targets, said):
    with pytest.raises(ValueError, match=said):
        plica.calibrate("division-demo", vary, targets)


def test_import_is_light():
    """What is large is imported when it is first needed. (How long an import takes is not tested: machines differ.)"""
    code = "import sys, plica; print({'pandas', 'matplotlib', 'pyvista', 'IPython', 'tqdm'} & set(sys.modules))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "set()\n"


def test_labels_of_elements_with_an_upright_face():
    """A face that is upright up to rounding has bounds along its lines of voxels without end."""
    corners = np.array([[2, 0, 0], [9, 0, 1e-20], [2, 7, 7], [4, 0, 7]], dtype=float)
    volume = np.zeros((11, 9, 9), dtype=np.uint32)
    frame_labels._fill(volume, corners[None], np.array([7]))
    places = np.argwhere(np.ones(volume.shape))
    shares = np.linalg.solve(np.vstack([corners.T, np.ones(4)]), np.vstack([places.T, np.ones(len(places))])).min(axis=0)
    found = volume.ravel() == 7
    assert found[shares > 1e-6].all() and not found[shares < -1e-6].any() and (shares > 1e-6).sum() > 4
