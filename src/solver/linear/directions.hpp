// The direction of a Newton iteration: the interface of all ways to find it, and the choice between them.
#pragma once

#include <functional>
#include <memory>

#include "solver/linear/iterate.hpp"

namespace plica {

/// Finds the direction of a Newton iteration: the solution of
///   [ A  -J^T ] [ dx           ]   [ forces    ]
///   [ -J   0  ] [ dmultipliers ] = [ -deficits ]   with dx = 0 along fixed directions;
/// A: tangent of all laws, constraints and obstacles, J: gradients of the constraints' functions.
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
