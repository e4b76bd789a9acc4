// Products with a dense panel in single precision and with its transpose, the kernels of BlockCholesky solves. Columns
// are zero-padded to whole registers of the widest kind, so loops have no remainder.
#pragma once

#include <cstddef>

#include "mechanics/kernels/kernels.hpp"

namespace plica {

/// Sixteen numbers on one cache line.
struct alignas(64) PanelChunk {
  static constexpr std::size_t size = 16;
  float numbers[size];
};

/// Return the number of chunks that hold as many numbers.
constexpr std::size_t chunks_for(std::size_t numbers) { return (numbers + PanelChunk::size - 1) / PanelChunk::size; }

/// Panel: consecutive columns of `height` chunks each, their number a multiple of three. Zero above the diagonal and in
/// padding.
struct Panel {
  const PanelChunk* columns;
  std::size_t height;
  int width;
};

/// Products for one instruction set.
struct PanelProducts {
  /// Compute y = P x; writes all chunks of y.
  void (*multiply)(const Panel& P, const float* x, PanelChunk* y);
  /// Compute x = P^T y.
  void (*multiply_transposed)(const Panel& P, const PanelChunk* y, float* x);
};

[[nodiscard]] const PanelProducts& panel_products(Kernels kernels);

}  // namespace plica
