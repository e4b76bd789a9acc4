#include "solver/panel_products.hpp"

#include "core/processor.hpp"

namespace plica {
namespace {

using Sixteen = float __attribute__((vector_size(64), may_alias));
using Eight = float __attribute__((vector_size(32)));
using Four = float __attribute__((vector_size(16)));

// Into each version of the functions below, for its own processor.
#define PLICA_INLINE inline __attribute__((always_inline))

PLICA_INLINE const Sixteen& numbers(const PanelChunk& chunk) { return reinterpret_cast<const Sixteen&>(chunk); }

// Adds n columns times x to y. They begin at column `first`, above which there are zeros.
template <int n>
PLICA_INLINE void add_columns(const Panel& P, int first, const float* x, PanelChunk* y) {
  const PanelChunk* column = P.columns + static_cast<std::size_t>(first) * P.height;
  for (std::size_t i = static_cast<std::size_t>(first) / PanelChunk::size; i < P.height; ++i) {
    Sixteen sum = numbers(column[i]) * x[first];
#pragma GCC unroll 6
    for (int k = 1; k < n; ++k) sum += numbers(column[static_cast<std::size_t>(k) * P.height + i]) * x[first + k];
    reinterpret_cast<Sixteen&>(y[i]) += sum;
  }
}

// By halves: adding up number by number would take longer than the products.
PLICA_INLINE float sum_of(const Sixteen& v) {
  const Eight e = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7) +
                  __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
  const Four f = __builtin_shufflevector(e, e, 0, 1, 2, 3) + __builtin_shufflevector(e, e, 4, 5, 6, 7);
  const Four g = f + __builtin_shufflevector(f, f, 2, 3, 0, 1);
  return g[0] + g[1];
}

template <int n>
PLICA_INLINE void write_dots(const Panel& P, int first, const PanelChunk* y, float* x) {
  const PanelChunk* column = P.columns + static_cast<std::size_t>(first) * P.height;
  Sixteen sums[n] = {};
  for (std::size_t i = static_cast<std::size_t>(first) / PanelChunk::size; i < P.height; ++i) {
#pragma GCC unroll 6
    for (int k = 0; k < n; ++k) sums[k] += numbers(column[static_cast<std::size_t>(k) * P.height + i]) * numbers(y[i]);
  }
#pragma GCC unroll 6
  for (int k = 0; k < n; ++k) x[first + k] = sum_of(sums[k]);
}

}  // namespace

PLICA_FOR_NEWER_PROCESSORS_TOO void multiply(const Panel& P, const float* x, PanelChunk* y) {
  for (std::size_t i = 0; i < P.height; ++i) y[i] = {};
  int j = 0;
  for (; j + 6 <= P.width; j += 6) add_columns<6>(P, j, x, y);
  if (j < P.width) add_columns<3>(P, j, x, y);
}

PLICA_FOR_NEWER_PROCESSORS_TOO void multiply_transposed(const Panel& P, const PanelChunk* y, float* x) {
  int j = 0;
  for (; j + 6 <= P.width; j += 6) write_dots<6>(P, j, y, x);
  if (j < P.width) write_dots<3>(P, j, y, x);
}

}  // namespace plica
