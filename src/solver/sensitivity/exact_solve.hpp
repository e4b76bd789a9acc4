// Accurate solves with the linear system of a step, for gradients (docs/theory/gradients.md).
#pragma once

#include <memory>

#include "solver/linear/directions.hpp"
#include "solver/linear/linearised_system.hpp"

namespace plica {

/// Solver of
///   [ A  -J^T ] [ x ]   [ forces ]
///   [ -J   0  ] [ l ] = [ -rates ]   with given x along fixed directions
/// at solved steps, to any accuracy: conjugate residuals with Newton's directions as preconditioner. It keeps their
/// factorization from step to step. The system is symmetric, so it serves transposed problems.
class ExactSolve {
 public:
  ExactSolve(const Model& model, LinearMethod method);

  struct Solution {
    Vectors positions;                // x; nodes, including hanging ones
    std::vector<double> multipliers;  // l; all constraints
  };
  struct RightSide {
    std::span<const Vec3> forces;        // nodes; those of hanging ones are carried (Tissue::carry_hanging)
    std::span<const double> rates = {};  // all constraints; empty: 0
    std::span<const Vec3> fixed = {};    // nodes: x along fixed directions; empty: 0
  };
  /// Solve to a relative tolerance. Throws std::runtime_error if it is not reached.
  [[nodiscard]] Solution solve(const Step& step, const Iterate& at, const RightSide& right, double tolerance);

  /// Factorise again at the next solve, which pays for several of one step.
  void renew() { directions_->forget_factor(); }

  /// Return forces - A x + J^T l of the last solve, along all directions: what fixed directions bear; nodes.
  [[nodiscard]] Vectors unbalanced(const Step& step, const Iterate& at, std::span<const Vec3> forces) const;

  [[nodiscard]] const ObstacleContacts& contacts() const { return system_.contacts(); }
  [[nodiscard]] int linear_iterations() const { return cost_.linear_solves; }
  [[nodiscard]] int factorisations() const { return cost_.factorisations; }

 private:
  /// Start the solution along fixed directions, and return what is left of the right side.
  KrylovVector right_of(const Step& step, const Iterate& at, const RightSide& input);
  /// Add the solution for a right side that is not 0.
  void correct(const Step& step, const Iterate& at, const KrylovVector& right, double tolerance);

  const Model& model_;
  LinearisedSystem system_;
  std::unique_ptr<NewtonDirections> directions_;
  NewtonDirections::Cost cost_;
  ConjugateResiduals residuals_;
  KrylovVector solution_, correction_;
};

}  // namespace plica
