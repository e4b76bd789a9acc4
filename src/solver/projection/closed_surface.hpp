// Closed surface of bilinear facets and its enclosed volume, which the projection conserves, and the real root of a
// cubic nearest to zero: Eq. 2 of the paper.
//
// The volume is the sum of the hex_volume term over the facets, a homogeneous cubic polynomial of the points. So with
// g(x) its gradient, V(x) = x.g(x)/3, and along a direction d
//   V(x + l d) = V(x) + l g(x).d + l^2 x.g(d) + l^3 d.g(d)/3    exactly.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Cubic polynomial c3 l^3 + c2 l^2 + c1 l + c0.
struct Cubic {
  double c3 = 0, c2 = 0, c1 = 0, c0 = 0;
  [[nodiscard]] double at(double l) const { return ((c3 * l + c2) * l + c1) * l + c0; }
  [[nodiscard]] double slope(double l) const { return (3 * c3 * l + 2 * c2) * l + c1; }
};

/// Return the real root nearest to zero, to rounding. Requires c1 > 0. Empty if there is no real root (c3 = 0 only).
std::optional<double> root_nearest_zero(const Cubic& cubic);

/// Whether all three roots are real and distinct (positive discriminant). Requires c1 > 0.
bool has_three_real_roots(const Cubic& cubic);

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
