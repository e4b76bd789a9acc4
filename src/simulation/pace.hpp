// Progress of a run per work. It ends runs that would take thousands of short, hard steps to fold a crushed tissue.
#pragma once

#include <optional>
#include <string>

#include "mechanics/model.hpp"
#include "simulation/controls.hpp"

namespace plica {

/// Steps since a time, and their Newton iterations, those of rejected attempts included.
struct Pace {
  double since_s = 0;
  int steps = 0;
  int iterations = 0;

  /// Whether enough work is counted to judge the pace.
  [[nodiscard]] bool is_known() const { return iterations >= 300; }
};

/// Cell that the forces crush, and the reason why the run ends there.
struct Standstill {
  CellId cell;
  std::string reason;
};

/// Returns a reason if a known pace is hopeless: it needs at least 5 iterations per step and 10 000 to the end (with a
/// fixed step, takes steps half as long), and a corner is below a hundredth of its reference Jacobian, kept from
/// inversion by the barrier alone. Built-in scenarios stay above 0.04.
std::optional<Standstill> standstill(const Pace& pace, const RunControls& controls, const Model& model,
                                     const State& state);

}  // namespace plica
