// What a scenario says of each cell at rest, as arrays: what was measured, who acts how strongly and when, moduli.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.hpp"
#include "tissue/tissue.hpp"

namespace plica {

using NamedArrays = std::vector<std::pair<std::string, std::vector<double>>>;

struct RestArrays {
  NamedArrays cells;  // the tissue's arrays; strength_TABLE.NAME; where they matter delay_s_ and pulse_phase_TABLE.NAME
  NamedArrays elements;  // young_modulus_Pa and poisson_ratio, where a table [elasticity.NAME] changes them
};

/// On a tissue that has its regions. Left out is what cannot be made: a profile by an array that the tissue lacks, an
/// array that has no number in some cell.
RestArrays rest_arrays(const Scenario& scenario, const Tissue& tissue);

}  // namespace plica
