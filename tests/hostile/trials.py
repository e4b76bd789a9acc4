"""What trials of random input share: numbered draws, of which each can be repeated; what fails is kept, and all outcomes are counted."""
import argparse
import collections
import random
import shutil
import tempfile
import time
from pathlib import Path


class Broken(Exception):
    """A violated guarantee."""


def arguments(document, kind, count):
    parser = argparse.ArgumentParser(description=document.split("\n")[0])
    parser.add_argument("program", type=lambda name: Path(name).resolve())
    parser.add_argument("--count", type=int, default=count)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help=f"number of the first {kind}, to repeat one")
    parser.add_argument("--keep", type=Path, default=Path(f"failed_{kind}s"), help=f"folder for each {kind} that fails")
    return parser


def run(given, kind, prepare):
    """The outcomes of all draws and how often each occurred, told, too.

    `prepare` makes the trial, a function of random numbers, in a folder. What it leaves there as draw.* is kept where it is Broken.
    """
    counts, slowest, started = collections.Counter(), (0, 0), time.monotonic()
    with tempfile.TemporaryDirectory(prefix="plica_trials_") as name:
        folder = Path(name)
        trial = prepare(folder)
        for number in range(given.first, given.first + given.count):
            for left in folder.glob("draw.*"):
                left.unlink()
            begun = time.monotonic()
            try:
                counts[trial(random.Random(f"{given.seed}/{number}"))] += 1
                slowest = max(slowest, (time.monotonic() - begun, number))
            except Broken as error:
                counts["FAILED"] += 1
                kept = given.keep / f"seed{given.seed}_{number}"
                kept.mkdir(parents=True, exist_ok=True)
                for file in folder.glob("draw.*"):
                    shutil.copy(file, kept)
                print(f"{kind} {number} of seed {given.seed}: {error}\n  kept in {kept}", flush=True)
    print(f"{given.count} {kind}s of seed {given.seed} in {time.monotonic() - started:.0f} s, the slowest in {slowest[0]:.1f} s (number {slowest[1]})")
    for outcome, count in counts.most_common():
        print(f"{count:6} {outcome}")
    return counts
