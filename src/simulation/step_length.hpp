// How long the next step is: as long as its error on positions allows, ending on the times that are asked for.
#pragma once

#include "mechanics/model.hpp"
#include "simulation/run.hpp"

namespace plica {

class StepLength {
 public:
  explicit StepLength(const RunControls& controls, const StepLengthMemory& memory = {});

  /// The length of a step that starts at `time_s`.
  [[nodiscard]] double propose(double time_s) const;

  /// The step's error: half h^2 x'', from the change of velocity over it. Nothing is known of it on the first step.
  /// False when it is so large that the step should be taken again, shorter.
  [[nodiscard]] bool accept(const State& before, const State& after, double duration_s);

  /// Begins anew with a short step: after a division nothing is known of the next step's error.
  void restart();

  /// The step could not be solved. False when the next would be too short to be worth it.
  [[nodiscard]] bool halve(double failed_s);

  [[nodiscard]] StepLengthMemory memory() const { return {wanted_s_, previous_s_}; }

 private:
  const RunControls& controls_;
  double wanted_s_;
  double previous_s_ = 0;  // 0: no step yet
};

}  // namespace plica
