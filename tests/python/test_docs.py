"""The Python of the documentation runs as it stands."""
import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def run_blocks(page, with_words=""):
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text(encoding="utf-8"), re.M | re.S)
    assert blocks
    names: dict = {}
    for block in (one for one in blocks if with_words in one):
        exec(compile(block, page, "exec"), names)
    return names


def test_python_page(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    run_blocks("docs/start/python.md")
    whole, half = map(float, capsys.readouterr().out.split())
    assert whole > 10 and half > 10 and abs(whole - half) > 0.1


def test_studies_page(tmp_path, monkeypatch):
    pytest.importorskip("xarray")
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs/how-to/studies.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"^```toml\n# stiffness.toml\n(.*?)^```", page, re.M | re.S)
    (tmp_path / "stiffness.toml").write_text(text.replace("[vary]", '[set]\n"time.end_min" = 0.2\n[vary]'))
    names = run_blocks("docs/how-to/studies.md")
    assert dict(names["depths"].sizes) == {"contraction.apical.stiffness_nN_per_um": 4, "region.furrow.cells_across": 3}


def test_readme(tmp_path, monkeypatch, capsys):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    run_blocks("README.md")
    depth, closed = re.match(r"([\d.]+) µm deep; lips closed at ([\d.]+) min", capsys.readouterr().out).groups()
    assert 45 < float(depth) < 65 and 14 < float(closed) < 17
    assert (tmp_path / "furrow.png").stat().st_size > 1000


def test_signals_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs/how-to/signals.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"^```toml\n# gradient-bend.toml\n(.*?)^```", page, re.M | re.S)
    (tmp_path / "gradient-bend.toml").write_text(text)
    sim = run_blocks("docs/how-to/signals.md")["sim"]
    kept = sim.cell_data["y_um"] > 0
    assert sim.time_s == 240 and sim.signals["dpp"][kept].mean() > 1.05 * sim.signals["dpp"][~kept].mean()


def test_exchange_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs/how-to/exchange.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"^```toml\n# exchange.toml\n(.*?)^```", page, re.M | re.S)
    (tmp_path / "exchange.toml").write_text(text)
    names = run_blocks("docs/how-to/exchange.md")
    assert set(names["factors"]) == {1.0, 1.5} and set(names["sim"].wall_factors("lateral")) == {1.0, 1.5}


def test_gallery(tmp_path, monkeypatch):
    """The rule of the gallery makes a wave of contraction from pole to pole."""
    monkeypatch.chdir(tmp_path)
    names = run_blocks("docs/gallery.md", "import plica")
    begin_s, place_um = names["begin_s"], names["sim"].cell_data["x_um"]
    middle, end = (begin_s[abs(place_um - at) < 20].mean() for at in (0, 100))
    assert 60 < middle < end < 240


def test_law_of_the_gallery(tmp_path):
    pytest.importorskip("sympy")
    names = runpy.run_path(str(ROOT / "docs/pictures/law.py"))
    ratios, ring = names["fold"](tmp_path / "law").cell_data["apical_area_ratio"], names["ring"]
    assert ratios[ring].mean() < 0.5 and abs(ratios[~ring].mean() - 1) < 0.1


def test_gradients_page(capsys):
    names = run_blocks("docs/how-to/gradients.md")
    assert names["by_cell"].shape == (756,)
    factors = names["found"].factors["contraction.apical"]
    assert (factors == factors).sum() == 70 and abs(factors[factors == factors] - 1).max() < 0.02
    assert "Identified" in capsys.readouterr().out


def test_answers_page(tmp_path, monkeypatch):
    """Its blocks, with smooth results made up, since its runs take minutes."""
    for package in ("SALib", "sklearn", "matplotlib"):
        pytest.importorskip(package)
    import plica

    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs/how-to/answers.md").read_text(encoding="utf-8")
    for name, text in re.findall(r"^```toml\n# (\w+.toml)\n(.*?)^```", page, re.M | re.S):
        (tmp_path / name).write_text(text)

    def made_up(self, **_):
        table = self.table.assign(status="end_time", steps=1, wall_s=0.1, reason="")
        places = sum((table[key] - table[key].min()) / (table[key].max() - table[key].min()) for key in self.keys)
        for number, measure in enumerate(self.measures):
            table[measure] = 0 if measure == "self_intersections" else 54 + number * places + places**2
        self._rows = dict(enumerate(table.to_csv(index=False).splitlines()[1:]))

    monkeypatch.setattr(plica.Study, "run", made_up)
    of_grid = plica.Study.phase_diagram
    monkeypatch.setattr(plica.Study, "phase_diagram", lambda self, *, thumbnails=0, **how: of_grid(self, **how))
    names = run_blocks("docs/how-to/answers.md")
    assert names["found"].effective_size > 100 and names["mean"].shape == (3, 3)
    for name in re.findall(r"images/answers/(\w+.png)", page):
        assert (tmp_path / name).stat().st_size > 1000


def test_surface_page(tmp_path, monkeypatch):
    """A drawn tube becomes prisms, in a file that the page's scenario reads."""
    for package in ("skimage", "scipy", "tifffile"):
        pytest.importorskip(package)
    import plica
    import tifffile
    from drawn_tissues import Tube

    monkeypatch.chdir(tmp_path)
    drawn = Tube(60, radius=12, length=30, height=6, seed=3)
    tifffile.imwrite("labels.tif", drawn.labels((1, 0.3, 0.3))[0])
    page = (ROOT / "docs/how-to/surface.md").read_text(encoding="utf-8")
    (command,) = re.findall(r"^plica (labels .*)$", page, re.M)
    subprocess.run([sys.executable, "-m", "plica", *command.split()], check=True)
    assert (tmp_path / "check.png").stat().st_size > 10_000
    (scenario,) = re.findall(r"^# fold.toml\n(.*?)^```", page, re.M | re.S)
    (tmp_path / "fold.toml").write_text(scenario, encoding="utf-8")
    simulation = plica.Simulation(plica.Scenario("fold.toml"))
    assert 50 <= len(simulation.cell_data["label"]) <= 60
    assert simulation.cell_data["label"][simulation.regions["pit"]].tolist() == [7]
