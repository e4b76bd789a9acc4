// BLAS calls of plica: on one thread, with memory reserved in advance.
#pragma once

#include <mutex>

namespace plica {

/// Prepare BLAS; call it first. Limits OpenBLAS to one thread where a threaded variant is installed, since sums would
/// depend on the number of threads, and reserves its working memory: without enough memory OpenBLAS (0.3) would wait
/// forever within a factorisation; here std::bad_alloc is thrown.
void prepare_blas();

/// Scope guard for calls of BLAS, or of a library that calls it. Serial OpenBLAS has no locks, so only one thread holds
/// the guard at a time; the OpenMP variant queries the number of threads at each call, and gets one.
class BlasUse {
 public:
  BlasUse();
  ~BlasUse();
  BlasUse(const BlasUse&) = delete;
  BlasUse& operator=(const BlasUse&) = delete;

 private:
  std::unique_lock<std::mutex> lock_;
  int threads_;  // number of threads outside the scope
};

}  // namespace plica
