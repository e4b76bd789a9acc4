// Interface between cell_volume.cpp and its kernels: plain arrays, independent of how either is compiled.
#pragma once

#include <cstddef>

namespace plica {

/// Batch of eight elements; the last index is the element. An incomplete batch repeats its last element.
struct alignas(64) VolumeBatch {
  int nodes[8][8];         // corners; 3 x node index
  double rest_volumes[8];  // um^3
  int owners[8];           // index of pressure (cell) or bulk modulus (element)
};

/// Elements under pressure and their positions. Vectors are x y z per node. The pressure is that of the cell, or of
/// dilatation, kappa (1 - V/V0) with kappa of the element.
struct VolumeStep {
  const VolumeBatch* batches;
  std::size_t elements;
  const double* positions;    // um
  const double* pressures;    // cells, kPa; null: dilatation
  const double* bulk_moduli;  // elements, kPa; of dilatation
  bool semidefinite_tangent;  // dilatation: omit the pressure term
};

/// Kernels for batches `first` to `last` - 1, for one instruction set.
struct VolumeKernels {
  /// Add element volumes to those of their cells, um^3.
  void (*add_volumes)(const VolumeStep&, std::size_t first, std::size_t last, double* volumes);
  /// Write dV/dx of every corner, x y z each, um^2.
  void (*write_gradients)(const VolumeStep&, std::size_t first, std::size_t last, double* gradients);
  /// Add pressure dV/dx, nN.
  void (*add_forces)(const VolumeStep&, std::size_t first, std::size_t last, double* forces);
  /// Add (- pressure d2V/dx2 + kappa/V0 dV/dx dV/dx^T, the latter of dilatation) times a direction.
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
