// Interface between neo_hookean.cpp and its kernels: plain arrays, independent of how either is compiled. Letters as in
// docs/theory/neo_hookean.md.
#pragma once

#include <cstddef>

#include "mechanics/kernels/hexahedron_blocks.hpp"

namespace plica {

/// Batch of eight elements; the last index is the element. An incomplete batch repeats its last element. Symmetric
/// matrices are xx yy zz xy yz zx; Gauss points are in the order of the corners.
struct alignas(64) NeoHookeanBatch {
  int nodes[8][8];          // corners; 3 x node index
  double weights[8][8];     // Gauss points; mu det D0, nN um
  double metrics[8][6][8];  // Gauss points; (D0^T D0)^-1, 1/um^2: metric of the rest shape in reference coordinates
};

/// Batch of relaxation data.
struct alignas(64) FlowBatch {
  double frames[8][9][8];  // Gauss points; D0 by columns, um
  double rates[8];         // 1/tau, 1/s; 0: no relaxation
};

/// Elements of a law and their positions. Vectors are x y z per node.
struct NeoHookeanStep {
  const NeoHookeanBatch* batches;
  const FlowBatch* flows;  // null: no relaxation
  std::size_t elements;
  const double* positions;  // um
  bool semidefinite_tangent;
  // Used only with relaxation: C_p at the beginning of this step and of the previous step, as in
  // NeoHookeanBatch::metrics; the others as in Step.
  const double* flowed;
  const double* flowed_earlier;
  double ahead;
  double rate_s;
};

/// Kernels for batches `first` to `last` - 1, for one instruction set.
struct NeoHookeanKernels {
  /// Add forces, nN; not finite if a Gauss point is inverted.
  void (*add_forces)(const NeoHookeanStep&, std::size_t first, std::size_t last, double* forces);
  /// Add tangent times direction.
  void (*add_product)(const NeoHookeanStep&, std::size_t first, std::size_t last, const double* direction,
                      double* product);
  /// Write the tangent of one batch.
  void (*write_blocks)(const NeoHookeanStep&, std::size_t batch, HexahedronBlocks& blocks);
  /// Write C_p at the end of the step.
  void (*write_flowed)(const NeoHookeanStep&, std::size_t first, std::size_t last, double* flowed);
};

namespace generic {
extern const NeoHookeanKernels neo_hookean_kernels;
}
namespace avx2 {
extern const NeoHookeanKernels neo_hookean_kernels;
}
namespace avx512 {
extern const NeoHookeanKernels neo_hookean_kernels;
}

}  // namespace plica
