#include "solver/algebra/blas.hpp"

#include <omp.h>

#include <cstddef>

#include "core/memory.hpp"

extern "C" void sgemm_(const char* transposed_a, const char* transposed_b, const int* m, const int* n, const int* k,
                       const float* alpha, const float* a, const int* lda, const float* b, const int* ldb,
                       const float* beta, float* c, const int* ldc);
// Other libraries do not have these.
extern "C" [[gnu::weak]] void openblas_set_num_threads(int number);
extern "C" [[gnu::weak]] int openblas_get_parallel();

namespace plica {
namespace {

enum class Variant { serial, threads, openmp, other };  // the first three as OpenBLAS counts them
Variant variant() { return openblas_get_parallel == nullptr ? Variant::other : Variant(openblas_get_parallel()); }

std::mutex& mutex() {
  static std::mutex one;
  return one;
}

bool prepare() {
  const int threads = omp_get_max_threads();
  const BlasUse use;
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  // OpenBLAS asks for 128 MiB of address space at its first call, and again for each call at the same time. Most of it
  // is never touched.
  constexpr std::size_t buffer_bytes = (std::size_t{128} << 20) + (std::size_t{64} << 10);
  make_sure_of_memory(buffer_bytes * static_cast<std::size_t>(threads));
  const int one = 1;
  const float number = 1;
  float result = 0;
  sgemm_("N", "N", &one, &one, &one, &number, &number, &one, &number, &one, &number, &result, &one);
  return true;
}

}  // namespace

void prepare_blas() { [[maybe_unused]] static const bool is_prepared = prepare(); }

BlasUse::BlasUse() : threads_(omp_get_max_threads()) {
  if (variant() == Variant::serial) lock_ = std::unique_lock(mutex());
  if (variant() == Variant::openmp) omp_set_num_threads(1);
}

BlasUse::~BlasUse() {
  if (variant() == Variant::openmp) omp_set_num_threads(threads_);
}

}  // namespace plica
