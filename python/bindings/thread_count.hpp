// How many OpenMP threads a Python thread's work takes.
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>

namespace plica::python {

/// That many, until the end of the scope. GNU's OpenMP waits for ever for the threads of its parent in a process that
/// was forked after these had worked: there it is one thread, which needs none of them. Results are the same.
/// Everything that computes is called within such a scope.
class ThreadCount {
 public:
  static inline std::atomic<bool> is_forked = false;

  explicit ThreadCount(int threads) : before_(omp_get_max_threads()) {
    omp_set_num_threads(is_forked ? 1 : std::max(1, threads));
  }
  ~ThreadCount() { omp_set_num_threads(before_); }
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;

 private:
  int before_;
};

}  // namespace plica::python
