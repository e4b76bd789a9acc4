// Interface between laws of face areas and their kernels: plain arrays, independent of how either is compiled.
#pragma once

#include <cstddef>

namespace plica {

/// Batch of eight faces; the last index is the face. An incomplete batch repeats its last face.
struct alignas(64) FaceBatch {
  int nodes[4][8];  // corners, in order around the face; 3 x node index
  double blunt[8];  // um^2: area of a Gauss point below which it is regularised (docs/theory/cortex.md)
};

/// Tangents of eight faces, nN/um: 3 x 3 blocks, by columns, of the 10 pairs of corners (0,0), (1,0), (1,1), ...
struct alignas(64) FaceBlocks {
  double blocks[10][9][8];
};

/// Faces under tension and their positions. Vectors are x y z per node. Tensions and slopes: faces, padded to whole
/// batches.
struct FaceStep {
  const FaceBatch* batches;
  std::size_t faces;
  const double* positions;  // um
  const double* tensions;   // T = dW/dA, nN/um
  const double* slopes;     // dT/dA, nN/um^3
  /// Whether to omit terms that could make the tangent indefinite: faces under compression, and changes of shape within
  /// a face.
  bool semidefinite_tangent;
};

/// Kernels for batches `first` to `last` - 1, for one instruction set.
struct FaceKernels {
  /// Write areas, um^2, padded to whole batches: bilinear facets, 2 x 2 Gauss points, regularised near zero.
  void (*write_areas)(const FaceStep&, std::size_t first, std::size_t last, double* areas);
  /// Add -T dA/dx, nN.
  void (*add_forces)(const FaceStep&, std::size_t first, std::size_t last, double* forces);
  /// Add (T d2A/dx2 + dT/dA dA/dx dA/dx^T) times a direction.
  void (*add_product)(const FaceStep&, std::size_t first, std::size_t last, const double* direction, double* product);
  /// Write the tangent of one batch.
  void (*write_blocks)(const FaceStep&, std::size_t batch, FaceBlocks& blocks);
};

namespace generic {
extern const FaceKernels face_kernels;
}
namespace avx2 {
extern const FaceKernels face_kernels;
}
namespace avx512 {
extern const FaceKernels face_kernels;
}

}  // namespace plica
