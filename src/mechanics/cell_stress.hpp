// Passive stress of cells, which activities may read (docs/theory/cell_stress.md).
#pragma once

#include <vector>

#include "mechanics/model.hpp"

namespace plica {

/// Whether activities of a law read it.
bool reads_stress(const Model& model);

/// Return the tension of each cell in the plane of the sheet, kPa: of its mean Cauchy stress by elasticity and passive
/// cortices, the mean over that plane minus the stress along its axis from base to apex. Cell pressures cancel.
std::vector<double> passive_stresses(const Model& model, const State& state);

}  // namespace plica
