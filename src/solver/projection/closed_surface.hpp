// Closed surface of bilinear facets and its enclosed volume, which the projection conserves.
//
// The volume is the sum of the hex_volume term over the facets, a homogeneous cubic polynomial of the points. So with
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

  /// Make the surface; facets shared by two neighbours with opposite orientation cancel, so all facets of the elements
  /// of a body give its outer surface.
  explicit ClosedSurface(const std::vector<Quad>& facets);
  explicit ClosedSurface(std::span<const Facet> facets);

  [[nodiscard]] const std::vector<NodeId>& nodes() const { return nodes_; }

  /// Gather the positions of its nodes relative to the first, so that rounding does not depend on the position of the
  /// body.
  void gather(std::span<const Vec3> positions, Vectors& points) const;

  /// Compute dV/dx at the points (or any vectors) of its nodes, um^2.
  void gradient(const Vectors& points, Vectors& gradient) const;

  /// Return V(points + l direction) as a polynomial of l; `gradient` is that at the points, `scratch` is overwritten.
  [[nodiscard]] Cubic volume_along(const Vectors& points, const Vectors& gradient, const Vectors& direction,
                                   Vectors& scratch) const;

 private:
  std::vector<NodeId> nodes_;
  std::vector<std::array<int, 4>> facets_;  // indices into nodes_
};

}  // namespace plica
