"""What tests of `plica run --resume` share: a scenario with divisions, what must be the same, runs that are signalled."""
import json
import shutil
import time

from support import CHECKPOINTS, CommandLine, ended, rows_in, running, tree

# Two divisions, growth after each, frames; 168 steps or so.
DIVIDING = ["drosophila-division-twice"]
for setting in ("division.floor.at_min=0.2", "division.floor.growth_min=0.3", "division.borders.at_min=0.7",
                "division.borders.growth_min=0.3", "time.end_min=1.5", "time.tolerance_um=0.02", "output.frame_every_s=5"):
    DIVIDING += ["--set", setting]

# Cells that grow, exchange neighbours, divide, leave and signal: a cell leaves after 15 s; 70 steps or so.
CHANGING = """format = 1
[embryo]
shape = "sheet"
length_um = 18
width_um = 18
cell_height_um = 6
cell_count = 20
seed = 3
[region.leaving]
x_um = [-3, 1]
y_um = [-3, 3]
[region.right]
x_um = [4, 20]
[elasticity]
model = "neo-hookean"
young_modulus_Pa = 200
poisson_ratio = 0.2
corner_barrier_Pa = 40
relaxation_min = 0.5
[dynamics]
surface_drag_Pa_s_per_um = 10
[exchange]
below_um = 0.8
new_length_um = 0.9
again_after_s = 1
[growth.leaving]
region = "leaving"
final_ratio = 0.05
in_plane = 1
program = { time_s = [0, 15], activity = [1, 1] }
[extrusion.leaving]
region = "leaving"
apical_area_below_um2 = 12
[division.right]
region = "right"
at_s = 8
growth_s = 4
daughter_volume_ratio = 0.6
[signal.u]
diffusion_um2_per_min = 20
initial = 0.5
initial_spread = 0.3
reaction = "k * u * (1 - u)"
constants = { k = 1 }
[cortex.lateral]
region = "all"
faces = "lateral"
tension_mN_per_m = 0.8
program = { time_s = [0, 5], activity = [0, 1] }
noise = { spread = 0.4, correlation_s = 20 }
[cortex.apical]
region = "all"
tension_mN_per_m = 0.6
program = { time_s = [0, 5], activity = [0, 1] }
[cortex.following]
region = "all"
tension_mN_per_m = 0.2
follow = { signal = "u", from = 0.2, to = 0.8 }
[cortex.basal]
region = "all"
faces = "basal"
tension_mN_per_m = 0.6
program = { time_s = [0, 5], activity = [0, 1] }
[time]
end_s = 40
first_step_s = 0.5
max_step_s = 2
tolerance_um = 0.3
[stop]
at_equilibrium = false
[measure]
sets = ["neighbours"]
[output]
frame_every_s = 5
"""

LOST = range(12)  # rows that a kill may cost: ten steps in a row with a factor, and one that is being recorded


def results(out):
    """What must be the same: every file but checkpoints and the report, what it cost and provenance aside."""
    files = {name: content for name, content in tree(out).items() if name not in CHECKPOINTS | {"report.html"}}
    summary = json.loads(files["summary.json"])
    for key in [key for key in summary if key.startswith("wall_") or key in ("peak_memory_MB", "provenance")]:
        del summary[key]
    return files | {"summary.json": summary}


class Resuming(CommandLine):
    def assert_same(self, out, whole):
        found = results(out)
        self.assertEqual(sorted(found), sorted(whole))
        for name in whole:
            if found[name] != whole[name]:
                self.fail(f"{name} is not the same; kept in {shutil.copytree(out, self.folder.with_suffix('.kept'))}")

    def assert_alike(self, whole):
        """A run that was extended, or resumed after its stop: nothing is reused across that, so the last digits may differ."""
        found, expected = self.summary(), whole["summary.json"]
        self.assertEqual(found["steps"], expected["steps"])
        for key in ("time_s", "max_displacement_um", "mean_height_um", "active_work_nN_um", "stored_energy_nN_um"):
            self.assertAlmostEqual(found[key] / expected[key], 1, delta=1e-9)

    def whole_run(self, arguments, *more):
        self.call("run", *arguments, "--out", self.folder / "whole", *more, timeout=300)
        return results(self.folder / "whole")

    def resumed(self, arguments, *more, status=0, out=None):
        return self.call("run", *arguments, "--out", out or self.out, "--resume", *more, timeout=300, status=status)

    def after_rows(self, arguments, rows, number, delay_s=0.0):
        """Starts or goes on, and signals once series.csv has so many rows and some time has passed. The process, ended."""
        with running("run", *arguments, "--out", self.out, "--resume") as process:
            deadline = time.monotonic() + 120
            while process.poll() is None and rows_in(self.out) < rows and time.monotonic() < deadline:
                time.sleep(0.002)
            time.sleep(delay_s)
            if process.poll() is None:
                process.send_signal(number)
            return ended(process)
