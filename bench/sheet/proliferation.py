"""Lewis' and Aboav-Weaire's relations of a proliferating sheet, beside published numbers (docs/developers/sheets.md).

Usage: proliferation.py [--seeds N] [--cells N]; the package is that of PYTHONPATH. A free sheet of 40 cells grows, its cells
divide at a volume and exchange neighbours, until it has the wanted number; cells at the rim, and their neighbours, are left out.
"""
import argparse
from collections import defaultdict

import numpy as np
import plica

RAMP = {"time_min": [0, 1], "activity": [0, 1]}


def scenario(seed):
    return {
        "embryo": {"shape": "sheet", "length_um": 38, "width_um": 38, "cell_count": 40, "cell_height_um": 10, "seed": seed},
        "elasticity": {"model": "neo-hookean", "young_modulus_Pa": 100, "poisson_ratio": 0, "relaxation_min": 1, "corner_barrier_Pa": 30},
        "dynamics": {"surface_drag_Pa_s_per_um": 30},
        "exchange": {"below_um": 0.4},
        "growth": {"all": {"region": "all", "rate_per_h": 2.5, "in_plane": 1.0, "variation": {"spread": 0.3, "seed": seed}}},
        "division": {"all": {"region": "all", "when": "volume_above_um3", "threshold": 480, "plane": "longest-axis", "growth_min": 0.5,
                             "daughter_volume_ratio": 0.5, "every_min": 1, "max_generation": 12}},
        "cortex": {
            "lateral": {"region": "all", "faces": "lateral", "tension_mN_per_m": 0.4, "program": RAMP,
                        "noise": {"spread": 0.3, "correlation_s": 120, "seed": seed}},
            "apical": {"region": "all", "tension_mN_per_m": 0.35, "program": RAMP},
            "basal": {"region": "all", "faces": "basal", "tension_mN_per_m": 0.35, "program": RAMP},
        },
        "time": {"end_min": 120, "max_step_s": 10, "tolerance_um": 0.2},
        "stop": {"at_equilibrium": False},
        "measure": {"sets": ["neighbours"]},
    }


def interior(simulation):
    """Return the neighbours of each cell, and which cells are neither at the rim nor beside it."""
    about = defaultdict(set)
    for a, b in simulation.neighbours:
        about[a].add(b), about[b].add(a)
    walls = simulation.walls
    rim = set(walls["cell"][walls["other"] < 0])
    return about, [cell for cell in about if cell not in rim and not about[cell] & rim]


def grown(seed, cells):
    simulation = plica.Simulation(scenario(seed), threads=1)
    simulation.run(callback=lambda sim, step: len(sim.pressures) >= cells)
    return simulation


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--cells", type=int, default=300)
    chosen = parser.parse_args()
    sides, areas, around = [], [], []
    for seed in range(1, chosen.seeds + 1):
        simulation = grown(seed, chosen.cells)
        about, inner = interior(simulation)
        area = simulation.cell_data["apical_area_um2"]
        mean = area[inner].mean()
        sides += [len(about[cell]) for cell in inner]
        areas += [area[cell] / mean for cell in inner]
        around += [sum(len(about[other]) for other in about[cell]) for cell in inner]
        print(f"seed {seed}: {len(simulation.pressures)} cells at {simulation.time_min:.1f} min, {len(inner)} counted, "
              f"{simulation.measures['exchanges']:.0f} exchanges")
    sides, areas, around = np.array(sides), np.array(areas), np.array(around)
    variance = sides.var()
    print(f"\n{len(sides)} cells, {sides.mean():.3f} neighbours (variance {variance:.2f})\n")
    print("neighbours n | share | area / mean | n x mean neighbours of neighbours")
    for n in np.unique(sides):
        of = sides == n
        print(f"{n} | {of.mean():.3f} | {areas[of].mean():.3f} ± {areas[of].std() / np.sqrt(of.sum()):.3f} | "
              f"{around[of].mean():.2f} ± {around[of].std() / np.sqrt(of.sum()):.2f}")
    slope = np.polyfit(sides, areas, 1)[0]
    steepness = np.polyfit(sides - sides.mean(), around, 1)[0]
    print(f"\nLewis: area / mean = 1 + {slope:.3f} (n - 6)\nAboav-Weaire: n m(n) = (6 - a) n + ..., a = {6 - steepness:.2f}")


if __name__ == "__main__":
    main()
