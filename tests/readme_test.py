#!/usr/bin/python3
"""Runs the Python of the README as it stands, on a run that frames_test.py left.

Usage: readme_test.py README RUN_DIRECTORY. Needs Debian's python3-pandas and python3-matplotlib.
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

snippets = re.findall(r"^```python\n(.*?)^```", Path(sys.argv[1]).read_text(encoding="utf-8"), re.S | re.M)
run = Path(sys.argv[2]).resolve()
if not snippets:
    sys.exit("README.md has no Python")
for snippet in snippets:
    with tempfile.TemporaryDirectory() as temporary:
        (Path(temporary) / "results").mkdir()
        (Path(temporary) / "results/drosophila").symlink_to(run)
        environment = dict(os.environ, MPLBACKEND="Agg", MPLCONFIGDIR=temporary)
        subprocess.run([sys.executable, "-c", snippet], cwd=temporary, env=environment, check=True)
        if not list(Path(temporary).glob("*.png")):
            sys.exit("README.md: its Python saved no picture")
print(f"Ran {len(snippets)} snippets.")
