// How many threads work.
#pragma once

#include <omp.h>

#include <cstddef>

namespace plica {

/// So many, while it lives; before and after it as many as before.
class ThreadCount {
 public:
  explicit ThreadCount(int threads) : before_(omp_get_max_threads()) { omp_set_num_threads(threads); }
  ~ThreadCount() { omp_set_num_threads(before_); }
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;

 private:
  int before_;
};

/// `asked`, if over 0; else what OMP_NUM_THREADS says; else one for every 5000 elements, up to what the machine has.
int threads_for(int asked, std::size_t elements);

}  // namespace plica
