"""What a study says, compared with functions of which everything is known. No embryo is run, but where that is said."""
import re

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

import plica
from plica.names import name_and_unit
from plica.emulator import Range

from filled_studies import DEPTH, POISSON, YOUNG, between, filled, linear, no_figure_stays_open, source, texts_of, unit  # noqa: F401

TENSION = "cortex.shortening.tension_mN_per_m"
VERDICTS = ["self_intersections", "lips_closed_time_s", "furrow_depth_below_lips_um", "furrow_depth_um"]


def lines_of(ax, label):
    return [line for line in ax.get_lines() if line.get_label() == label]


def test_a_table_has_to_be_that_of_the_study():
    given = source({POISSON: {"values": [0.3, 0.4]}})
    with pytest.raises(ValueError, match="give 2 of point"):
        plica.Study._of_table(given, plica.Study(given).table.head(1))


@pytest.mark.parametrize("name, found", [
    ("stiffness_nN_per_um", ("stiffness", "nN/µm")), ("active_work_nN_um", ("active_work", "nN µm")),
    ("vitelline.drag_Pa_s_per_um", ("vitelline.drag", "Pa s/µm")), ("min_apical_area_ratio", ("min_apical_area_ratio", "")),
    ("depth_20um_time_s", ("depth_20um_time", "s")), ("enclosed_um3", ("enclosed", "µm³")), ("s", ("s", "")),
])
def test_units_of_names(name, found):
    assert name_and_unit(name) == found


# Curves

def test_curves_mark_the_scenario_and_what_is_missing():
    given = source({YOUNG: {"values": [400, 500, 600, 700]}, POISSON: {"low": 0.2, "high": 0.4, "count": 3}}, "one-at-a-time")
    study = filled(given, furrow_depth_um=lambda t: t[YOUNG] / 100 + t[POISSON])
    table = study.table
    own = table.iloc[0]
    table.loc[table[YOUNG] == 500, "status"] = "failed"  # with the depth of its last good state, which is no result
    table.loc[table[YOUNG] == 600, DEPTH] = np.nan
    figure = plica.Study._of_table(given, table).curves(DEPTH)
    first, second = figure.axes
    assert first.get_ylabel() == "furrow depth (µm)" and first.get_xlabel() == "elasticity.young_modulus (Pa)"
    (curve,), (lost,), (mark,) = (lines_of(first, label) for label in ("result", "no result", "the scenario"))
    x, y = curve.get_data()
    assert np.isnan(y[np.isin(x, [500, 600])]).all() and np.isfinite(y[np.isin(x, [400, 700, own[YOUNG]])]).all()
    assert list(lost.get_xdata()) == [500, 600]
    assert mark.get_xdata() == [own[YOUNG]] and mark.get_ydata() == [own[DEPTH]]
    assert not lines_of(second, "no result") and len(lines_of(second, "result")[0].get_xdata()) in (3, 4)


def test_curves_of_words_logarithms_and_one_key():
    words = filled(source({"elasticity.model": {"values": ["corotational", "neo-hookean"]}}), furrow_depth_um=[1.0, 2.0])
    (ax,) = words.curves(DEPTH).axes
    assert [label.get_text() for label in ax.get_xticklabels()] == ["corotational", "neo-hookean"]
    assert lines_of(ax, "result")[0].get_linestyle() == "None"
    assert lines_of(ax, "the scenario's own value")
    logs = filled(source({YOUNG: between(YOUNG, scale="log", count=4)}), furrow_depth_um=[1.0, 2.0, 3.0, 4.0])
    (ax,) = logs.curves(DEPTH).axes
    assert ax.get_xscale() == "log" and lines_of(ax, "the scenario's own value")


def test_curves_of_replicates():
    given = source({YOUNG: {"values": [400, 500]}}, "one-at-a-time", replicates=3)
    given["set"] = {"cortex.apical.variation.spread": 0.1}
    study = filled(given, furrow_depth_um=lambda t: t[YOUNG] / 100 + t.replicate)
    (ax,) = study.curves(DEPTH).axes
    x, y = lines_of(ax, "result")[0].get_data()
    assert np.allclose(y, x / 100 + 2) and len(lines_of(ax, "a replicate")[0].get_xdata()) == 9


def test_curves_that_are_none():
    study = filled(source({YOUNG: {"values": [400, 500]}, POISSON: {"values": [0.2, 0.3]}}), furrow_depth_um=1.0)
    with pytest.raises(ValueError, match="one-at-a-time"):
        study.curves(DEPTH)
    one = filled(source({YOUNG: {"values": [400, 500]}}), furrow_depth_um=1.0)
    with pytest.raises(ValueError, match="no output variable 'depth' .nearest match: 'furrow_depth_um'.*; it has furrow_depth_um, vml_height_um, steps$"):
        one.curves("depth")


# Phase diagrams

GRID = {YOUNG: {"values": [400, 600, 1200]}, POISSON: {"values": [0.2, 0.3]}}


def phases(**columns):
    given = source(GRID, measures=VERDICTS)
    own = {"self_intersections": 0, "lips_closed_time_s": np.nan, "furrow_depth_below_lips_um": 0.5, DEPTH: 3.0}
    return filled(given, **{**own, **columns})


def legend_of(figure):
    return [text.get_text().split(":")[0] for text in figure.axes[0].get_legend().get_texts()]


@pytest.mark.parametrize("change, word", [
    ({}, "flattened"), ({"furrow_depth_below_lips_um": 1.0}, "furrowed"), ({"lips_closed_time_s": 900.0}, "closed"),
    ({"lips_closed_time_s": 900.0, "self_intersections": 2}, "passes through itself"), ({"status": "refused"}, "refused"),
    ({"status": "failed", "self_intersections": 2}, "failed"), ({"status": "not_run"}, "not run"), ({"status": "crashed"}, "failed"),
    ({"self_intersections": None, "furrow_depth_below_lips_um": None}, "flattened"),
    # A tube whose lips have gone in, too.
    ({"furrow_depth_below_lips_um": -4.2, "furrow_depth_um": 38.7}, "furrowed"),
    ({"furrow_depth_below_lips_um": -4.2, "furrow_depth_um": 15.0}, "furrowed"),
    ({"furrow_depth_below_lips_um": -4.2, "furrow_depth_um": 14.9}, "flattened"),
    ({"furrow_depth_below_lips_um": None, "furrow_depth_um": 20.0}, "furrowed"),
    ({"furrow_depth_below_lips_um": None, "furrow_depth_um": None}, "no verdict"),
])
def test_verdicts(change, word):
    row = {"status": "equilibrium", "self_intersections": 0, "lips_closed_time_s": None, "furrow_depth_below_lips_um": 0.0,
           "furrow_depth_um": 3.0}
    assert plica.verdict({**row, **change}) == plica.verdict(pd.Series({**row, **change}, dtype=object)) == word


def test_phase_diagram_of_verdicts():
    study = phases()
    table = study.table
    table.loc[table[YOUNG] == 1200, "furrow_depth_below_lips_um"] = 3.0
    table.loc[(table[YOUNG] == 1200) & (table[POISSON] == 0.3), "status"] = "failed"
    study = plica.Study._of_table(source(GRID, measures=VERDICTS), table)
    figure = study.phase_diagram()
    ax = figure.axes[0]
    words = legend_of(figure)
    assert words == ["closed", "furrowed", "flattened", "passes through itself", "failed"]  # also what does not occur
    assert any("1 µm or more below its lips" in text and "15 µm or more" in text for text in texts_of(figure))
    assert any(re.fullmatch(r"study: verdict of furrow-slice until \d+ min\n6 runs, 1 without a value", text) for text in texts_of(figure))
    numbers = np.asarray(ax.images[0].get_array())
    assert [[words[n] for n in row] for row in numbers] == [["flattened", "flattened", "furrowed"], ["flattened", "flattened", "failed"]]
    assert [t.get_text() for t in ax.get_xticklabels()] == ["400", "600", "1200"] and "Pa" in ax.get_xlabel()
    turned = study.phase_diagram(POISSON, YOUNG, measure=lambda row: "deep" if row.furrow_depth_below_lips_um > 2 else "shallow")
    assert legend_of(turned) == ["deep", "shallow"]
    assert any(text.startswith("study: a function of the row of") for text in texts_of(turned))
    assert np.asarray(turned.axes[0].images[0].get_array()).tolist() == [[1, 1], [1, 1], [0, 0]]
    assert legend_of(study.phase_diagram(measure="status")) == ["failed", "end_time"]


def test_cells_whose_replicates_differ_are_hatched():
    given = source(GRID, measures=VERDICTS, replicates=2)
    given["set"] = {"cortex.apical.variation.spread": 0.1}
    own = {"self_intersections": 0, "lips_closed_time_s": np.nan, "furrow_depth_below_lips_um": 0.5}
    study = filled(given, **own, furrow_depth_um=lambda t: np.where((t.replicate == 2) & (t[YOUNG] == 600), 30.0, 3.0))
    ax = study.phase_diagram().axes[0]
    assert "replicates differ" in legend_of(ax.figure)
    hatched = [patch for patch in ax.patches if patch.get_hatch()]
    assert sorted(patch.get_xy() for patch in hatched) == [(0.5, -0.5), (0.5, 0.5)]


def test_labels_say_that_an_axis_is_logarithmic_and_do_not_break():
    given = source({"cortex.shortening.tension_mN_per_m": {"low": 0.1, "high": 10, "scale": "log", "count": 3}, POISSON: {"values": [0.2, 0.3]}})
    ax = filled(given, furrow_depth_um=1.0).phase_diagram(measure=DEPTH).axes[0]
    assert ax.get_xlabel() == "cortex.shortening.tension (mN/m), log scale" and "log" not in ax.get_ylabel()


def test_phase_diagram_of_a_measure():
    given = source(GRID)
    study = filled(given, furrow_depth_um=[1.0, 2.0, 3.0, 4.0, np.nan, 6.0])
    figure = study.phase_diagram(measure=DEPTH)
    cells = np.asarray(np.ma.filled(figure.axes[0].images[0].get_array(), np.nan))
    np.testing.assert_equal(cells, [[1, 3, np.nan], [2, 4, 6]])
    assert figure.axes[1].get_ylabel() == "furrow depth (µm)"
    assert any("furrow depth (µm) of furrow-slice" in text and "6 runs, 1 without a value (×)" in text for text in texts_of(figure))


def test_phase_diagrams_that_are_none():
    with pytest.raises(ValueError, match="lips_closed_time_s.* add it to keep.measures"):
        filled(source(GRID)).phase_diagram()
    with pytest.raises(ValueError, match="two keys"):
        filled(source({YOUNG: {"values": [400, 500]}})).phase_diagram(measure=DEPTH)
    for kind in ("sobol", "sobol-indices"):
        with pytest.raises(ValueError, match=f'is of kind "{kind}"; use a grid over the two keys$'):
            filled(source({YOUNG: between(YOUNG), POISSON: between(POISSON), TENSION: {"low": 0, "high": 1}}, kind, points=5)).phase_diagram(measure=DEPTH)
    with pytest.raises(ValueError, match="'poisson' does not vary in the study .nearest match: 'elasticity.poisson_ratio'.*; keys: elasticity.young"):
        phases().phase_diagram("poisson")
    with pytest.raises(ValueError, match="no output variable 'verdct' .nearest match: 'verdict'"):
        phases().phase_diagram(measure="verdct")
    with pytest.raises(ValueError, match="keep.each"):
        phases().phase_diagram(thumbnails=2)
    three = filled(source({**GRID, TENSION: {"values": [0.5, 1]}}), furrow_depth_um=lambda t: t[TENSION])
    with pytest.raises(ValueError, match="tension_mN_per_m also varies; .* one of 0.5, 1$"):
        three.phase_diagram(measure=DEPTH)
    assert (np.asarray(three.phase_diagram(measure=DEPTH, at={TENSION: 1}).axes[0].images[0].get_array()) == 1).all()


def test_thumbnails_of_runs_that_were_kept(tmp_path):
    """Runs four small embryos."""
    pytest.importorskip("pyvista")
    study = plica.Study({
        "scenario": "furrow-slice", "set": {"time.end_min": 0.05}, "design": {"kind": "grid"},
        "vary": {YOUNG: {"values": [400, 800]}, POISSON: {"values": [0.3, 0.4]}}, "keep": {"measures": VERDICTS, "each": "full"},
    })
    study.run(out=tmp_path / "s", jobs=1)
    try:
        figure = plica.Study(tmp_path / "s").phase_diagram(thumbnails=2)
    except plica.PlicaError as error:
        pytest.skip(str(error))
    assert {"a", "b"} <= texts_of(figure)
    pictures = [np.asarray(ax.images[0].get_array()) for ax in figure.axes if ax.images]
    assert sum(picture.ndim == 3 and picture.std() > 5 for picture in pictures) == 2
    with pytest.raises(ValueError, match="point 9 is not in this diagram"):
        study.phase_diagram(thumbnails=[9])


# Sobol's indices

def test_sobol_indices_of_ishigami():
    """Ishigami and Homma's function, whose indices are known; its three numbers go from -π to π."""
    pytest.importorskip("SALib")
    keys = {YOUNG: (400, 1200), POISSON: (0.2, 0.4), TENSION: (0, 1)}
    given = source({key: {"low": low, "high": high} for key, (low, high) in keys.items()}, "sobol-indices", points=1024, seed=3)

    def ishigami(table):
        x, y, z = (np.pi * (2 * (table[key] - low) / (high - low) - 1) for key, (low, high) in keys.items())
        return np.sin(x) + 7 * np.sin(y) ** 2 + 0.1 * z**4 * np.sin(x)

    study = filled(given, furrow_depth_um=ishigami)
    found = study.sobol_indices(DEPTH, resamples=200)
    a, b = 7, 0.1
    variance = a**2 / 8 + b * np.pi**4 / 5 + b**2 * np.pi**8 / 18 + 0.5
    shares = np.array([0.5 * (1 + b * np.pi**4 / 5) ** 2, a**2 / 8, 0]) / variance
    joint = b**2 * np.pi**8 * (1 / 18 - 1 / 50) / variance
    totals = shares + [joint, 0, joint]
    assert np.allclose(found.table["first"], shares, atol=0.03) and np.allclose(found.table.total, totals, atol=0.03)
    assert ((found.table.first_low <= shares) & (shares <= found.table.first_high)).all()
    assert ((found.table.total_low <= totals) & (totals <= found.table.total_high)).all()
    again = study.sobol_indices(DEPTH, resamples=200)
    assert again.table.equals(found.table) and not study.sobol_indices(DEPTH, resamples=200, seed=2).table.equals(found.table)
    assert study.sobol_indices(DEPTH, resamples=50, seed=0).table.equals(study.sobol_indices(DEPTH, resamples=50, seed=0).table)
    figure = found.plot()
    assert len(figure.axes[0].patches) == 6 and figure.axes[0].get_xlabel() == "share of the variance of furrow depth"


def linear_indices(points=256, **design):
    return source({YOUNG: between(YOUNG), POISSON: between(POISSON)}, "sobol-indices", points=points, **design)


def test_sobol_indices_of_a_linear_function():
    pytest.importorskip("SALib")
    study = filled(linear_indices(), furrow_depth_um=lambda t: unit(t, YOUNG, POISSON) @ [1, 2])
    indices = study.sobol_indices(DEPTH, resamples=100)
    table, lines = indices.table, str(indices).splitlines()
    assert len(lines) == 3 and max(map(len, lines)) <= 80 and f"{table.total_high.iloc[1]:.2f})" in lines[2]
    assert np.allclose(table["first"], [0.2, 0.8], atol=0.02) and np.allclose(table.total, [0.2, 0.8], atol=0.02)


def test_sobol_indices_with_missing_runs():
    pytest.importorskip("SALib")
    given = linear_indices()
    table = filled(given, furrow_depth_um=lambda t: unit(t, YOUNG, POISSON) @ [1, 2]).table
    table.loc[[0, 1, 100], "status"] = "failed"
    table.loc[8, DEPTH] = np.nan
    study = plica.Study._of_table(given, table)
    with pytest.raises(ValueError, match=r"4 of 1024 runs have no furrow_depth_um \(3 failed, 1 end_time\).* 253 of 256 .*drop_missing"):
        study.sobol_indices(DEPTH)
    with pytest.warns(UserWarning, match="3 of 256 base points are omitted"):
        found = study.sobol_indices(DEPTH, resamples=50, drop_missing=True)
    assert found.base_points == 253 and found.dropped == 3 and np.allclose(found.table.total, [0.2, 0.8], atol=0.02)
    with pytest.raises(ValueError, match="same in all runs"):
        filled(given, furrow_depth_um=3.0).sobol_indices(DEPTH)
    with pytest.raises(ValueError, match='kind "grid"'):
        phases().sobol_indices("self_intersections")


# Emulators

def curved(table):
    u = unit(table, YOUNG, POISSON)
    return np.sin(3 * u[:, 0]) + u[:, 1] ** 2


def test_emulator_predicts_and_knows_its_error():
    pytest.importorskip("sklearn")
    study = filled(source({YOUNG: between(YOUNG), POISSON: between(POISSON)}, "sobol", points=48), furrow_depth_um=curved)
    emulator = study.emulator(DEPTH)
    others = plica.Study(source({YOUNG: between(YOUNG), POISSON: between(POISSON)}, "latin-hypercube", points=40)).points
    mean, sd = emulator.predict(others)
    off = mean[DEPTH] - curved(others)
    assert abs(off).max() < 0.02 and (abs(off) < 5 * sd[DEPTH] + 1e-4).all()
    assert emulator.errors.loc[DEPTH, "explained"] > 0.999 and emulator.errors.loc[DEPTH, "rmse"] < 0.02
    assert mean.shape == sd.shape == (40, 1) and list(mean.columns) == emulator.measures and emulator.keys == [YOUNG, POISSON]
    assert "furrow depth (µm), run" in texts_of(emulator.plot())
    with pytest.raises(ValueError, match="does not extrapolate"):
        emulator.predict(others.assign(**{YOUNG: 1300}))
    with pytest.raises(ValueError, match="column elasticity.poisson_ratio is missing"):
        emulator.predict(others[[YOUNG]])


def test_emulator_of_noise_says_that_it_explains_nothing():
    pytest.importorskip("sklearn")
    noise = np.random.default_rng(1).standard_normal(60)
    study = filled(source({YOUNG: between(YOUNG), POISSON: between(POISSON)}, "sobol", points=60), furrow_depth_um=noise)
    emulator = study.emulator(DEPTH)
    assert emulator.errors.loc[DEPTH, "explained"] < 0.2 and 0.8 < emulator.errors.loc[DEPTH, "rmse"] / noise.std() < 1.3
    assert 0.8 < emulator.predict(study.points)[1][DEPTH].mean() / noise.std() < 1.3


def test_emulator_takes_logarithms():
    pytest.importorskip("sklearn")
    vary = {YOUNG: {"low": 1, "high": 10000, "scale": "log"}}
    study = filled(source(vary, "sobol", points=16), furrow_depth_um=lambda t: np.log10(t[YOUNG]))
    emulator = study.emulator(DEPTH, folds=4)
    mean, _ = emulator.predict(pd.DataFrame({YOUNG: [3.0, 100.0, 5000.0]}))
    assert np.allclose(mean[DEPTH], np.log10([3.0, 100.0, 5000.0]), atol=0.01)


def test_what_is_held_out_is_not_known():
    """Nine points of a function with waves between them: it goes through them, and cannot guess one from the others."""
    pytest.importorskip("sklearn")
    study = filled(source({POISSON: between(POISSON, count=9)}), furrow_depth_um=lambda t: np.sin(8 * unit(t, POISSON)[:, 0]))
    emulator = study.emulator(DEPTH, folds=9)
    assert abs(emulator.predict(study.points)[0][DEPTH] - study.table[DEPTH]).max() < 0.1
    assert emulator.errors.loc[DEPTH, "rmse"] > 0.1


@pytest.mark.parametrize("one", [Range(3, 50, True), Range(-2, 5, False)])
def test_ranges_there_and_back(one):
    assert np.allclose(one.to_unit([one.low, one.high]), [0, 1])
    assert np.allclose(one.from_unit(one.to_unit([3, 4, 5])), [3, 4, 5])


def test_emulators_that_are_none():
    pytest.importorskip("sklearn")
    words = filled(source({"elasticity.model": {"values": ["corotational", "neo-hookean"]}, POISSON: between(POISSON, count=5)}),
                   furrow_depth_um=1.0)
    with pytest.raises(ValueError, match="elasticity.model takes words .*corotational, neo-hookean.* one study per word"):
        words.emulator(DEPTH)
    given = source({YOUNG: between(YOUNG)}, "sobol", points=8)
    few = filled(given, furrow_depth_um=[1, 2, 3, np.nan, np.nan, np.nan, np.nan, np.nan])
    with pytest.raises(ValueError, match="3 of 8 points have furrow_depth_um; at least 5"):
        few.emulator(DEPTH)
    with pytest.warns(UserWarning, match="1 of 8 runs have no furrow_depth_um"):
        filled(given, furrow_depth_um=[1, 2, 3, 4, 5, 6, 7, np.nan]).emulator(DEPTH, folds=3)


def test_a_missing_package_is_named(monkeypatch):
    import sys
    monkeypatch.setitem(sys.modules, "sklearn.gaussian_process", None)
    with pytest.raises(plica.MissingExtra, match=r"needs scikit-learn.*pip install scikit-learn,.*pip install 'plica\[study\]'") as told:
        linear(32).emulator(DEPTH)
    assert told.value.__suppress_context__  # one traceback
