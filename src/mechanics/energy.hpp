// Where energy goes over a step, law by law: what cells put in, what the tissue stores, what is lost
// (docs/theory/energy.md).
#pragma once

#include <string>
#include <vector>

#include "mechanics/model.hpp"

namespace plica {

/// The length of a step on which nothing moves: rates do not matter then, if it is so short that nothing flows.
inline constexpr double no_time_s = 1e-9;

/// Of a law that resists changes in proportion to their rate: half of what that costs is in its energy.
EnergyFlow viscous_energy_flow(const Law& law, const MadeStep& made);

/// What the step from `before` to `after` did: of each law, in the model's order, then of the cells' volumes, which
/// work only where cells grow. Of such cells the model has the rest shapes that they had midway.
std::vector<EnergyFlow> energy_flows(const Model& model, const State& before, const State& after);

/// What tables call these.
std::vector<std::string> energy_labels(const Model& model);

}  // namespace plica
