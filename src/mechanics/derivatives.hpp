// Derivatives of laws for gradients of runs (docs/theory/gradients.md), as transposed products.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "mechanics/law.hpp"

namespace plica {

/// A run, a law or a key that has no gradient; the message names it, and the remedy.
class NoGradient : public UsageError {
 public:
  using UsageError::UsageError;
};

/// Gradient of an outcome with respect to what a step begins with, as one law sees it.
struct BeginningGradient {
  double ahead;                // Step::ahead
  std::span<Vec3> previous;    // by positions at the beginning of the step; nodes
  std::span<Vec3> earlier;     // by positions at the beginning of the step before; nodes, where ahead > 0
  std::span<double> internal;  // by the internal state of the law

  /// Add the gradient by the extrapolated position of a node (Step::before).
  void add_before(std::size_t node, const Vec3& gradient) const {
    previous[node] += (1 + ahead) * gradient;
    if (ahead > 0) earlier[node] -= ahead * gradient;
  }
};

/// Derivatives of a law. The defaults are those of forces that depend on positions at the end of a step and on time
/// only, and of an internal state that no force reads.
class LawDerivatives {
 public:
  virtual ~LawDerivatives() = default;

  /// Add the gradient of adjoint . forces with respect to what the step begins with.
  virtual void add_force_gradient(const Step& /*step*/, std::span<const Vec3> /*adjoint*/,
                                  const BeginningGradient& /*gradient*/) const {}

  /// Add the gradient of adjoint . next, next being next_internal(step), with respect to positions at the end of the
  /// step and to what it begins with.
  virtual void add_internal_gradient(const Step& /*step*/, std::span<const double> /*next*/,
                                     std::span<const double> /*adjoint*/, std::span<Vec3> /*positions*/,
                                     const BeginningGradient& /*gradient*/) const {}
  /// Return next_internal(step) of `law`, which has these derivatives and maybe other parameters than the run, with
  /// cells in the same regime as in `next`, that of the run; empty if no parameter acts on it.
  [[nodiscard]] virtual std::vector<double> next_internal_like(const Law& law, const Step& step,
                                                               std::span<const double> /*next*/) const {
    return law.next_internal(step);
  }

  /// Move the gradient by what follows signals in an internal state (Law::with_signals), to that by the signals.
  virtual void move_to_signals(std::span<double> /*by_internal*/, std::span<const CellArray> /*signals*/,
                               std::span<CellArray> /*by_signals*/) const {}

  /// Add the derivatives of adjoint . forces by a factor on the strength of each cell, to which forces are
  /// proportional, for laws with strengths.
  virtual void add_strength_gradient(const Step& /*step*/, std::span<const Vec3> /*adjoint*/,
                                     std::span<double> /*of_cells*/) const {}

  /// Return the law with the strengths of its cells times these factors; null for laws without strengths.
  [[nodiscard]] virtual std::unique_ptr<Law> with_strengths(std::span<const double> /*factors*/) const { return {}; }
  /// Whether strengths change rest shapes, target volumes and so forces of other laws, instead of forces of this law.
  [[nodiscard]] virtual bool strengths_change_cells() const { return false; }

  /// Return the law as recorded runs have it, if in others its memory is a step function of positions; else null.
  [[nodiscard]] virtual std::unique_ptr<Law> smooth() const { return {}; }
};

/// Add the gradient of adjoint . forces by previous and earlier positions for a law with a viscous energy
/// |q(x) - q_before|^2 of any quantity q, beside one of positions at the end of the step only.
void add_viscous_gradient(const Law& law, const Step& step, std::span<const Vec3> adjoint,
                          const BeginningGradient& gradient);

/// Return a law with the strengths of its cells times these factors. UsageError if it has none.
std::unique_ptr<Law> with_strengths(const Law& law, std::span<const double> factors);

}  // namespace plica
