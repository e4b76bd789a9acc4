// The progress of many runs.
#pragma once

#include <chrono>
#include <cstddef>

namespace plica {

/// How many runs have ended, and how long the rest will take: a live line on a terminal, a line now and then in a file.
class RunsProgress {
 public:
  /// `before`: the runs that had ended when the work was begun or gone on with.
  RunsProgress(std::size_t before, std::size_t runs, bool quiet);

  /// `lost`: those that have ended without a result.
  void show(std::size_t done, std::size_t lost = 0);
  void finish() const;

 private:
  using Clock = std::chrono::steady_clock;
  std::size_t before_, runs_;
  bool quiet_, on_terminal_;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace plica
