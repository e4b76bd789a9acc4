// Relative energy norm of the difference between two deformations of a mesh.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Undeformed elements, which define the stiffness K of the energy norm.
struct RestMesh {
  std::span<const std::array<NodeId, 8>> elements;
  std::span<const HexPoints> rest_shapes;  // elements; um
  std::vector<bool> chosen;                // elements included; empty: all
};

/// Compute sqrt((a - b)^T K (a - b)) / sqrt(b^T K b) for displacements a and b (nodes; um). K: linear stiffness of the
/// undeformed elements with condensed incompatible modes for this Poisson's ratio; Young's modulus cancels. Includes
/// rigid rotations. Empty if b has no energy.
std::optional<double> relative_energy_norm(const RestMesh& mesh, double poisson_ratio, std::span<const Vec3> a,
                                           std::span<const Vec3> b);

}  // namespace plica
