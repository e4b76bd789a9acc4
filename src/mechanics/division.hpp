// Cells divide and daughters grow, between two steps: what changes of the model and of its state. The cut itself is
// tissue/division.hpp. Theory: docs/theory/division.md.
#pragma once

#include <span>

#include "mechanics/model.hpp"
#include "tissue/division.hpp"

namespace plica {

/// One cell to be divided.
struct PlannedDivision {
  CellCut cut;
  double growth_s = 0;      // from the cut until the daughters have their final size; 0: at once
  double volume_ratio = 1;  // a daughter's final volume over her mother's: 1 as large, 0.5 a half
};

/// Cuts the cells at the state's time. Positions, momentum and contraction's tension do not change; pressures and
/// velocities are handed on. Each daughter's
/// target volume starts at what her half has, her rest shape at the half of her mother's; both then grow (`grow`).
/// std::logic_error when the tissue is indivisible.
Division divide_cells(Model& model, State& state, std::span<const PlannedDivision> planned);

/// Gives growing daughters the rest shape and target volume of `time_s`. Depends on the time only, so that a step can
/// be taken again.
void grow(Model& model, double time_s);

}  // namespace plica
