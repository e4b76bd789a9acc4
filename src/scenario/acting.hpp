// Which cells and nodes a table of the scenario is about, on a tissue that has its regions.
#pragma once

#include <vector>

#include "mechanics/active/cell_pattern.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Who acts, how strongly and how late.
CellPattern make_pattern(const ContractionInput& input, const Tissue& tissue);
CellPattern make_pattern(const CortexInput& input, const Tissue& tissue);

/// The nodes of a hold.
std::vector<bool> held_nodes(const HoldInput& input, const Tissue& tissue);

}  // namespace plica
