// Meshes of more elements through the height.
#pragma once

#include <string>

#include "scenario/scenario.hpp"

namespace plica {

/// Return what gives cells twice as many elements through the height as they have, to be named in a message: a key of
/// this scenario with its value, or words where it has none.
std::string finer_mesh(const Scenario& scenario, int elements);

}  // namespace plica
