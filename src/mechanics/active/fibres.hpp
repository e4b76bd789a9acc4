// Fibres of a cortex on apical or basal faces, along which it pulls more strongly (docs/theory/cortex.md).
#pragma once

#include <array>
#include <span>
#include <tuple>
#include <vector>

#include "mechanics/kernels/tables.hpp"
#include "tissue/faces.hpp"

namespace plica {

/// Axis of fibres: x in the surface, across it, or of each cell: the long axis of its surface, or the direction in
/// which that is stretched most.
enum class FibreAxis { along, across, long_axis, stretch };

/// Material lines in the plane of a face; direction in the reference state, or at the beginning of a step where they
/// turn with their cell.
struct FibreRule {
  double share = 0;                   // of the tension that is theirs, 0 to 1; the rest is isotropic
  double angle_deg = 0;               // from the axis x in the surface, counter-clockwise seen from the apical side
  CellArray angles_deg;               // of each cell, added to it; empty: 0
  FibreAxis axis = FibreAxis::along;  // across: by the angle

  [[nodiscard]] bool turn() const { return axis == FibreAxis::long_axis || axis == FibreAxis::stretch; }
  static auto parts_by_cell(auto& rule) { return std::tie(rule.angles_deg); }
};

/// Write the fibres of a face with these corners in the reference state. Where the surface is normal to the axis, the
/// tension is isotropic: the mean of both directions.
void write_fibres(const FibreRule& rule, const Face& face, bool is_apical, const std::array<Vec3, 4>& corners,
                  FibreBatch& batch, std::size_t place);

/// Axes of the surfaces of cells on one side, by which fibres turn.
class CellAxes {
 public:
  CellAxes() = default;
  CellAxes(const Tissue& tissue, CellSide side, FibreAxis axis);

  struct Axis {
    Vec3 direction;
    double anisotropy;  // (p - q)/(p + q) of the squared principal lengths p >= q: 0 for a circle, 1 for a line
  };
  [[nodiscard]] Axis of(CellId cell, std::span<const Vec3> positions) const;

 private:
  std::vector<std::vector<NodeId>> polygons_;
  std::vector<std::vector<Eigen::RowVector2d>> gradients_;  // weights of the mean gradient; empty: the long axis
};

/// Write the fibres of a face along an axis in space, at the present corners; their share is times its anisotropy.
void write_fibres(double share, const CellAxes::Axis& axis, const std::array<Vec3, 4>& rest_corners,
                  const std::array<Vec3, 4>& corners, FibreBatch& batch, std::size_t place);

}  // namespace plica
