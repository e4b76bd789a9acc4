"""Tests of the Python package. PLICA names the program; the package is that of PYTHONPATH, or the installed one."""
import matplotlib

matplotlib.use("Agg")
