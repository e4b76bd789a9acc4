// What cell_volume.cpp and the kernels that calculate for it have in common: plain arrays, so that it does not matter
// how either is compiled.
#pragma once

#include <cstddef>

namespace plica {

/// Eight elements side by side: the last index is the element's. A batch that is not full repeats its last element.
struct alignas(64) VolumeBatch {
  int nodes[8][8];         // corners; three times the node's number
  double rest_volumes[8];  // um^3
  int owners[8];           // whose pressure they have: their cells; or bulk modulus: they themselves
};

/// Elements under pressure, and where they are. Vectors are x y z a node. The pressure is that of the cell, or that of
/// dilatation, kappa (1 - V/V0), kappa the element's.
struct VolumeStep {
  const VolumeBatch* batches;
  std::size_t elements;
  const double* positions;    // um
  const double* pressures;    // cells, kPa; null: dilatation
  const double* bulk_moduli;  // elements, kPa; of dilatation
  bool semidefinite_tangent;  // of dilatation: without its pressure's share
};

/// Kernels for the batches from `first` to before `last`. Each comes from one instruction set.
struct VolumeKernels {
  /// Adds the elements' volumes to those of their cells, um^3.
  void (*add_volumes)(const VolumeStep&, std::size_t first, std::size_t last, double* volumes);
  /// dV/dx of every element's corners, x y z each, um^2.
  void (*write_gradients)(const VolumeStep&, std::size_t first, std::size_t last, double* gradients);
  /// Adds pressure dV/dx, nN.
  void (*add_forces)(const VolumeStep&, std::size_t first, std::size_t last, double* forces);
  /// Adds (- pressure d2V/dx2 + kappa/V0 dV/dx dV/dx^T, the latter of dilatation) times a direction.
  void (*add_product)(const VolumeStep&, std::size_t first, std::size_t last, const double* direction, double* product);
};

namespace generic {
extern const VolumeKernels volume_kernels;
}
namespace avx2 {
extern const VolumeKernels volume_kernels;
}
namespace avx512 {
extern const VolumeKernels volume_kernels;
}

}  // namespace plica
