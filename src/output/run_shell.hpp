// The vitelline shell around a run's frames.
#pragma once

#include <optional>

#include "core/vector.hpp"
#include "mechanics/vitelline.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// The shell as a run of the scenario has it, for a mesh at rest with these nodes; nothing where it has none.
std::optional<Capsule> shell_of(const Scenario& scenario, const Vectors& rest_positions);

}  // namespace plica
