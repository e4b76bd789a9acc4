// Products with a dense panel of numbers in single precision, and with its transpose: what a solve with BlockCholesky
// is made of. Columns are padded with zeros to whole registers of the widest kind, so that no loop has a remainder.
#pragma once

#include <cstddef>

#include "mechanics/kernels/kernels.hpp"

namespace plica {

/// Sixteen numbers that lie on one cache line.
struct alignas(64) PanelChunk {
  static constexpr std::size_t size = 16;
  float numbers[size];
};

/// Chunks that hold as many numbers.
constexpr std::size_t chunks_for(std::size_t numbers) { return (numbers + PanelChunk::size - 1) / PanelChunk::size; }

/// A panel: its columns, one after the other, of `height` chunks each, and a multiple of three of them. Zero above the
/// diagonal, and where padded.
struct Panel {
  const PanelChunk* columns;
  std::size_t height;
  int width;
};

/// Products for one instruction set.
struct PanelProducts {
  /// y = P x. All of y's chunks are written.
  void (*multiply)(const Panel& P, const float* x, PanelChunk* y);
  /// x = P^T y.
  void (*multiply_transposed)(const Panel& P, const PanelChunk* y, float* x);
};

[[nodiscard]] const PanelProducts& panel_products(Kernels kernels);

}  // namespace plica
