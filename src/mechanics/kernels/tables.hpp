// Interface between laws and their kernels: plain arrays, independent of how either is compiled. Letters as in the
// theory page of each law. A batch is eight elements (or faces); the last index is the element. An incomplete batch
// repeats its last element. Vectors are x y z per node. Kernels process batches `first` to `last` - 1, for one
// instruction set.
#pragma once

#include <cstddef>

namespace plica {

/// Tangents of eight elements, nN/um: 3 x 3 blocks, by columns, of the pairs of corners (0,0), (1,0), (1,1), (2,0), ...
template <int corners>
struct alignas(64) TangentBlocks {
  double blocks[corners * (corners + 1) / 2][9][8];
};
using HexahedronBlocks = TangentBlocks<8>;

/// Kernels that every law has.
template <class Arrays, int corners>
struct ElementKernels {
  /// Add forces, nN; not finite if the energy is not.
  void (*add_forces)(const Arrays&, std::size_t first, std::size_t last, double* forces);
  void (*add_product)(const Arrays&, std::size_t first, std::size_t last, const double* direction, double* product);
  void (*write_blocks)(const Arrays&, std::size_t batch, TangentBlocks<corners>& blocks);
};

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

/// Elements of a law and their positions.
struct CorotationalArrays {
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

struct CorotationalKernels : ElementKernels<CorotationalArrays, 8> {
  /// Write energies, nN um; elements, padded to whole batches.
  void (*write_energies)(const CorotationalArrays&, std::size_t first, std::size_t last, double* energies);
};

/// Return the rotation nearest to F (matrices by columns): polar(), for inverted or very flat elements.
void nearest_rotation(const double (&F)[9], double (&R)[9]);

struct alignas(64) FaceBatch {
  int nodes[4][8];  // corners, in order around the face; 3 x node index
  double blunt[8];  // um^2: area of a Gauss point below which it is regularised (docs/theory/cortex.md)
};

/// Fibres of faces at Gauss points (s, t) = 00, 01, 10, 11: directions f = s x_s + t x_t, of length 1 in the reference
/// state, and weights in the measure of the face, sum of `of_area` |n| + `of_length` |f|.
struct alignas(64) FibreBatch {
  static constexpr double blunt = 0.05;  // |f| below which it is regularised
  double s[4][8], t[4][8], of_area[4][8];
  double of_length[4][8];  // um^2
};

/// Faces under tension and their positions. Tensions and slopes: faces, padded to whole batches.
struct FaceArrays {
  const FaceBatch* batches;
  const FibreBatch* fibres;  // null: none, and measures are areas
  std::size_t faces;
  const double* positions;  // um
  const double* tensions;   // T = dW/dA, nN/um; A: area or measure
  const double* slopes;     // dT/dA, nN/um^3
  /// Whether to omit terms that could make the tangent indefinite: faces under compression, and changes of shape within
  /// a face.
  bool semidefinite_tangent;
};

/// Forces: -T dA/dx; tangent: T d2A/dx2 + dT/dA dA/dx dA/dx^T.
struct FaceKernels : ElementKernels<FaceArrays, 4> {
  /// Write areas or measures, um^2, padded to whole batches: bilinear facets, 2 x 2 Gauss points, regularised near
  /// zero.
  void (*write_areas)(const FaceArrays&, std::size_t first, std::size_t last, double* areas);
};

/// Elements of NeoHookean. Symmetric matrices are xx yy zz xy yz zx; Gauss points are in the order of the corners.
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

/// Relaxed rest shapes C_p, as NeoHookeanBatch::metrics: the memory of the law.
struct FlowedBatch {
  double points[8][6][8];  // Gauss points
};

/// Elements of a law and their positions.
struct NeoHookeanArrays {
  const NeoHookeanBatch* batches;
  const FlowBatch* flows;  // null: no relaxation
  std::size_t elements;
  const double* positions;  // um
  bool semidefinite_tangent;
  // Used only with relaxation: C_p at the beginning of this step and of the previous step; the others as in Step.
  const FlowedBatch* flowed;
  const FlowedBatch* flowed_earlier;
  double ahead;
  double rate_s;
};

struct NeoHookeanKernels : ElementKernels<NeoHookeanArrays, 8> {
  /// Write C_p at the end of the step.
  void (*write_flowed)(const NeoHookeanArrays&, std::size_t first, std::size_t last, FlowedBatch* flowed);
};

struct alignas(64) VolumeBatch {
  int nodes[8][8];         // corners; 3 x node index
  double rest_volumes[8];  // um^3
  int owners[8];           // index of pressure (cell) or bulk modulus (element)
};

/// Elements under pressure and their positions. The pressure is that of the cell, or of dilatation, kappa (1 - V/V0)
/// with kappa of the element.
struct VolumeArrays {
  const VolumeBatch* batches;
  std::size_t elements;
  const double* positions;    // um
  const double* pressures;    // cells, kPa; null: dilatation
  const double* bulk_moduli;  // elements, kPa; of dilatation
  bool semidefinite_tangent;  // dilatation: omit the pressure term
};

/// Forces: pressure dV/dx; tangent: - pressure d2V/dx2 + kappa/V0 dV/dx dV/dx^T, the latter of dilatation; no blocks.
struct VolumeKernels : ElementKernels<VolumeArrays, 8> {
  /// Add element volumes to those of their cells, um^3.
  void (*add_volumes)(const VolumeArrays&, std::size_t first, std::size_t last, double* volumes);
  /// Write dV/dx of every corner, x y z each, um^2.
  void (*write_gradients)(const VolumeArrays&, std::size_t first, std::size_t last, double* gradients);
};

namespace generic {
extern const CorotationalKernels corotational_kernels;
extern const FaceKernels face_kernels;
extern const NeoHookeanKernels neo_hookean_kernels;
extern const VolumeKernels volume_kernels;
}  // namespace generic
namespace avx2 {
extern const CorotationalKernels corotational_kernels;
extern const FaceKernels face_kernels;
extern const NeoHookeanKernels neo_hookean_kernels;
extern const VolumeKernels volume_kernels;
}  // namespace avx2
namespace avx512 {
extern const CorotationalKernels corotational_kernels;
extern const FaceKernels face_kernels;
extern const NeoHookeanKernels neo_hookean_kernels;
extern const VolumeKernels volume_kernels;
}  // namespace avx512

}  // namespace plica
