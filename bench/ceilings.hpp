// Measured performance limits of the machine, to compare kernels with, and the common clock. One round per call, about
// a millisecond: rounds of kernels and limits should alternate, so that other load slows both.
#pragma once

#include <cstddef>
#include <vector>

#include "mechanics/kernels/kernels.hpp"

namespace plica::bench {

/// Duration of `work()`, s: processor time for one thread, wall time for several.
template <class Work>
double seconds(int threads, const Work& work);

/// Floating-point operations per second of independent chains a * b + c in registers on `threads` threads; fused, so
/// two operations each, if the instruction set has that.
double multiply_add_rate(Kernels kernels, int threads = 1);

/// Repeated reading and summation of an array of `bytes`, each thread its part; arrays that fit a cache stay there.
class Reading {
 public:
  Reading(Kernels kernels, std::size_t bytes, int threads = 1);
  /// Bytes per second.
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

/// Clock used by `seconds`, s.
double now(int threads);

template <class Work>
double seconds(int threads, const Work& work) {
  const double start = now(threads);
  work();
  return now(threads) - start;
}

}  // namespace plica::bench
