#include "solver/algebra/panel_products.hpp"

namespace plica {
namespace {

// Registers that hold a chunk, or a part of it. The functions below are compiled for each: out of a type that is wider
// than the processor's registers, GCC 12 makes many moves through memory.
using Sixteen = float __attribute__((vector_size(64), may_alias));
using Eight = float __attribute__((vector_size(32), may_alias));
using Four = float __attribute__((vector_size(16), may_alias));

// Into each version.
#define PLICA_INLINE inline __attribute__((always_inline))

template <class Register>
constexpr int parts = sizeof(PanelChunk) / sizeof(Register);

template <class Register>
PLICA_INLINE const Register* registers(const PanelChunk& chunk) {
  return reinterpret_cast<const Register*>(&chunk);
}
template <class Register>
PLICA_INLINE Register* registers(PanelChunk& chunk) {
  return reinterpret_cast<Register*>(&chunk);
}

// Adds n columns times x to y. They begin at column `first`, above which there are zeros.
template <class Register, int n>
PLICA_INLINE void add_columns(const Panel& P, int first, const float* x, PanelChunk* y) {
  const PanelChunk* column = P.columns + static_cast<std::size_t>(first) * P.height;
  Register factors[n] = {};  // kept in registers: the compiler cannot know that y is not x
#pragma GCC unroll 6
  for (int k = 0; k < n; ++k) factors[k] += x[first + k];
  for (std::size_t i = static_cast<std::size_t>(first) / PanelChunk::size; i < P.height; ++i) {
#pragma GCC unroll 4
    for (int part = 0; part < parts<Register>; ++part) {
      Register sum = registers<Register>(column[i])[part] * factors[0];
#pragma GCC unroll 6
      for (int k = 1; k < n; ++k)
        sum += registers<Register>(column[static_cast<std::size_t>(k) * P.height + i])[part] * factors[k];
      registers<Register>(y[i])[part] += sum;
    }
  }
}

// By halves: adding up number by number would take longer than the products.
PLICA_INLINE float sum_of(const Four& v) {
  const Four half = v + __builtin_shufflevector(v, v, 2, 3, 0, 1);
  return half[0] + half[1];
}
PLICA_INLINE float sum_of(const Eight& v) {
  return sum_of(__builtin_shufflevector(v, v, 0, 1, 2, 3) + __builtin_shufflevector(v, v, 4, 5, 6, 7));
}
PLICA_INLINE float sum_of(const Sixteen& v) {
  return sum_of(__builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7) +
                __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15));
}

// Two sums a column where a chunk is several registers: one would wait for itself.
template <class Register, int n>
PLICA_INLINE void write_dots(const Panel& P, int first, const PanelChunk* y, float* x) {
  constexpr int chains = sizeof(Register) < sizeof(PanelChunk) ? 2 : 1;
  const PanelChunk* column = P.columns + static_cast<std::size_t>(first) * P.height;
  Register sums[chains][n] = {};
  for (std::size_t i = static_cast<std::size_t>(first) / PanelChunk::size; i < P.height; ++i) {
#pragma GCC unroll 4
    for (int part = 0; part < parts<Register>; ++part) {
      const Register factor = registers<Register>(y[i])[part];
#pragma GCC unroll 6
      for (int k = 0; k < n; ++k)
        sums[part % chains][k] +=
            registers<Register>(column[static_cast<std::size_t>(k) * P.height + i])[part] * factor;
    }
  }
#pragma GCC unroll 6
  for (int k = 0; k < n; ++k) x[first + k] = sum_of(chains == 1 ? sums[0][k] : sums[0][k] + sums[chains - 1][k]);
}

template <class Register>
PLICA_INLINE void multiply_by(const Panel& P, const float* x, PanelChunk* y) {
  for (std::size_t i = 0; i < P.height; ++i) y[i] = {};
  int j = 0;
  for (; j + 6 <= P.width; j += 6) add_columns<Register, 6>(P, j, x, y);
  if (j < P.width) add_columns<Register, 3>(P, j, x, y);
}

template <class Register>
PLICA_INLINE void multiply_transposed_by(const Panel& P, const PanelChunk* y, float* x) {
  int j = 0;
  for (; j + 6 <= P.width; j += 6) write_dots<Register, 6>(P, j, y, x);
  if (j < P.width) write_dots<Register, 3>(P, j, y, x);
}

void multiply(const Panel& P, const float* x, PanelChunk* y) { multiply_by<Four>(P, x, y); }
void multiply_transposed(const Panel& P, const PanelChunk* y, float* x) { multiply_transposed_by<Four>(P, y, x); }

#ifdef __x86_64__
#define PLICA_FOR_AVX2 __attribute__((target("avx2,fma")))
#define PLICA_FOR_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,fma")))
PLICA_FOR_AVX2 void multiply_avx2(const Panel& P, const float* x, PanelChunk* y) { multiply_by<Eight>(P, x, y); }
PLICA_FOR_AVX2 void multiply_transposed_avx2(const Panel& P, const PanelChunk* y, float* x) {
  multiply_transposed_by<Eight>(P, y, x);
}
PLICA_FOR_AVX512 void multiply_avx512(const Panel& P, const float* x, PanelChunk* y) { multiply_by<Sixteen>(P, x, y); }
PLICA_FOR_AVX512 void multiply_transposed_avx512(const Panel& P, const PanelChunk* y, float* x) {
  multiply_transposed_by<Sixteen>(P, y, x);
}
#else
constexpr auto multiply_avx2 = multiply, multiply_avx512 = multiply;
constexpr auto multiply_transposed_avx2 = multiply_transposed, multiply_transposed_avx512 = multiply_transposed;
#endif

constexpr PanelProducts generic_products = {multiply, multiply_transposed};
constexpr PanelProducts avx2_products = {multiply_avx2, multiply_transposed_avx2};
constexpr PanelProducts avx512_products = {multiply_avx512, multiply_transposed_avx512};

}  // namespace

const PanelProducts& panel_products(Kernels kernels) {
  return kernels_for(kernels, generic_products, avx2_products, avx512_products);
}

}  // namespace plica
