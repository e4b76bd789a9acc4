// What laws of face areas and the kernels that calculate for them have in common: plain arrays, so that it does not
// matter how either is compiled.
#pragma once

#include <cstddef>

namespace plica {

/// Eight faces side by side: the last index is the face's. A batch that is not full repeats its last face.
struct alignas(64) FaceBatch {
  int nodes[4][8];  // corners, in turn around the face; three times the node's number
  double blunt[8];  // um^2: what a Gauss point stands for is rounded off below this (docs/theory/cortex.md)
};

/// The tangents of eight faces, nN/um: 3 x 3 blocks, by columns, of the 10 pairs of corners (0,0), (1,0), (1,1), ...
struct alignas(64) FaceBlocks {
  double blocks[10][9][8];
};

/// Faces under tension, and where they are. Vectors are x y z a node. Tensions and slopes: faces, filled up to whole
/// batches.
struct FaceStep {
  const FaceBatch* batches;
  std::size_t faces;
  const double* positions;  // um
  const double* tensions;   // T = dW/dA, nN/um
  const double* slopes;     // dT/dA, nN/um^3
  /// Without what could make the tangent indefinite: faces under compression, and the shape's change within the face.
  bool semidefinite_tangent;
};

/// Kernels for the batches from `first` to before `last`. Each comes from one instruction set.
struct FaceKernels {
  /// Areas, filled up to whole batches, um^2: bilinear facets, 2 x 2 Gauss points, rounded off near none.
  void (*write_areas)(const FaceStep&, std::size_t first, std::size_t last, double* areas);
  /// Adds -T dA/dx, nN.
  void (*add_forces)(const FaceStep&, std::size_t first, std::size_t last, double* forces);
  /// Adds (T d2A/dx2 + dT/dA dA/dx dA/dx^T) times a direction.
  void (*add_product)(const FaceStep&, std::size_t first, std::size_t last, const double* direction, double* product);
  /// Writes that tangent of one batch.
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
