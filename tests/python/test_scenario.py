"""Scenarios from Python: read, changed, refused, copied."""
import pickle

import numpy as np
import plica
import pytest

KEY = "contraction.apical.stiffness_nN_per_um"


def test_sources(tmp_path):
    text = 'base = "drosophila"\n[time]\nend_min = 3\n'
    (tmp_path / "mine.toml").write_text(text)
    as_dict = plica.Scenario({"base": "drosophila", "time": {"end_min": 3}})
    from_file, from_text = plica.Scenario(tmp_path / "mine.toml"), plica.Scenario(text)
    assert from_file.name == "mine" and from_file == from_text == as_dict
    assert as_dict["time.end_s"] == 180
    assert plica.Scenario(as_dict.to_toml()) == as_dict
    assert set(plica.builtin_scenarios()) > {"drosophila", "drosophila-living"}


def test_keys():
    s = plica.Scenario("drosophila")
    before = s.copy()
    s[KEY] = 5
    assert s[KEY] == 5 and KEY in s and before[KEY] != 5
    assert s.diff(before) == {KEY: (5.0, before[KEY])}
    assert s != before and s == s.copy()
    with pytest.raises(KeyError, match="stiffness_nN_per_um"):
        s["contraction.apical.stifness"]


@pytest.mark.parametrize("key, value, told", [
    (KEY, -1, "contraction.apical.stiffness_nN_per_um"), (KEY, float("nan"), "contraction.apical.stiffness_nN_per_um"),
    ("contraction.apical.stifness", 1, "stiffness_nN_per_um"), ("contraction.apical.region", "nowhere", "nowhere"),
    ("base", "xenopus", "base"), ("a key", 1, "a key"), ("", 1, "unknown key"),
])
def test_every_change_is_checked(key, value, told):
    s = plica.Scenario("drosophila")
    s["title"] = 'quotes " and \n lines'
    assert s["title"] == 'quotes " and \n lines'
    before = s.to_toml()
    with pytest.raises(plica.ScenarioError, match=told.replace(".", r"\.")) as caught:
        s[key] = value
    assert s.to_toml() == before
    assert caught.value.diagnostics[0].file == "" and pickle.loads(pickle.dumps(caught.value)).args == caught.value.args
    assert "--set" not in str(caught.value)


def test_all_errors_at_once():
    with pytest.raises(plica.ScenarioError) as caught:
        plica.Scenario("[time]\nend_min = -1\n[elasticity]\npoisson_ratio = 2\n")
    assert [d.line for d in caught.value.diagnostics] == [2, 4]
    assert len(str(caught.value).splitlines()) == 2


def test_wrong_sources(tmp_path):
    with pytest.raises(ValueError, match='use "drosophila"'):
        plica.Scenario("drosofila")
    with pytest.raises(plica.ScenarioError, match="TOML"):
        plica.Scenario("[time\nend_min = 1")
    with pytest.raises(TypeError, match="time.end_min"):
        plica.Scenario({"time": {"end_min": object()}})


def test_changes_that_make_sense_together():
    s = plica.Scenario("drosophila")
    with pytest.raises(plica.ScenarioError):
        s["elasticity.relaxation_s"] = 100
    s.update({"elasticity.model": "neo-hookean", "elasticity.relaxation_s": 100})
    assert s["elasticity.relaxation_s"] == 100


def test_region_of_booleans():
    s = plica.Scenario("drosophila")
    x = plica.Simulation(s).cell_data["x_um"]
    s.set_region("furrow", np.abs(x) < 100)
    sim = plica.Simulation(s)
    assert np.array_equal(sim.regions["furrow"], np.abs(x) < 100)
    assert np.array_equal(~np.isnan(sim.activity("apical")), np.abs(x) < 100)
    for wrong in (x, np.zeros(756, bool), [[True]], 3):
        with pytest.raises(ValueError, match="furrow"):
            s.set_region("furrow", wrong)
    s["embryo.cells"] = [20, 9, 8]
    with pytest.raises(plica.ScenarioError, match="furrow: is an array for 756 cells"):
        plica.Simulation(s)


def test_pickle_and_looks():
    s = plica.Scenario("drosophila")
    s[KEY] = 5
    s.set_region("strip", np.arange(756) < 10)
    again = pickle.loads(pickle.dumps(s))
    assert again == s and again.name == "drosophila"
    assert KEY in repr(s) and "10 cells" in repr(s) and "<table>" in s._repr_html_()
    assert all(line.startswith(("warning: ", "note: ")) for line in s.advice())


def box(n=4, size=10.0):
    """A row of cubes along x."""
    points = np.array([[size * i, size * j, size * k] for i in range(n + 1) for j in (0, 1) for k in (0, 1)])
    at = lambda i, j, k: 4 * i + 2 * j + k  # noqa: E731
    hexahedra = [
        [at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 1, 0), at(i, 1, 0), at(i, 0, 1), at(i + 1, 0, 1), at(i + 1, 1, 1), at(i, 1, 1)]
        for i in range(n)
    ]
    return points, np.array(hexahedra)


def test_a_tissue_of_arrays():
    points, hexahedra = box()
    tissue = plica.Tissue(points, hexahedra, apical_faces=[5] * 4, regions={"left": [True, True, False, False]})
    s = plica.Scenario(
        {"vitelline": {"enabled": False}, "region": {"left": {"array": "left"}},
         "contraction": {"apical": {"region": "left", "stiffness_nN_per_um": 3}}, "time": {"end_min": 1}},
        tissue=tissue,
    )
    sim = plica.Simulation(s)
    assert len(sim.pressures) == 4 and np.allclose(np.sort(sim.rest_positions, axis=0), np.sort(points, axis=0))
    assert sim.regions["left"].tolist() == [True, True, False, False]
    sim.run()
    assert np.abs(sim.positions - sim.rest_positions).max() > 0.1
    again = pickle.loads(pickle.dumps(sim))
    assert np.array_equal(again.positions, sim.positions)


@pytest.mark.parametrize("change, told", [
    ({"points": [[0, 0]]}, "points"), ({"points": np.full((20, 3), np.nan)}, "node 0"),
    ({"hexahedra": [[0, 1, 2, 3]]}, "hexahedra"), ({"hexahedra": [[0.5] * 8]}, "whole numbers"),
    ({"hexahedra": [[0, 1, 2, 3, 4, 5, 6, 99]]}, "99"), ({"hexahedra": np.zeros((0, 8), int)}, "hexahedra"),
    ({"apical_faces": [5, 5]}, "apical_faces"), ({"apical_faces": [6] * 4}, "apical_faces"),
    ({"regions": {"left": [1, 0, 0, 0]}}, "left"), ({"regions": {"left": [True]}}, "left"),
    ({"regions": {"left": np.ma.masked_array([True] * 4, [0, 0, 1, 0])}}, "region left: 1 values are masked"),
    ({"points": np.ma.masked_less(box()[0], 1)}, "points: 24 values are masked"),
    ({"cell_data": {"gene": [1.0]}}, r"cell_data gene: an array of float64 and shape \(1,\)"),
    ({"cell_data": {"kind": ["a"] * 4}}, "cell_data kind: an array of <U1"),
])
def test_wrong_arrays(change, told):
    points, hexahedra = box()
    given = {"points": points, "hexahedra": hexahedra, "apical_faces": [5] * 4, **change}
    with pytest.raises(ValueError, match=told):
        plica.Tissue(given.pop("points"), given.pop("hexahedra"), **given)


def test_a_mesh_file_without_vtk(tmp_path, monkeypatch):
    """meshio reads the same cells as VTK does: the simulation is the same to the bit."""
    meshio = pytest.importorskip("meshio")
    points, hexahedra = box()
    data = {"top": [np.full(4, 5)], "left": [np.array([1.0, 2.0, 0.0, np.nan])], "vectors": [np.ones((4, 3))]}
    meshio.Mesh(points, [("hexahedron", hexahedra)], cell_data=data).write(tmp_path / "box.vtu")
    (tmp_path / "box.toml").write_text(
        'embryo = {shape = "file", file = "box.vtu", apical_array = "top"}\nvitelline.enabled = false\n'
        'region.left.array = "left"\ncontraction.apical = {region = "left", stiffness_nN_per_um = 3}\ntime.end_min = 0.5\n'
    )
    sims = []
    for reads in (plica._core.reads_meshes, False):
        monkeypatch.setattr(plica._core, "reads_meshes", reads)
        s = plica.Scenario(tmp_path / "box.toml")
        assert isinstance(s.advice(), list)
        sims.append(plica.Simulation(s))
        sims[-1].run()
    assert sims[0].regions["left"].tolist() == [True, True, False, False] and len(sims[0].hexahedra) == 4
    assert np.array_equal(sims[0].positions, sims[-1].positions)

    tissue = plica.Tissue.from_file(tmp_path / "box.vtu", apical_array="top")
    assert repr(tissue) == "Tissue(4 cells, 20 nodes, arrays: left)"
    with pytest.raises(ValueError, match="calibrate"):
        plica.calibrate(tmp_path / "box.toml", {"time.end_min": (1, 2)}, {"steps": (5, 2)})


def test_mesh_files_that_are_none(tmp_path):
    meshio = pytest.importorskip("meshio")
    points, hexahedra = box()
    meshio.Mesh(points, [("tetra", hexahedra[:, :4])]).write(tmp_path / "tetra.vtu")
    meshio.Mesh(points, [("hexahedron", hexahedra)], cell_data={"top": [np.full(4, 7.5)]}).write(tmp_path / "wrong.vtu")
    meshio.Mesh(points * np.nan, [("hexahedron", hexahedra)]).write(tmp_path / "nan.vtu")
    (tmp_path / "text.vtu").write_text("no mesh")
    (tmp_path / "mesh.unheard").write_text("no mesh")
    (tmp_path / "cut.vtu").write_bytes((tmp_path / "wrong.vtu").read_bytes()[:700])
    for name, told in [("tetra.vtu", "tetra"), ("nan.vtu", "node 0"), ("text.vtu", "cannot be read"), ("mesh.unheard", "cannot be"),
                       ("cut.vtu", "cannot be read"), ("none.vtu", "no such file"), ("", "directory")]:
        with pytest.raises(plica.FileError, match=told):
            plica.Tissue.from_file(tmp_path / name)
    for array, told in [("side", "there are: top"), ("top", "top|whole")]:
        with pytest.raises(plica.FileError, match=told):
            plica.Tissue.from_file(tmp_path / "wrong.vtu", apical_array=array)


def test_unusable_cells_are_named():
    points, hexahedra = box()
    hexahedra[2] = hexahedra[2][::-1]
    hexahedra[3][0] = hexahedra[3][1]
    with pytest.raises((plica.ScenarioError, plica.FileError), match="cell"):
        plica.Simulation(plica.Scenario({"vitelline": {"enabled": False}}, tissue=plica.Tissue(points, hexahedra, apical_faces=[5] * 4)))


def test_a_new_region_can_be_named_by_keys():
    s = plica.Scenario("drosophila")
    x = plica.Simulation(s).cell_data["x_um"]
    s.set_region("oval", np.abs(x) < 60)
    s["contraction.apical.region"] = "oval"
    assert "region.oval of" in repr(s) and "region.oval.ids" not in repr(s)
    sim = plica.Simulation(pickle.loads(pickle.dumps(s)))
    assert (np.isfinite(sim.activity("apical")) == (np.abs(x) < 60)).all()


def sheet(**more):
    return {"format": 1, "embryo": {"shape": "sheet", "length_um": 60, "width_um": 40, "cell_height_um": 10, "cell_count": 40}, **more}


@pytest.mark.parametrize("cells, error, said", [
    (np.ones(37, bool), ValueError, r"region some: .*\(37,\); give one boolean per cell \(40\)"),
    (np.ones(40), ValueError, "array of float64 .* one boolean per cell"),
    (np.ma.array(np.ones(40, bool), mask=np.arange(40) > 30), ValueError, "region some: 9 values are masked"),
    (None, ValueError, "one boolean per cell"),
    (np.zeros(40, bool), ValueError, "selects no cell"),
])
def test_a_region_that_does_not_fit_is_refused_at_once(cells, error, said):
    s = plica.Scenario(sheet())
    with pytest.raises(error, match=said):
        s.set_region("some", cells)
    assert s == plica.Scenario(sheet())


def test_arrays_on_a_built_sheet(tmp_path):
    s = plica.Scenario(sheet(region={"all_over": {"array": "myosin", "above": 0.5}}), arrays={"myosin": np.linspace(0, 1, 40)})
    s["contraction.apical"] = {"region": "all", "tension_mN_per_m": 0.1, "profile": {"shape": "array", "array": "myosin", "from": 0, "to": 1}}
    sim = plica.Simulation(s)
    assert (sim.cell_data["myosin"] == np.linspace(0, 1, 40)).all() and sim.regions["all_over"].sum() == 20
    assert pickle.loads(pickle.dumps(s)) == s and s.copy() == s != plica.Scenario(s.to_toml(), arrays={"myosin": np.ones(40)})
    assert "array myosin" in repr(s)
    run = sim.run(out=tmp_path / "run", until_min=0.02)
    assert np.allclose(run.frames[-1].polygons().cell_data["myosin"], np.linspace(0, 1, 40))
    again = plica.load(tmp_path / "run" / "checkpoint.h5", arrays={"myosin": np.linspace(0, 1, 40)})
    assert again.time_s == sim.time_s
    (tmp_path / "arrays.csv").write_text("myosin\n" + "\n".join(map(str, np.linspace(0, 1, 40).tolist())))
    of_file = plica.Scenario(sheet())
    of_file["embryo.cell_arrays"] = tmp_path / "arrays.csv"
    assert (plica.Simulation(of_file).cell_data["myosin"] == sim.cell_data["myosin"]).all()
    with pytest.raises(ValueError, match="that a file can express"):
        plica.calibrate(s, {"elasticity.young_modulus_Pa": (1, 2)}, {"steps": (1, 1)})


@pytest.mark.parametrize("values, said", [
    (np.ones(3), r"array myosin: .*\(3,\); give one number per cell \(40\)"),
    (np.full(40, np.inf), "cell 0 is inf"),
    (["a"] * 40, "one number per cell"),
])
def test_arrays_that_do_not_fit(values, said):
    with pytest.raises((ValueError, TypeError), match=said):
        plica.Scenario(sheet(), arrays={"myosin": values})
