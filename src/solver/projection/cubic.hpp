// Real root of a cubic nearest to zero: Eq. 2 of the paper.
#pragma once

#include <optional>

namespace plica {

/// Cubic polynomial c3 l^3 + c2 l^2 + c1 l + c0.
struct Cubic {
  double c3 = 0, c2 = 0, c1 = 0, c0 = 0;
  [[nodiscard]] double at(double l) const { return ((c3 * l + c2) * l + c1) * l + c0; }
  [[nodiscard]] double slope(double l) const { return (3 * c3 * l + 2 * c2) * l + c1; }
};

/// Return the real root nearest to zero, to rounding. Requires c1 > 0. Empty if there is no real root (c3 = 0 only).
std::optional<double> root_nearest_zero(const Cubic& cubic);

/// Whether all three roots are real and distinct (positive discriminant). Requires c1 > 0.
bool has_three_real_roots(const Cubic& cubic);

}  // namespace plica
