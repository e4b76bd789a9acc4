// The real root nearest zero of a cubic: the paper's Eq. 2.
#pragma once

#include <optional>

namespace plica {

/// c3 l^3 + c2 l^2 + c1 l + c0.
struct Cubic {
  double c3 = 0, c2 = 0, c1 = 0, c0 = 0;
  [[nodiscard]] double at(double l) const { return ((c3 * l + c2) * l + c1) * l + c0; }
  [[nodiscard]] double slope(double l) const { return (3 * c3 * l + 2 * c2) * l + c1; }
};

/// The real root nearest zero, to rounding. Expects c1 > 0. Nothing where there is no real root (c3 = 0 only).
std::optional<double> root_nearest_zero(const Cubic& cubic);

/// Whether all three roots are real and different (positive discriminant). Expects c1 > 0.
bool has_three_real_roots(const Cubic& cubic);

}  // namespace plica
