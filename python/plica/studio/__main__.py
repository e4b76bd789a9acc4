"""python -m plica.studio: the studio from the command line."""
from __future__ import annotations

import argparse
import contextlib
import sys
import webbrowser
from pathlib import Path

from .. import _core
from ..errors import PlicaError
from . import made
from .draft import STARTS


def main() -> int:
    parser = argparse.ArgumentParser(prog="plica studio",
        description="Paint, fold, cut and compare a tissue on a local page.",
                                     epilog="Example: plica studio furrow-slice")
    parser.add_argument("scenario", nargs="?",
        help="built-in name, scenario file, or folder to start in (default: this folder)")
    parser.add_argument("--port", type=int, default=0,
        help="port on this machine (default: the last one, or a free one)")
    parser.add_argument("--threads", type=int, help="threads per step (default: one for every 10 000 elements)")
    parser.add_argument("--no-browser", action="store_true", help="print the address only")
    given = parser.parse_args()
    scenario, folder = given.scenario, Path(".")
    if scenario and scenario not in _core.scenarios and scenario not in STARTS:
        path = Path(scenario)
        scenario, folder = (None, path) if path.is_dir() else (scenario, path.parent)
    try:
        studio = made(scenario, folder, given.port, given.threads)
    except (PlicaError, ValueError, OSError) as error:
        print(f"plica: {error}", file=sys.stderr)
        return 2
    print(f"plica studio: {studio.url}\nCtrl-C ends it; the same command resumes its runs.", flush=True)
    if not given.no_browser:
        webbrowser.open(studio.url)
    with contextlib.suppress(KeyboardInterrupt):
        studio.serve()
    return 0


if __name__ == "__main__":
    sys.exit(main())
