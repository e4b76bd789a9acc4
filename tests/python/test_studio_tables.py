"""plica studio: kinds of tables in its palette, and what signals and exchanges of neighbours show."""
import numpy as np
import pytest
from test_studio import run_to

import plica
from plica import ScenarioError
from plica.studio.draft import Draft, schema
from plica.studio.session import Refused, Session

KINDS = [table["path"][:-2] for table in schema() if table["path"].endswith(".*") and not table["path"].startswith("expect")]


@pytest.mark.parametrize("kind", KINDS)
def test_each_table_of_the_palette_is_accepted_when_added_and_checked_as_it_is_edited(tmp_path, kind):
    session = Session(tmp_path, lambda: None, threads=1)
    session.open(Draft.of({"enclosed": "furrow-slice", "extrusion": "convergent-extension"}.get(kind, "sheet")))
    monitor = {"quantity": "position", "region": "all", "axis": "z"}
    session.order("set", {"changes": {"enclosed": None} if kind == "enclosed" else {"monitor.depth": monitor}})
    session.order("add", {"kind": kind, "name": "new", "region": "all"})
    table = session.draft.table
    assert table[kind]["new"].get("region", "all") == "all"
    with pytest.raises(Refused, match="exists"):
        session.order("add", {"kind": kind, "name": "new", "region": "all"})
    row = next(row for table in session.tables if table["path"] == f"{kind}.*" for row in table["rows"]
               if row["type"] in ("number", "word", "[low, high]") and not row["shapes"] and not row["instead_of"])
    with pytest.raises(ScenarioError) as caught:
        session.order("set", {"changes": {f"{kind}.new.{row['key']}": "wrong"}})
    assert f"{kind}.new.{row['key']}" in [one.key for one in caught.value.diagnostics]
    assert session.draft.table is table
    assert plica.Scenario(session.draft.text()).to_dict()[kind]["new"] == table[kind]["new"]
    session.close()


def test_frames_have_the_surface_and_the_signals_of_their_time_across_exchanges(tmp_path):
    scenario = plica.Scenario({
        "format": 1, "base": "convergent-extension", "embryo": {"length_um": 20, "width_um": 36, "cell_count": 20},
        "exchange": {"below_um": 0.8, "new_length_um": 1.4}, "signal": {"dpp": {"initial": 1, "decay_per_min": 0.5}},
        "time": {"end_s": 90}})
    session = Session(tmp_path, lambda: None, threads=1)
    session.open(Draft.of(scenario))
    run = run_to(session, session.order("start", {})["run"], 90)
    sim = plica.Simulation(scenario, threads=1)
    elements = [sim.hexahedra]
    while sim.step() is not None:
        pass
    elements.append(sim.hexahedra)
    assert sim.measures["exchanges"] > 0 and not np.array_equal(*elements)
    for at_s, there in zip((0, 90), elements):
        shape, frame = run.frame_message({"slot": 0, "run": 1, "field": "signal dpp", "at_s": at_s})
        assert there.astype("u4").tobytes() in shape and b'"signal dpp"' in shape and b"signal_dpp" not in shape
        shown = run.file.values(0 if at_s == 0 else len(run.file.frames) - 1, "signal dpp")
        assert shown.tobytes() in frame
    shown = run.file.values(len(run.file.frames) - 1, "signal dpp")
    np.testing.assert_allclose(shown, sim.signals["dpp"], rtol=1e-6)
    assert shown.max() < 0.6
    session.close()
