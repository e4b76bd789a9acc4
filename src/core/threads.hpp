// Number of threads.
#pragma once

#include <omp.h>

#include <cstddef>

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
int threads_for(int asked, std::size_t elements);

}  // namespace plica
