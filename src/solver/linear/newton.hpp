// What the parts of Newton's method hand to each other within a step: where it stands, what is unbalanced there, and
// which way to go.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "mechanics/model.hpp"

namespace plica {

/// Where Newton's method stands.
struct Iterate {
  Vectors positions;                   // nodes; um
  std::vector<double> pressures;       // cells; kPa
  std::vector<double> contact_forces;  // the vitelline's nodes; nN
  std::vector<char> in_contact;        // the vitelline's nodes
};

/// What a factor that is kept over steps was made from: enough to make it again, to the same bits. Without positions:
/// none is kept.
struct FactorMemory {
  Iterate at;
  // Of the step in which it was made.
  Vectors previous_positions, previous_velocities, earlier_positions;  // nodes
  double rate_s = 0, end_time_s = 0, ahead = 0;
  // Contacts that have changed since, in the order in which it learnt of them.
  std::vector<int> changed_contacts;  // the vitelline's nodes
  std::vector<char> has_left;         // or come
  Vectors normals;
  int iterations_when_new = 0, wasted_iterations = 0;

  [[nodiscard]] bool empty() const { return at.positions.empty(); }
};

/// The memory of a factor made now, and the step that it tells of (which refers to it).
FactorMemory factor_memory(const Step& step, const Iterate& at);
Step step_of(const FactorMemory& memory);

/// What is left to balance there.
struct Residual {
  Vectors forces;                      // unbalanced, all directions; nodes, nN
  std::vector<double> volume_deficit;  // target - V; cells, um^3
  double force = 0;                    // norm over free directions, relative
  double volume = 0;                   // largest relative error

  [[nodiscard]] bool finite() const { return std::isfinite(force) && std::isfinite(volume); }
  /// One number to descend on; each part in units of what matters.
  [[nodiscard]] double merit() const { return force + 10 * volume; }
};

/// A change of the iterate.
struct Direction {
  Vectors positions;              // nodes, those that hang too; um
  std::vector<double> pressures;  // cells; kPa
};

/// The directions in which a node is fixed: the first `fixed` columns of `axes`, orthonormal.
struct NodeFrame {
  Mat3 axes = Mat3::Identity();
  int fixed = 0;
  bool operator==(const NodeFrame&) const = default;
  [[nodiscard]] Vec3 free_part(Vec3 vector) const {
    for (int i = 0; i < fixed; ++i) vector -= axes.col(i).dot(vector) * axes.col(i);
    return vector;
  }
};

/// Frames of the free nodes.
std::vector<NodeFrame> node_frames(const Model& model, const Iterate& at);

/// `direction` without the axes along which the node is held.
Vec3 without_held(const Model& model, std::size_t node, Vec3 direction);

/// Puts nodes in contact back on the shell, along the normals that they are free to move along.
void return_to_shell(const Model& model, Iterate& at);

/// Finds the direction of a Newton iteration: the solution of
///   [ A  -J^T ] [ dx      ]   [ forces          ]
///   [ -J   0  ] [ dlambda ] = [ -volume_deficit ]   with dx = 0 along fixed directions;
/// A: tangent of all laws and constraints, J: gradients of the cells' volumes.
class NewtonDirections {
 public:
  virtual ~NewtonDirections() = default;

  struct Cost {
    int factorisations = 0;
    int linear_solves = 0;
  };
  struct Wish {
    double left;      // of the residual, by the last direction; 0 before the first
    double accuracy;  // relative, of the linear system: what would end the step
  };
  enum class Outcome { found, singular, interrupted };
  [[nodiscard]] virtual Outcome find(const Step& step, const Iterate& at, const Residual& residual, const Wish& wish,
                                     Direction& direction, Cost& cost) = 0;

  /// Forgets a factor that was kept, so that the next step does not depend on what was solved before.
  virtual void forget_factor() = 0;

  /// What the factor that is kept was made from; `recall` makes it again. The model must have the rest shapes that it
  /// had then (see grow()).
  [[nodiscard]] virtual FactorMemory memory() const = 0;
  virtual void recall(const FactorMemory& memory) = 0;
};

/// How that system is solved: by a factor of all of it; or by Krylov's method with a factor of its positive definite
/// part, or with multigrid; automatic: by size.
enum class LinearMethod { automatic, direct, cholesky, multigrid };

std::unique_ptr<NewtonDirections> make_directions(const Model& model, LinearMethod method,
                                                  std::function<bool()> stop_requested);

}  // namespace plica
