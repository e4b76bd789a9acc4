// What the machine can do at best, measured: the ceilings that kernels are held against. One thread or several.
#pragma once

#include <cstddef>

#include "mechanics/kernels.hpp"

namespace plica::bench {

/// Floating-point operations a second of independent chains of a * b + c in registers: fused, two operations each, where
/// the instruction set has that; with `threads` threads at once. The best of some rounds of a millisecond.
double multiply_add_rate(Kernels kernels, int threads = 1);

/// Bytes a second at which numbers are read from memory and added up, an array of `bytes` again and again; each of
/// `threads` threads reads its part. What fits a cache stays there. The best of some rounds.
double read_bandwidth(Kernels kernels, std::size_t bytes, int threads = 1);

}  // namespace plica::bench
