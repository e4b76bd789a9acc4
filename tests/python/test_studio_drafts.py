"""Drafts of the studio: scenarios under edit."""
import pytest

import plica
from plica import ScenarioError
from plica.studio.draft import Draft, defaults_of, toml, typed
from plica.studio.session import Session


def test_a_draft_is_written_as_differences_and_reads_back():
    draft = Draft.of("furrow-slice")
    assert draft.text() == 'format = 1\nbase = "furrow-slice"\n'
    draft.set({"cortex.apical.tension_mN_per_m": 1.5, "region.spot": {"ids": [3, 4]}})
    assert "tension_mN_per_m = 1.5" in draft.text() and "ids = [3, 4]" in draft.text() and len(draft.text()) < 200
    read = plica.Scenario(draft.text()).to_dict()
    read.pop("expect", None)
    assert read == draft.table
    draft.undo()
    draft.undo()
    assert draft.text() == 'format = 1\nbase = "furrow-slice"\n'
    draft.redo()
    assert draft.table["cortex"]["apical"]["tension_mN_per_m"] == 1.5


def test_a_draft_without_a_base_is_written_without_defaults():
    draft = Draft.of("sheet")
    draft.set({"region.stripe": {"ids": [3, 4]}, "cortex.apical": {"region": "stripe", "tension_mN_per_m": 3}})
    assert "tension_mN_per_m = 3" in draft.text() and "cg_tolerance" not in draft.text()
    assert plica.Scenario(draft.text()).to_dict() == draft.table


def test_all_of_a_drag_of_a_slider_is_one_step_of_undo():
    draft = Draft.of("drosophila-deep")
    before = draft.table
    for low in (10, 40, 70, 60):
        draft.set({"region.floor.length_percent": [low, 100]}, drag="slider 1")
    draft.set({"region.floor.length_percent": None}, drag="slider 1")  # back where it was
    draft.set({"region.floor.length_percent": [30, 100]}, drag="slider 1")
    draft.set({"region.floor.angle_deg": [-20, 20]}, drag="slider 2")
    assert draft.table["region"]["floor"]["length_percent"] == [30, 100]
    draft.undo()
    assert "angle_deg" not in draft.table["region"]["floor"] and draft.table != before
    draft.undo()
    assert draft.table == before and draft.place == 0


def test_a_removed_table_is_written_whole():
    draft = Draft.of("furrow-slice")
    draft.set({"cortex.walls": None})
    assert "base" not in draft.text()
    assert "walls" not in plica.Scenario(draft.text()).to_dict()["cortex"]


def test_an_invalid_change_is_refused_with_its_key_and_changes_nothing():
    draft = Draft.of("furrow-slice")
    before = draft.table
    with pytest.raises(ScenarioError) as caught:
        draft.set({"cortex.apical.tension_mN_per_m": -1})
    assert [one.key for one in caught.value.diagnostics] == ["cortex.apical.tension_mN_per_m"]
    assert draft.table is before and draft.place == 0


@pytest.mark.parametrize("kind, text, value", [
    ("number", "1.5", 1.5), ("number", "adaptive", "adaptive"), ("number", "", None), ("integer", "3", 3),
    ("[low, high]", "-42, 42", [-42, 42]), ("3 integers", "[1, 2, 3]", [1, 2, 3]), ("list of numbers", "0, 1.5",
        [0, 1.5]),
    ("list of words", "apical, basal", ["apical", "basal"]), ("word", "apical", "apical"), ("number", "1; x", "1; x")])
def test_texts_of_fields_become_values(kind, text, value):
    assert typed(text, kind) == value


def test_every_built_in_scenario_is_written_and_read_back():
    for name in plica.builtin_scenarios():
        table = Draft.of(name).table
        read = plica.Scenario(toml(table)).to_dict()
        assert read == table, name


def test_a_new_table_is_written_without_its_defaults_which_are_told_apart():
    for base in ("sheet", "furrow-slice"):
        draft = Draft.of(base)
        draft.set({"region.spot": {"ids": [3, 4]}, "cortex.new": {"region": "spot", "tension_mN_per_m": 3}})
        draft.set({"cortex.new.pulse.period_s": 60})
        assert '[cortex.new]\nregion = "spot"\ntension_mN_per_m = 3\npulse = {period_s = 60, phase = "random"}\n' in draft.text()
        known = defaults_of(draft.table)
        assert "cortex.new.noise.seed" in known
        assert not {"cortex.new.pulse.period_s", "cortex.new.tension_mN_per_m"} & set(known)


def test_a_run_is_named_by_what_is_different_from_an_earlier_one(tmp_path):
    session = Session(tmp_path, lambda: None, threads=1)
    session.open(Draft.of("furrow-slice"))

    def started():
        return session.runs[session.order("start", {"until_s": 0})["run"]].title

    assert started() == session.draft.table["title"]
    assert started() == "run 1 again"
    session.order("set", {"changes": {"cortex.apical.tension_mN_per_m": "1.5"}})
    assert started() == "run 2 with cortex.apical.tension_mN_per_m = 1.5"
    session.order("set", {"changes": {"region.spot": {"ids": [3, 4]}}})
    assert started() == "run 3 with other region.spot.ids"
    session.close()
