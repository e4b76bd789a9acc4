"""Lewis' and Aboav-Weaire's relations of a proliferating sheet, beside published numbers (docs/developers/sheets.md).

Usage: proliferation.py [--seeds N] [--cells N] [--volumes UM3...]; the package is that of PYTHONPATH. A free sheet of 40 cells
grows, its cells divide at a volume (several: that of their clone) and exchange neighbours, until it has the wanted number; cells at
the rim, and their neighbours, are left out.
"""
import argparse
from collections import defaultdict

import numpy as np
import plica

RAMP = {"time_min": [0, 1], "activity": [0, 1]}


def scenario(seed, volumes):
    cells = np.random.default_rng(seed).permutation(40)
    clones = {f"clone{i}": (cells[i::len(volumes)], volume) for i, volume in enumerate(volumes)}
    return {
        "embryo": {"shape": "sheet", "length_um": 38, "width_um": 38, "cell_count": 40, "cell_height_um": 10, "seed": seed},
        "elasticity": {"model": "neo-hookean", "young_modulus_Pa": 100, "poisson_ratio": 0, "relaxation_min": 1, "corner_barrier_Pa": 30},
        "dynamics": {"surface_drag_Pa_s_per_um": 30},
        "exchange": {"below_um": 0.4},
        "growth": {"all": {"region": "all", "rate_per_h": 2.5, "in_plane": 1.0, "variation": {"spread": 0.3, "seed": seed}}},
        "region": {name: {"ids": ids.tolist()} for name, (ids, _) in clones.items()},
        "division": {name: {"region": name, "when": "volume_above_um3", "threshold": volume, "plane": "longest-axis",
                            "growth_min": 0.5, "daughter_volume_ratio": 0.5, "every_min": 1, "max_generation": 12}
                     for name, (_, volume) in clones.items()},
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


def grown(seed, cells, volumes):
    simulation = plica.Simulation(scenario(seed, volumes), threads=1)
    simulation.run(callback=lambda sim, step: len(sim.pressures) >= cells)
    return simulation


def slopes_by_neighbours(values, sides, volumes):
    """Return the slopes of values by the number of neighbours alone, and at equal volume with its standard error."""
    terms = np.column_stack([sides, volumes, np.ones(len(sides))])
    slopes = np.linalg.lstsq(terms, values, rcond=None)[0]
    variance = np.sum((values - terms @ slopes) ** 2) / (len(sides) - 3)
    return np.polyfit(sides, values, 1)[0], slopes[0], np.sqrt(variance * np.linalg.inv(terms.T @ terms)[0, 0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--cells", type=int, default=300)
    parser.add_argument("--volumes", type=float, nargs="+", default=[480])
    chosen = parser.parse_args()
    sides, areas, volumes, around = [], [], [], []
    for seed in range(1, chosen.seeds + 1):
        simulation = grown(seed, chosen.cells, chosen.volumes)
        about, inner = interior(simulation)
        area = simulation.cell_data["apical_area_um2"]
        mean = area[inner].mean()
        volume = simulation.cell_data["volume_um3"]
        sides += [len(about[cell]) for cell in inner]
        areas += [area[cell] / mean for cell in inner]
        volumes += list(volume[inner] / volume[inner].mean())
        around += [sum(len(about[other]) for other in about[cell]) for cell in inner]
        print(f"seed {seed}: {len(simulation.pressures)} cells at {simulation.time_min:.1f} min, {len(inner)} counted, "
              f"{simulation.measures['exchanges']:.0f} exchanges")
    sides, areas, volumes, around = map(np.array, (sides, areas, volumes, around))
    variance = sides.var()
    print(f"\n{len(sides)} cells, {sides.mean():.3f} neighbours (variance {variance:.2f})\n")
    print("neighbours n | share | area / mean | n x mean neighbours of neighbours")
    for n in np.unique(sides):
        of = sides == n
        print(f"{n} | {of.mean():.3f} | {areas[of].mean():.3f} ± {areas[of].std() / np.sqrt(of.sum()):.3f} | "
              f"{around[of].mean():.2f} ± {around[of].std() / np.sqrt(of.sum()):.2f}")
    slope, at_equal_volume, error = slopes_by_neighbours(areas, sides, volumes)
    steepness = np.polyfit(sides - sides.mean(), around, 1)[0]
    print(f"\nLewis: area / mean = 1 + {slope:.3f} (n - 6); at equal volume {at_equal_volume:.3f} ± {error:.3f}; "
          f"volume / mean = 1 + {np.polyfit(sides, volumes, 1)[0]:.3f} (n - 6)")
    print(f"Spread (SD / mean): area {areas.std():.2f}, volume {volumes.std():.2f}, height {(volumes / areas).std():.2f}; "
          f"correlation of area and n {np.corrcoef(areas, sides)[0, 1]:.2f}")
    print(f"Aboav-Weaire: n m(n) = (6 - a) n + ..., a = {6 - steepness:.2f}")


if __name__ == "__main__":
    main()
