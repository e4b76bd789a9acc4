// What the machine can do at best, measured: the ceilings that kernels are held against; and the clock that all are
// timed by. One round a call, a millisecond or so: rounds of kernels and of ceilings are to take turns, so that what
// else runs on the machine slows both.
#pragma once

#include <cstddef>
#include <vector>

#include "mechanics/kernels/kernels.hpp"

namespace plica::bench {

/// Seconds that `work()` takes: of one thread by its processor time, of several by the wall clock.
template <class Work>
double seconds(int threads, const Work& work);

/// Floating-point operations a second of independent chains of a * b + c in registers, `threads` threads at once; fused
/// and so two operations each, where the instruction set has that.
double multiply_add_rate(Kernels kernels, int threads = 1);

/// Reading from memory and adding up: an array of `bytes`, again and again; each thread reads its part. What fits a
/// cache stays there.
class Reading {
 public:
  Reading(Kernels kernels, std::size_t bytes, int threads = 1);
  /// Bytes a second.
  [[nodiscard]] double rate() const;

 private:
  struct alignas(64) Line {
    double values[8];
  };
  Kernels kernels_;
  int threads_;
  std::size_t lines_;  // a thread
  std::vector<Line> values_;
};

/// The clock of `seconds`, s.
double now(int threads);

template <class Work>
double seconds(int threads, const Work& work) {
  const double start = now(threads);
  work();
  return now(threads) - start;
}

}  // namespace plica::bench
