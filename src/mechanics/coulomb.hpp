// Regularised Coulomb friction: the potential limit f(|v|) of the sliding velocity v (docs/theory/coulomb.md). With s
// the stick speed, f' = 2 v/s - (v/s)^2 below s and 1 above: the full limit in sliding, and smooth enough for Newton's
// method near sticking.
#pragma once

#include "core/vector.hpp"

namespace plica {

struct Coulomb {
  double limit = 0;  // nN: coefficient times normal force

  static constexpr double stick_speed = 0.1 / 60;  // um/s: s

  /// Return the potential, nN um/s.
  [[nodiscard]] double potential(const Vec3& velocity) const;
  /// Return the force on the sliding body, nN, opposite to the velocity.
  [[nodiscard]] Vec3 force(const Vec3& velocity) const;
  /// Return -d(force)/d(velocity), nN s/um; positive semidefinite.
  [[nodiscard]] Mat3 resistance(const Vec3& velocity) const;
};

}  // namespace plica
