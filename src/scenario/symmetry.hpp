// What [embryo] mirror asks of an embryo and of what acts on it: to be symmetric.
#pragma once

#include "scenario/scenario.hpp"
#include "tissue/mirror.hpp"

namespace plica {

/// The side of the scenario's mirror planes, of which there is one at least, that is solved. Throws ScenarioError where
/// the tissue, or what the scenario says of its cells and nodes, differs from its image.
MirroredSide mirrored_side(const Scenario& scenario, const Tissue& whole);

}  // namespace plica
