// Forces that some cells of a model exert.
#pragma once

#include "measure/monitor.hpp"

namespace plica::support {

inline Vectors forces_of_cells(const Model& model, const State& state, const CellSet& cells) {
  return CellsApart(model, state.positions, cells).forces(model, state);
}

}  // namespace plica::support
