"""The Python of the documentation runs as it stands."""
import re
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


def test_gallery(tmp_path, monkeypatch):
    """The rule of the gallery makes a wave of contraction from pole to pole."""
    monkeypatch.chdir(tmp_path)
    names = run_blocks("docs/gallery.md", "import plica")
    begin_s, place_um = names["begin_s"], names["sim"].cell_data["x_um"]
    middle, end = (begin_s[abs(place_um - at) < 20].mean() for at in (0, 100))
    assert 60 < middle < end < 240


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
    """An unrolled image of a cylinder's cells becomes a curved sheet, whose basal side is inside."""
    for package in ("skimage", "scipy"):
        pytest.importorskip(package)
    import numpy as np
    import plica
    from scipy.spatial import cKDTree
    from skimage.io import imsave

    monkeypatch.chdir(tmp_path)
    rng = np.random.default_rng(3)
    pixels = np.indices((240, 200)).reshape(2, -1).T
    points = rng.uniform(0, (240, 200), (120, 2))
    for _ in range(3):  # evened out
        nearest = cKDTree(points).query(pixels)[1]
        points = np.column_stack([np.bincount(nearest, pixels[:, axis], 120) / np.bincount(nearest, minlength=120) for axis in (0, 1)])
    imsave("unrolled.tif", (1 + cKDTree(points).query(pixels)[1]).reshape(240, 200).astype(np.uint16), check_contrast=False)
    page = (ROOT / "docs/how-to/surface.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```python\n(import numpy.*?)^```", page, re.M | re.S)
    exec(compile(block, "surface.md", "exec"), {})
    sheet = {"format": 1, "embryo": {"shape": "surface", "file": "curved.ply", "cell_height_um": 10}, "time": {"end_s": 1}}
    frame = plica.Simulation(plica.Scenario(sheet)).run(out=tmp_path / "run").frames[0]
    radius = {side: np.hypot(*frame.polygons(side).points[:, 1:].T) for side in ("apical", "basal")}
    assert np.allclose(radius["apical"], 60, atol=0.5) and np.allclose(radius["basal"], 50, atol=1)
