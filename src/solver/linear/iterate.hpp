// Iterate of Newton's method, its residual, its direction, and the memory of a kept factor.
#pragma once

#include <cmath>
#include <vector>

#include "mechanics/model.hpp"

namespace plica {

struct Iterate {
  Vectors positions;                   // nodes; um
  std::vector<double> multipliers;     // all constraints, as in State
  std::vector<double> contact_forces;  // Contacts; nN
  std::vector<char> in_contact;        // Contacts
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

/// Input of a kept factor, enough to recompute it bitwise identically. Without positions: none is kept.
struct FactorMemory {
  Iterate at;
  // Step in which it was computed.
  Vectors previous_positions, previous_velocities, earlier_positions;  // nodes
  double rate_s = 0, end_time_s = 0, ahead = 0;
  std::vector<std::vector<double>> internals;  // laws
  // Contacts changed since, in order.
  std::vector<int> changed_contacts;
  std::vector<char> has_left;  // else arrived
  Vectors normals;
  int iterations_when_new = 0, wasted_iterations = 0;

  [[nodiscard]] bool empty() const { return at.positions.empty(); }
};

/// Return the memory of a factor computed now, or the step that it describes (which refers to it).
FactorMemory factor_memory(const Step& step, const Iterate& at);
Step step_of(const FactorMemory& memory);

/// Return the pattern revisions of the laws in a step; a matrix is valid while they are unchanged.
std::vector<int> pattern_revisions(const Model& model, const Step& step);

}  // namespace plica
