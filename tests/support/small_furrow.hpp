// A small embryo whose belly is drawn in, as a scenario: seconds, with what a closing furrow has but the yolk.
#pragma once

#include "support/testing.hpp"

namespace plica::support {

inline const std::string small_furrow = R"(format = 1
[embryo]
length_um = 300
diameter_um = 160
cell_height_um = 30
cells = [12, 8, 8]
[region.belly]
face = "ventral"
cells_across = 4
[elasticity]
young_modulus_Pa = 5
poisson_ratio = 0
corner_barrier_Pa = 10
[vitelline]
gap_um = 0.5
[dynamics]
surface_drag_Pa_s_per_um = 4
[cortex.apical]
region = "belly"
tension_mN_per_m = 1
saturation_ratio = 0.16
program = { time_min = [0, 1], activity = [0, 1] }
profile = { shape = "gaussian", sigma_cells = 2, full_length_um = 200, fade_um = 40 }
[cortex.basal]
region = "all"
faces = "basal"
stiffness_mN_per_m = 0.3
relaxation_min = 15
[cortex.walls]
region = "all"
faces = "lateral"
stiffness_mN_per_m = 0.02
compression_ratio = 0.1
[self_contact]
surface = "both"
search_um = 20
[time]
end_min = 2
[stop]
at_equilibrium = false
)";

}  // namespace plica::support
