// A small block that contracts, as a scenario: a run of some milliseconds for tests of whole runs.
#pragma once

#include "scenario/load.hpp"
#include "support/testing.hpp"

namespace plica::support {

/// Six cells, pulled together on their apical edges. Monitors: all.volume_um3, and end.position_um and
/// side.position_um, how far the block's largest x and y are.
inline ScenarioSource pulled_block(const std::string& more = "") {
  return {"block", "block.toml", R"(format = 1
[embryo]
shape = "block"
length_um = 60
width_um = 40
cell_height_um = 40
cells = [3, 2, 1]
[contraction.all]
region = "all"
stiffness_nN_per_um = 1
[time]
end_s = 5
step_s = 0.5
[stop]
at_equilibrium = false
[monitor.all]
quantity = "volume"
over = "sum"
[monitor.end]
quantity = "position"
axis = "x"
face = "apical"
over = "max"
[monitor.side]
quantity = "position"
axis = "y"
face = "apical"
over = "max"
)" + more};
}

}  // namespace plica::support
