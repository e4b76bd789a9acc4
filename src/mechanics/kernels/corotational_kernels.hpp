// Interface between corotational.cpp and its kernels: plain arrays, independent of how either is compiled. Letters as
// in docs/theory/corotational.md.
#pragma once

#include <cstddef>

#include "mechanics/kernels/hexahedron_blocks.hpp"

namespace plica {

/// Batch of eight elements; the last index is the element. An incomplete batch repeats its last element.
struct alignas(64) CorotationalBatch {
  int nodes[8][8];            // corners; 3 x node index
  double gradients[6][3][8];  // first six modes, 1/um; zero for the seventh
  double hourglass[4][3][8];  // X_a: hourglasses of the rest shape, um
  double shear[8];            // 2 mu V0, nN um
  double stiffness[78][8];    // H, lower triangle by rows, nN/um
};

/// Batch of viscosity, times a second.
struct alignas(64) ViscousBatch {
  double shear[8];
  double stiffness[78][8];
};

/// Elements of a law and their positions. Vectors are x y z per node.
struct CorotationalStep {
  const CorotationalBatch* batches;
  const ViscousBatch* viscous_batches;  // null: not viscous
  std::size_t elements;
  const double* positions;  // um
  // Used by viscosity only; as in Step.
  const double* previous_positions;  // um
  const double* earlier_positions;   // um
  double ahead;
  double rate;  // 1/rate_s, 1/s
  bool semidefinite_tangent;
};

/// Kernels for batches `first` to `last` - 1, for one instruction set.
struct CorotationalKernels {
  /// Write energies, nN um; elements, padded to whole batches.
  void (*write_energies)(const CorotationalStep&, std::size_t first, std::size_t last, double* energies);
  /// Add forces, nN.
  void (*add_forces)(const CorotationalStep&, std::size_t first, std::size_t last, double* forces);
  /// Add tangent times direction.
  void (*add_product)(const CorotationalStep&, std::size_t first, std::size_t last, const double* direction,
                      double* product);
  /// Write the tangent of one batch.
  void (*write_blocks)(const CorotationalStep&, std::size_t batch, HexahedronBlocks& blocks);
};

/// Return the rotation nearest to F (matrices by columns): polar(), for inverted or very flat elements.
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
