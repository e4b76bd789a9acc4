// Fibres of a cortex on apical or basal faces, along which it pulls more strongly (docs/theory/cortex.md).
#pragma once

#include <array>
#include <tuple>

#include "mechanics/kernels/tables.hpp"
#include "tissue/faces.hpp"

namespace plica {

/// Material lines in the plane of a face; direction in the reference state.
struct FibreRule {
  double share = 0;      // of the tension that is theirs, 0 to 1; the rest is isotropic
  double angle_deg = 0;  // from the axis x in the surface, counter-clockwise seen from the apical side
  CellArray angles_deg;  // of each cell, added to it; empty: 0

  static auto parts_by_cell(auto& rule) { return std::tie(rule.angles_deg); }
};

/// Write the fibres of a face with these corners in the reference state. Where the surface is normal to the axis, the
/// tension is isotropic: the mean of both directions.
void write_fibres(const FibreRule& rule, const Face& face, bool is_apical, const std::array<Vec3, 4>& corners,
                  FibreBatch& batch, std::size_t place);

}  // namespace plica
