// Number of threads.
#pragma once

#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace plica {

/// Sets the number of threads for its lifetime.
class ThreadCount {
 public:
  explicit ThreadCount(int threads) : before_(omp_get_max_threads()) { omp_set_num_threads(threads); }
  ~ThreadCount() { omp_set_num_threads(before_); }
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;

 private:
  int before_;
};

/// Number of threads to use: `asked` if above 0; else OMP_NUM_THREADS; else one per 5000 elements, up to the processors
/// of the machine.
inline int threads_for(int asked, std::size_t elements) {
  if (asked > 0) return asked;
  if (std::getenv("OMP_NUM_THREADS") != nullptr) return omp_get_max_threads();
  constexpr std::size_t elements_a_thread = 5000;
  return static_cast<int>(std::min<std::size_t>(omp_get_num_procs(), 1 + elements / elements_a_thread));
}

}  // namespace plica
