"""Tests of the Python package. PLICA names the program; the package is that of PYTHONPATH, or the installed one."""
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
sys.path.insert(0, str(Path(__file__).parent))  # tests share helpers: test_scenario.box
