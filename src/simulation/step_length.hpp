// Length of the next step: limited by its local error of positions, ending on requested times.
#pragma once

#include <limits>

#include "mechanics/model.hpp"
#include "simulation/controls.hpp"

namespace plica {

class StepLength {
 public:
  /// Continue with steps of about `wanted_s`; 0: start.
  explicit StepLength(const RunControls& controls, double wanted_s = 0);

  /// End time of a step from `time_s`: `until_s` at most, and exactly on the times that steps must end on.
  [[nodiscard]] double propose_end_s(const RunControls& controls, double time_s,
                                     double until_s = std::numeric_limits<double>::infinity()) const;

  /// Whether to accept the step from `before` to `after`; false if its error (step_error) requires a shorter one.
  [[nodiscard]] bool accept(const RunControls& controls, const State& before, const State& after);

  /// Shorten after a failed step. Returns false if the next would be too short.
  [[nodiscard]] bool halve(const RunControls& controls, double failed_s);

  [[nodiscard]] double wanted_s() const { return wanted_s_; }

 private:
  double wanted_s_;
};

}  // namespace plica
