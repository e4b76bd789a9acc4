"""Print how far the edges of a wound recoil within 6 s, along the embryo's axis and across: for the patch of
scenarios/living/embryo.toml, compared with the same patch unwounded. Takes no arguments and a minute.
"""
import numpy as np

import plica

WOUNDED_MIN, SEEN_MIN = 7, 7.1


def size(sim):
    """Length and width of the patch, µm, by the apical nodes on its border."""
    of_patch = np.unique(sim.hexahedra[sim.regions["patch"][sim.hexahedron_cell]][:, 4:])
    rest, now = sim.rest_positions[of_patch], sim.positions[of_patch]
    x, y = rest[:, 0], rest[:, 1]
    length = now[np.isclose(x, x.max()), 0].mean() - now[np.isclose(x, x.min()), 0].mean()
    return np.array([length, 2 * now[y > y.max() - 1, 1].mean()])  # the embryo is mirrored: the other side is the same


scenario = plica.Scenario("scenarios/living/embryo.toml")
sizes = []
for wounded in (False, True):
    if wounded:
        scenario.update({"ablation.wound.region": "patch", "ablation.wound.faces": ["apical"], "ablation.wound.at_min": WOUNDED_MIN})
    sim = plica.Simulation(scenario)
    sim.run(until_min=SEEN_MIN)
    sizes.append(size(sim))
(length, width), (along, across) = sizes[0], sizes[1] - sizes[0]
print(f"patch {length:.1f} µm long, {width:.1f} µm wide; {60 * (SEEN_MIN - WOUNDED_MIN):.0f} s after the wound")
print(f"{along:.2f} µm longer (its ends recoil), {across:.2f} µm wider (its sides recoil) than unwounded")
