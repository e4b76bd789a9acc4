// How many OpenMP threads the work of a Python thread takes.
#pragma once

#include <algorithm>
#include <atomic>

#include "core/threads.hpp"

namespace plica::python {

/// Set in a process that was forked.
inline std::atomic<bool> is_forked = false;

/// A ThreadCount of so many; in a forked process of one. There GNU's OpenMP would wait for ever for the threads of the
/// parent, where these have worked before, and one thread needs none of them. Results are the same. Everything that
/// computes is called within such a scope.
class SafeThreadCount : public ThreadCount {
 public:
  explicit SafeThreadCount(int threads) : ThreadCount(is_forked ? 1 : std::max(1, threads)) {}
};

}  // namespace plica::python
