// What corotational.cpp and the kernels that calculate for it have in common: plain arrays, so that it does not matter
// how either is compiled. Letters as in docs/theory/corotational.md.
#pragma once

#include <cstddef>

#include "mechanics/kernels/hexahedron_blocks.hpp"

namespace plica {

/// Eight elements side by side: the last index is the element's. A batch that is not full repeats its last element.
struct alignas(64) CorotationalBatch {
  int nodes[8][8];            // corners; three times the node's number
  double gradients[6][3][8];  // of the first six modes, 1/um; that of the seventh is zero
  double hourglass[4][3][8];  // X_a: hourglasses of the rest shape, um
  double shear[8];            // 2 mu V0, nN um
  double stiffness[78][8];    // H, lower triangle by rows, nN/um
};

/// The same of the viscosity, times a second.
struct alignas(64) ViscousBatch {
  double shear[8];
  double stiffness[78][8];
};

/// The elements of a law and where they are. Vectors are x y z a node.
struct CorotationalStep {
  const CorotationalBatch* batches;
  const ViscousBatch* viscous_batches;  // null: not viscous
  std::size_t elements;
  const double* positions;  // um
  // Looked at by viscosity only; as in Step.
  const double* previous_positions;  // um
  const double* earlier_positions;   // um
  double ahead;
  double rate;  // 1/rate_s, 1/s
  bool semidefinite_tangent;
};

/// Kernels for the batches from `first` to before `last`. Each comes from one instruction set.
struct CorotationalKernels {
  /// Writes their energies, nN um: elements, filled up to whole batches.
  void (*write_energies)(const CorotationalStep&, std::size_t first, std::size_t last, double* energies);
  /// Adds their forces, nN.
  void (*add_forces)(const CorotationalStep&, std::size_t first, std::size_t last, double* forces);
  /// Adds their tangent times a direction.
  void (*add_product)(const CorotationalStep&, std::size_t first, std::size_t last, const double* direction,
                      double* product);
  /// Writes the tangent of one batch.
  void (*write_blocks)(const CorotationalStep&, std::size_t batch, HexahedronBlocks& blocks);
};

/// The rotation nearest to F, matrices by columns: polar(), for elements that are inverted or very flat.
void nearest_rotation(const double (&F)[9], double (&R)[9]);

namespace generic {
extern const CorotationalKernels corotational_kernels;
}
namespace avx2 {
extern const CorotationalKernels corotational_kernels;
}
namespace avx512 {
extern const CorotationalKernels corotational_kernels;
}

}  // namespace plica
