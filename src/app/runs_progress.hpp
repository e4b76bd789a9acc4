// Progress of many runs.
#pragma once

#include <chrono>
#include <cstddef>

namespace plica {

/// Number of finished runs and remaining time: a live line on a terminal, or a line every 10 s in a file.
class RunsProgress {
 public:
  /// `before`: runs that were complete at the start or resumption.
  RunsProgress(std::size_t before, std::size_t runs, bool quiet);

  /// `lost`: runs that ended without a result.
  void show(std::size_t done, std::size_t lost = 0);
  void finish() const;

 private:
  using Clock = std::chrono::steady_clock;
  std::size_t before_, runs_;
  bool quiet_, on_terminal_;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace plica
