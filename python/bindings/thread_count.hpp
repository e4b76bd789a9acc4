// Number of OpenMP threads for work called from a Python thread.
#pragma once

#include <algorithm>
#include <atomic>

#include "core/threads.hpp"

namespace plica::python {

/// Flag set in a forked process.
inline std::atomic<bool> is_forked = false;

/// Scope with this number of OpenMP threads; one in a forked process, where GNU OpenMP would wait forever for the
/// threads of the parent. Results are identical. All computing calls need such a scope.
class SafeThreadCount : public ThreadCount {
 public:
  explicit SafeThreadCount(int threads) : ThreadCount(is_forked ? 1 : std::max(1, threads)) {}
};

}  // namespace plica::python
