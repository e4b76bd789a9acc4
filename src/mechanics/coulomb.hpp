// Coulomb's friction of a place that slides at the velocity v, as the potential limit f(|v|) of a rate (docs/theory/
// coulomb.md). With s the speed below which it counts as sticking, f' = 2 v/s - (v/s)^2 below s and 1 above: all of the
// limit where it slides, and smooth enough for Newton's method where it creeps.
#pragma once

#include "core/vector.hpp"

namespace plica {

struct Coulomb {
  double limit = 0;  // nN: coefficient times normal force

  static constexpr double stick_speed = 0.1 / 60;  // um/s: s

  /// nN um/s
  [[nodiscard]] double potential(const Vec3& velocity) const;
  /// On what slides, nN: against the velocity.
  [[nodiscard]] Vec3 force(const Vec3& velocity) const;
  /// -d(force)/d(velocity), nN s/um: never negative.
  [[nodiscard]] Mat3 resistance(const Vec3& velocity) const;
};

}  // namespace plica
