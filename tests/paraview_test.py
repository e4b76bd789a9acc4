#!/usr/bin/env python3
"""tools/paraview_state.py on a run: it opens in ParaView, and in the colours that plica itself uses.

Usage: paraview_test.py RUN. Needs pvbatch (Debian: paraview) and xvfb-run; without them it ends with status 77, skipped.
"""
import json
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

TOOLS = Path(__file__).resolve().parent.parent / "tools"
SCRIPT, STATE = TOOLS / "paraview_state.py", TOOLS / "plica.pvsm"
LOADER = """
from paraview import simple
simple.LoadState("{state}", LoadStateDataFileOptions="Search files under specified directory", DataDirectory="{run}")
reader = simple.FindSource("run")
assert len(reader.TimestepValues) > 1
view = simple.GetActiveView()
simple.GetAnimationScene().GoToLast()
simple.SaveScreenshot("{picture}", view)
print(len(reader.TimestepValues), "frames opened")
"""


def colour_table(state, array):
    """[(value, (r, g, b)), ...] of an array's colours in a state file."""
    for proxy in state.iter("Proxy"):
        if proxy.get("type") != "PVLookupTable":
            continue
        names = [item.get("name") for collection in state.iter("ProxyCollection") if collection.get("name") == "lookup_tables"
                 for item in collection if item.get("id") == proxy.get("id")]
        if not any(name.endswith(f"{array}.PVLookupTable") or array in name for name in names):
            continue
        points = next(entry for entry in proxy if entry.get("name") == "RGBPoints")
        numbers = [float(element.get("value")) for element in points.iter("Element")]
        return [(numbers[i], tuple(numbers[i + 1:i + 4])) for i in range(0, len(numbers), 4)]
    sys.exit(f"FAILED: the state has no colours for {array}")


def can_run():
    if not shutil.which("pvbatch") or not shutil.which("xvfb-run"):
        return False
    with tempfile.NamedTemporaryFile("w", suffix=".py") as probe:
        probe.write("from paraview import simple")
        probe.flush()
        return subprocess.run(["pvbatch", probe.name], capture_output=True).returncode == 0


def main():
    run = Path(sys.argv[1])
    if not can_run():
        print("skipped: ParaView with its Python, or xvfb-run, is missing (docs/how-to/paraview.md)")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        picture, state_file = Path(folder) / "fold.png", Path(folder) / "fold.pvsm"
        done = subprocess.run(["xvfb-run", "-a", "pvbatch", str(SCRIPT), str(run), "--picture", str(picture), "--save",
                               str(state_file)], capture_output=True, text=True, timeout=120)
        if done.returncode != 0:
            sys.exit(f"FAILED: {done.stdout}{done.stderr}")
        state = ElementTree.parse(state_file).getroot()
        size = picture.stat().st_size
        # The state that is kept in the repository opens another run.
        loader, loaded = Path(folder) / "load.py", Path(folder) / "loaded.png"
        loader.write_text(LOADER.format(state=str(STATE), run=str(run.resolve()), picture=str(loaded)))
        done = subprocess.run(["xvfb-run", "-a", "pvbatch", str(loader)], capture_output=True, text=True, timeout=120)
        if done.returncode != 0 or "frames opened" not in done.stdout:
            sys.exit(f"FAILED: {done.stdout}{done.stderr}")
        assert loaded.stat().st_size > 20_000
    page = (run / "report.html").read_text()
    data = json.loads(re.search(r'id="data">(.*?)</script>', page, re.S)[1])
    compared = 0
    for array, field_name in (("displacement_um", "displacement"), ("pressure_Pa", "pressure"),
                              ("apical_area_ratio", "area-ratio")):
        field = next(field for field in data["fields"] if field["name"] == field_name)
        colours = data["maps"][field["map"]]
        table = colour_table(state, array)
        assert len(table) == len(colours), (array, len(table), len(colours))
        # The page keeps values in 65536 steps, so its ends may be rounded from a value that is a little off.
        assert abs(table[0][0] - field["low"]) < 1e-3 and abs(table[-1][0] - field["high"]) < 1e-3, (array, table, field)
        for (_, ours), theirs in zip(table, colours):
            expected = [int(theirs[i:i + 2], 16) / 255 for i in (1, 3, 5)]
            assert max(abs(a - b) for a, b in zip(ours, expected)) < 0.5 / 255 + 1e-6, (array, ours, expected)
            compared += 1
    assert size > 20_000, f"the picture has {size} bytes"
    print(f"{compared} colours compared; a picture of {size} bytes")


if __name__ == "__main__":
    main()
