// Error of bending from too few elements through the height of cells.
#pragma once

#include <optional>
#include <span>

#include "mechanics/model.hpp"

namespace plica {

/// Estimate by how much a sheet of corotational elements is bent too far at its present strain, as a part of its
/// bending. A cell of n elements through its height, with ratios a and b of its apical and basal areas to the reference
/// values, has about 0.14 |b - a| / n. This was measured on a film that contracts a sheet, against its solution
/// (docs/developers/convergence.md). The value is the mean over cells, weighted by |b - a|. Empty with other laws of
/// elasticity, and in the reference state.
std::optional<double> bending_error(const Model& model, std::span<const Vec3> positions);

/// Return the largest number of elements through the height of a cell.
int elements_through_height(const Tissue& tissue);

}  // namespace plica
