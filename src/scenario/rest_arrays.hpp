// Per-cell and per-element inputs as arrays: measured values, activation strengths, delays, elastic moduli.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.hpp"
#include "tissue/tissue.hpp"

namespace plica {

using NamedArrays = std::vector<std::pair<std::string, std::vector<double>>>;

struct RestArrays {
  NamedArrays cells;     // the tissue's arrays; strength_TABLE.NAME; if used, delay_s_ and pulse_phase_TABLE.NAME
  NamedArrays elements;  // young_modulus_Pa and poisson_ratio, if [elasticity.NAME] changes them
};

/// Collects the arrays on a tissue with resolved regions. Omits profiles by an array that the tissue lacks, and arrays
/// that are not finite in every cell.
RestArrays rest_arrays(const Scenario& scenario, const Tissue& tissue);

}  // namespace plica
