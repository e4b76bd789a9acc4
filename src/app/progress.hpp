// Progress of a run: a live line on a terminal, or a line every 10 s in a file.
#pragma once

#include <chrono>

#include "measure/observation.hpp"
#include "simulation/controls.hpp"

namespace plica {

class Progress {
 public:
  Progress(const RunControls& controls, bool quiet);
  void show(const Observation& row);
  /// Erase the live line.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] double part_done(const Observation& row) const;

  const RunControls& controls_;
  bool quiet_;
  bool on_terminal_;
  Clock::time_point start_ = Clock::now(), last_ = start_;
  double fastest_um_per_s_ = 0;
};

}  // namespace plica
