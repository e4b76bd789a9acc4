// What neo_hookean.cpp and the kernels that calculate for it have in common: plain arrays, so that it does not matter
// how either is compiled. Letters as in docs/theory/neo_hookean.md.
#pragma once

#include <cstddef>

#include "mechanics/kernels/hexahedron_blocks.hpp"

namespace plica {

/// Eight elements side by side: the last index is the element's. A batch that is not full repeats its last element.
/// Symmetric matrices are xx yy zz xy yz zx; Gauss points in the order of the corners.
struct alignas(64) NeoHookeanBatch {
  int nodes[8][8];          // corners; three times the node's number
  double weights[8][8];     // Gauss points; mu det D0, nN um
  double metrics[8][6][8];  // Gauss points; (D0^T D0)^-1, 1/um^2: how the rest shape lies in reference coordinates
};

/// The same of what flows.
struct alignas(64) FlowBatch {
  double frames[8][9][8];  // Gauss points; D0 by columns, um
  double rates[8];         // 1/tau, 1/s; 0: it does not flow
};

/// The elements of a law and where they are. Vectors are x y z a node.
struct NeoHookeanStep {
  const NeoHookeanBatch* batches;
  const FlowBatch* flows;  // null: nothing flows
  std::size_t elements;
  const double* positions;  // um
  bool semidefinite_tangent;
  // Looked at where something flows only: C_p at the step's beginning and at that of the step before, as in
  // NeoHookeanBatch::metrics; the others as in Step.
  const double* flowed;
  const double* flowed_earlier;
  double ahead;
  double rate_s;
};

/// Kernels for the batches from `first` to before `last`. Each comes from one instruction set.
struct NeoHookeanKernels {
  /// Adds their forces, nN: not finite where a Gauss point is inside out.
  void (*add_forces)(const NeoHookeanStep&, std::size_t first, std::size_t last, double* forces);
  /// Adds their tangent times a direction.
  void (*add_product)(const NeoHookeanStep&, std::size_t first, std::size_t last, const double* direction,
                      double* product);
  /// Writes the tangent of one batch.
  void (*write_blocks)(const NeoHookeanStep&, std::size_t batch, HexahedronBlocks& blocks);
  /// Writes C_p at the step's end.
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
