#include "mechanics/derivatives.hpp"

#include <algorithm>

namespace plica {

const LawDerivatives& static_derivatives() {
  static const LawDerivatives derivatives;
  return derivatives;
}

// The energy is the same where x and a previous y change places, so the derivative by y of the forces at x along the
// adjoint is that of the forces at y, by a previous x. The central difference over 1e-3 um has errors below 1e-8 for
// elements of cells.
void add_viscous_gradient(const Law& law, const Step& step, std::span<const Vec3> adjoint,
                          const BeginningGradient& gradient) {
  double largest = 0;
  for (const Vec3& vector : adjoint) largest = std::max(largest, vector.norm());
  if (largest == 0) return;
  const double size = 1e-3 / largest;
  std::vector<Vec3> aside(adjoint.size()), forces(adjoint.size());
  const auto add = [&](std::span<const Vec3> from, double factor, std::span<Vec3> to) {
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t n = 0; n < aside.size(); ++n) aside[n] = step.positions[n] + sign * size * adjoint[n];
      std::ranges::fill(forces, Vec3::Zero());
      law.add_forces({.positions = from,
                      .previous_positions = aside,
                      .previous_velocities = {},
                      .rate_s = step.rate_s,
                      .end_time_s = step.end_time_s},
                     forces);
      for (std::size_t n = 0; n < forces.size(); ++n) to[n] += sign * factor / (2 * size) * forces[n];
    }
  };
  add(step.previous_positions, 1 + step.ahead, gradient.previous);
  if (step.ahead > 0) add(step.earlier_positions, -step.ahead, gradient.earlier);
}

std::unique_ptr<Law> with_strengths(const Law& law, std::span<const double> factors) {
  std::unique_ptr<Law> scaled = law.derivatives().with_strengths(factors);
  if (!scaled)
    throw UsageError(law.label() + ": has no strengths of cells; choose a contraction, a cortex, growth or elasticity");
  scaled->set_label(law.label());
  return scaled;
}

}  // namespace plica
