// Direction of a Newton iteration: interface of all linear solvers, and the choice between them.
#pragma once

#include <functional>
#include <memory>

#include "solver/linear/iterate.hpp"

namespace plica {

/// Solver for the direction of a Newton iteration:
///   [ A  -J^T ] [ dx           ]   [ forces    ]
///   [ -J   0  ] [ dmultipliers ] = [ -deficits ]   with dx = 0 along fixed directions;
/// A: tangent of all laws, constraints and obstacles; J: gradients of the constraints.
class NewtonDirections {
 public:
  virtual ~NewtonDirections() = default;

  struct Cost {
    int factorisations = 0;
    int linear_solves = 0;
  };
  /// Input for the tolerance (forcing term) of an inexact Newton iteration.
  struct ForcingTermInput {
    double residual_reduction;  // residual after / before the last direction; 0 before the first
    double relative_tolerance;  // of the linear system: the one that would end the step
    bool is_exact = false;      // whether to reach it, as outside of Newton's method
  };
  enum class Status { found, singular, interrupted };
  [[nodiscard]] virtual Status find(const Step& step, const Iterate& at, const Residual& residual,
                                    const ForcingTermInput& forcing, Direction& direction, Cost& cost) = 0;

  /// Discard a reused factorization, so that the next step does not depend on earlier solves.
  virtual void forget_factor() = 0;

  /// Whether the next step may reuse a factorization.
  [[nodiscard]] virtual bool keeps_factor() const = 0;
};

/// Linear method: factorization of the whole system; Krylov method preconditioned by a factorization of the positive
/// definite part (cholesky) or by multigrid; automatic: by size.
enum class LinearMethod { automatic, direct, cholesky, multigrid };

/// Make the Krylov method with the preconditioner of `method`.
std::unique_ptr<NewtonDirections> make_krylov_directions(const Model& model, LinearMethod method,
                                                         std::function<bool()> stop_requested);
/// Make the method, with the direct one beside a Krylov method that fails, up to some size.
std::unique_ptr<NewtonDirections> make_directions(const Model& model, LinearMethod method,
                                                  std::function<bool()> stop_requested);

}  // namespace plica
