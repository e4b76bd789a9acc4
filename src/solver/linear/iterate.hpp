// Iterate of Newton's method, its residual, and its direction.
#pragma once

#include <cmath>
#include <vector>

#include "mechanics/model.hpp"

namespace plica {

struct Iterate {
  Vectors positions;                    // nodes; um
  std::vector<double> multipliers;      // all constraints, as in State
  std::vector<double> obstacle_forces;  // ObstacleContacts; nN
  std::vector<char> on_obstacle;        // ObstacleContacts
};

/// Residual of an iterate.
struct Residual {
  Vectors forces;                // unbalanced, all directions; nodes, nN
  std::vector<double> deficits;  // target - value of every function; 0 if not held
  double force = 0;              // norm over free directions, relative
  double constraint = 0;         // largest relative error of a function
  double constraint_excess = 0;  // largest ratio of error to tolerance

  [[nodiscard]] bool finite() const { return std::isfinite(force) && std::isfinite(constraint); }
  /// Return the merit function of the line search; each part is scaled by its tolerance.
  [[nodiscard]] double merit() const { return force + 10 * constraint; }
};

/// Direction: change of an iterate.
struct Direction {
  Vectors positions;                // nodes, including hanging ones; um
  std::vector<double> multipliers;  // all constraints
};

}  // namespace plica
