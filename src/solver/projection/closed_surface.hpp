// A closed surface of bilinear facets and the volume inside it: what the projection keeps.
//
// The volume is the sum of hex_volume's term over the facets, a homogeneous cubic polynomial of the points. So with
// g(x) its gradient, V(x) = x.g(x)/3, and along a direction d
//   V(x + l d) = V(x) + l g(x).d + l^2 x.g(d) + l^3 d.g(d)/3    exactly.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"
#include "solver/projection/cubic.hpp"
#include "tissue/tissue.hpp"

namespace plica {

class ClosedSurface {
 public:
  using Quad = std::array<NodeId, 4>;  // counter-clockwise from outside; a triangle repeats a node

  /// Facets that two neighbours share with opposite orientation cancel: those of all elements of a body make the
  /// surface around it.
  explicit ClosedSurface(const std::vector<Quad>& facets);
  explicit ClosedSurface(std::span<const Facet> facets);

  [[nodiscard]] const std::vector<NodeId>& nodes() const { return nodes_; }

  /// The positions of its nodes relative to the first, so that rounding does not depend on where the body lies.
  void gather(std::span<const Vec3> positions, Vectors& points) const;

  /// dV/dx at the points (or any vectors) of its nodes, um^2.
  void gradient(const Vectors& points, Vectors& gradient) const;

  /// V(points + l direction) as a polynomial of l; `gradient` that at the points, `scratch` is overwritten.
  [[nodiscard]] Cubic volume_along(const Vectors& points, const Vectors& gradient, const Vectors& direction,
                                   Vectors& scratch) const;

 private:
  std::vector<NodeId> nodes_;
  std::vector<std::array<int, 4>> facets_;  // places in nodes_
};

}  // namespace plica
