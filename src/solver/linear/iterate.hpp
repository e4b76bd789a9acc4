// Where Newton's method stands within a step, what is unbalanced there, and which way it goes.
#pragma once

#include <cmath>
#include <vector>

#include "mechanics/model.hpp"

namespace plica {

struct Iterate {
  Vectors positions;                   // nodes; um
  std::vector<double> multipliers;     // of all constraints, as State has them
  std::vector<double> contact_forces;  // Contacts; nN
  std::vector<char> in_contact;        // Contacts
};

/// What is left to balance there.
struct Residual {
  Vectors forces;                // unbalanced, all directions; nodes, nN
  std::vector<double> deficits;  // target - value of every function, 0 of those that the step does not hold
  double force = 0;              // norm over free directions, relative
  double constraint = 0;         // largest relative error of a function
  double constraint_excess = 0;  // the same over what is tolerated of its constraint

  [[nodiscard]] bool finite() const { return std::isfinite(force) && std::isfinite(constraint); }
  /// One number to descend on; each part in units of what matters.
  [[nodiscard]] double merit() const { return force + 10 * constraint; }
};

/// A change of the iterate.
struct Direction {
  Vectors positions;                // nodes, those that hang too; um
  std::vector<double> multipliers;  // of all constraints
};

/// What a factor that is kept over steps was made from: enough to make it again, to the same bits. Without positions:
/// none is kept.
struct FactorMemory {
  Iterate at;
  // Of the step in which it was made.
  Vectors previous_positions, previous_velocities, earlier_positions;  // nodes
  double rate_s = 0, end_time_s = 0, ahead = 0;
  std::vector<std::vector<double>> internals;  // laws
  // Contacts that have changed since, in the order in which it learnt of them.
  std::vector<int> changed_contacts;
  std::vector<char> has_left;  // or come
  Vectors normals;
  int iterations_when_new = 0, wasted_iterations = 0;

  [[nodiscard]] bool empty() const { return at.positions.empty(); }
};

/// The memory of a factor made now, and the step that it tells of (which refers to it).
FactorMemory factor_memory(const Step& step, const Iterate& at);
Step step_of(const FactorMemory& memory);

/// The revisions of the laws' patterns in a step: a matrix serves as long as they stay.
std::vector<int> pattern_revisions(const Model& model, const Step& step);

}  // namespace plica
