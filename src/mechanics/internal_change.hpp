// Derivatives of internal states along changes, for laws whose states are not smooth (docs/theory/gradients.md).
#pragma once

#include <span>

#include "mechanics/law.hpp"

namespace plica {

/// Change of what a step begins with and of positions at its end, as one law sees it.
struct StepChange {
  std::span<const Vec3> positions;   // at the end of the step; nodes
  std::span<const Vec3> previous;    // at its beginning; nodes
  std::span<const Vec3> earlier;     // at the beginning of the step before; nodes, where Step::ahead > 0
  std::span<const double> internal;  // internal state of the law at the beginning
};

/// Law that differentiates its internal states itself; those of other laws are differentiated by central differences.
class InternalChange {
 public:
  virtual ~InternalChange() = default;
  /// Add the derivatives of next, being next_internal(step), along a change.
  virtual void add_internal_change(const Step& step, std::span<const double> next, const StepChange& change,
                                   std::span<double> of_next) const = 0;
};

}  // namespace plica
