// How far two deformations of one mesh lie apart, weighed by stiffness.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Elements of one mesh at rest: what the stiffness K of the energy norm is made from.
struct RestMesh {
  std::span<const std::array<NodeId, 8>> elements;
  std::span<const HexPoints> rest_shapes;  // elements; um
  std::vector<bool> chosen;                // elements that count; empty: all
};

/// sqrt((a - b)^T K (a - b)) / sqrt(b^T K b) of displacements a and b from rest (nodes; um). K is the linear stiffness
/// of the elements' rest shapes, incompatible modes condensed, at this Poisson's ratio; Young's modulus cancels. In the
/// fixed frame, so turns of the whole body count. Empty where b has no energy: nothing is relative to it.
std::optional<double> relative_energy_norm(const RestMesh& mesh, double poisson_ratio, std::span<const Vec3> a,
                                           std::span<const Vec3> b);

}  // namespace plica
