// How plica calls BLAS: on one thread, with memory that is there.
#pragma once

#include <mutex>

namespace plica {

/// To be called before BLAS is. OpenBLAS, where a variant with threads is installed, is given one thread: sums would
/// depend on their number. And its working memory is taken now: where there is not enough, OpenBLAS (0.3) would
/// otherwise wait for it without end in the middle of a factorisation; here it is std::bad_alloc.
void prepare_blas();

/// To be held while BLAS is called, or a library that does. OpenBLAS's serial variant has no locks, so there only one
/// thread holds it at a time; the variant with OpenMP asks that for threads at each call, whatever it was given, and is
/// told one.
class BlasUse {
 public:
  BlasUse();
  ~BlasUse();
  BlasUse(const BlasUse&) = delete;
  BlasUse& operator=(const BlasUse&) = delete;

 private:
  std::unique_lock<std::mutex> lock_;
  int threads_;  // outside
};

}  // namespace plica
