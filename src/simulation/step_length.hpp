// How long the next step is: as long as its error on positions allows, ending on the times that are asked for.
#pragma once

#include "mechanics/model.hpp"
#include "simulation/run.hpp"

namespace plica {

class StepLength {
 public:
  /// Goes on with steps of about `wanted_s`; 0: begins.
  explicit StepLength(const RunControls& controls, double wanted_s = 0);

  /// The length of a step that starts at `time_s`.
  [[nodiscard]] double propose(double time_s) const;

  /// Whether the step from `before` to `after` stands. False when its error (step_error) is so large that it should
  /// be taken again, shorter.
  [[nodiscard]] bool accept(const State& before, const State& after);

  /// Begins anew with a short step: after a division nothing is known of how things change.
  void restart();

  /// The step could not be solved. False when the next would be too short to be worth it.
  [[nodiscard]] bool halve(double failed_s);

  [[nodiscard]] double wanted_s() const { return wanted_s_; }

 private:
  const RunControls& controls_;
  double wanted_s_;
};

}  // namespace plica
