// Symmetry checks for `embryo.mirror`.
#pragma once

#include "scenario/scenario.hpp"
#include "tissue/mirror.hpp"

namespace plica {

/// Returns the solved side of the scenario's mirror planes (at least one). Throws ScenarioError if the tissue, or input
/// on its cells and nodes, is not symmetric.
MirroredSide mirrored_side(const Scenario& scenario, const Tissue& whole);

}  // namespace plica
