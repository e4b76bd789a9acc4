#include "solver/algebra/blas.hpp"

#include <omp.h>

#include <cstddef>

#include "core/memory.hpp"

extern "C" void strsm_(const char* side, const char* triangle, const char* transposed, const char* diagonal,
                       const int* m, const int* n, const float* alpha, const float* a, const int* lda, float* b,
                       const int* ldb);
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
  // Products of small matrices do without; a triangular solve takes it.
  const int two = 2;
  const float number = 1, triangle[] = {1, 0, 0, 1};
  float right_side[] = {1, 0, 0, 1};
  strsm_("L", "L", "N", "N", &two, &two, &number, triangle, &two, right_side, &two);
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
