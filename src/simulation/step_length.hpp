// How long the next step is: as long as its error on positions allows, ending on the times that are asked for.
#pragma once

#include <limits>

#include "mechanics/model.hpp"
#include "simulation/controls.hpp"

namespace plica {

class StepLength {
 public:
  /// Goes on with steps of about `wanted_s`; 0: begins.
  explicit StepLength(const RunControls& controls, double wanted_s = 0);

  /// When a step that starts at `time_s` ends: at `until_s` at the latest, and exactly on what it has to end on.
  [[nodiscard]] double propose_end_s(const RunControls& controls, double time_s,
                                     double until_s = std::numeric_limits<double>::infinity()) const;

  /// Whether the step from `before` to `after` stands. False when its error (step_error) is so large that it should
  /// be taken again, shorter.
  [[nodiscard]] bool accept(const RunControls& controls, const State& before, const State& after);

  /// The step could not be solved. False when the next would be too short to be worth it.
  [[nodiscard]] bool halve(const RunControls& controls, double failed_s);

  [[nodiscard]] double wanted_s() const { return wanted_s_; }

 private:
  double wanted_s_;
};

}  // namespace plica
