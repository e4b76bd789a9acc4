#include "mechanics/active/fibres.hpp"

#include <cmath>
#include <numbers>

namespace plica {

void write_fibres(const FibreRule& rule, const Face& face, bool is_apical, const std::array<Vec3, 4>& corners,
                  FibreBatch& batch, std::size_t place) {
  constexpr double least_in_surface = 1e-6;  // squared length of an axis of length 1
  constexpr double low = 0.25 * (1 - std::numbers::inv_sqrt3), high = 0.25 * (1 + std::numbers::inv_sqrt3);
  const double of_cell = rule.angles_deg.empty() ? 0 : rule.angles_deg[face.cell.index()];
  const double angle = (rule.angle_deg + of_cell) * std::numbers::pi / 180;
  const Vec3 a0 = corners[1] - corners[0], a1 = corners[2] - corners[3];
  const Vec3 b0 = corners[3] - corners[0], b1 = corners[2] - corners[1];
  for (int point = 0; point < 4; ++point) {
    const bool is_late_s = point >= 2, is_late_t = point % 2 == 1;
    const Vec3 a = is_late_t ? low * a0 + high * a1 : high * a0 + low * a1;
    const Vec3 b = is_late_s ? low * b0 + high * b1 : high * b0 + low * b1;
    const Vec3 n = a.cross(b), up = (is_apical ? 1 : -1) * n.normalized();
    const Vec3 axis = Vec3::UnitX() - up.x() * up;
    const bool has_axis = axis.squaredNorm() > least_in_surface;
    const Vec3 along = has_axis ? axis.normalized() : Vec3(Vec3::Zero());
    const Vec3 fibre = std::cos(angle) * along + std::sin(angle) * up.cross(along);
    // The vector of the plane of a and b that has these products with both.
    batch.s[point][place] = fibre.cross(b).dot(n) / n.squaredNorm();
    batch.t[point][place] = a.cross(fibre).dot(n) / n.squaredNorm();
    batch.of_area[point][place] = has_axis ? 1 - rule.share : 1 - 0.5 * rule.share;
    batch.of_length[point][place] = has_axis ? rule.share * n.norm() : 0;
  }
}

}  // namespace plica
