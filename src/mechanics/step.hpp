// A time step as laws see it.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "core/vector.hpp"

namespace plica {

struct Model;

/// State of a step: the unknown positions at its end, and everything constant during it. A quantity q of positions
/// changes at the end of the step at the rate
///   (q(positions) - q_before) / rate_s,  q_before = q(previous) + ahead (q(previous) - q(earlier)),
/// with ahead = 0 and rate_s = h in a step of first order, of length h (docs/theory/step.md).
struct Step {
  std::span<const Vec3> positions;            // x at the end of the step, um; nodes
  std::span<const Vec3> previous_positions;   // x at its beginning, um; nodes
  std::span<const Vec3> previous_velocities;  // v at its beginning, um/s; nodes
  double rate_s = 0;                          // > 0
  double end_time_s = 0;                      // activity programs are read here
  // Whether tangents omit terms that could make them indefinite, for solvers of positive definite systems. The header
  // of each law names the omitted terms. Forces do not change.
  bool semidefinite_tangent = false;
  std::span<const Vec3> earlier_positions = {};  // x at the beginning of the step before, um; nodes; where ahead > 0
  double ahead = 0;                              // >= 0
  std::span<const std::vector<double>> internals = {};  // laws: their states at the step's beginning
  std::span<const double> internal = {};                // that of the present law (for_laws)
  const Model* grown = nullptr;                         // model at its end; null: that of the stepper (for_laws)

  /// Return q_before of a quantity of node positions.
  template <class Quantity>
  [[nodiscard]] auto before(const Quantity& q) const -> decltype(q(previous_positions)) {
    if (ahead == 0) return q(previous_positions);
    return extrapolated(q(previous_positions), q(earlier_positions));
  }
  /// Return its length, s: of a step w times as long as the last, rate_s is h (1 + w)/(1 + 2 w) and ahead
  /// w^2/(1 + 2 w).
  [[nodiscard]] double length_s() const {
    const double w = ahead + std::sqrt(ahead * (1 + ahead));
    return rate_s * (1 + 2 * w) / (1 + w);
  }
  /// Return q_before from the values at the beginning of this step and of the step before.
  template <class Value>
  [[nodiscard]] Value extrapolated(const Value& previous, const Value& earlier) const {
    return (1 + ahead) * previous - ahead * earlier;
  }
};

/// Completed step, for its energies (docs/theory/energy.md).
struct CompletedStep {
  Step begin, end;  // motionless: positions and internal states before and after the step
  Step motion;      // from one to the other at mean rates, with the internal states before; programs read midway
};

}  // namespace plica
