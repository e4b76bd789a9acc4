// Contact pairs of crossing edges (docs/theory/self_contact.md).
//
// Segments are edges of facets and their half diagonals (from a corner to the mean of the corners): the edges of the
// four triangles of a facet. Point-facet pairs detect contact only at points; two ridges that cross between points are
// detected here. Rejected: continuous collision detection, which would have to cut steps, and pairs whose closest
// points are segment ends, which points cover.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "mechanics/contact/contact_pair.hpp"
#include "tissue/mirror.hpp"

namespace plica {

struct ClosestPoint {
  std::array<double, 3> weights;  // barycentric; sum to 1
  double squared_distance;        // um^2
};

/// Return the point of triangle a, b, c nearest to p; the triangle may be degenerate.
ClosestPoint closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Fractions of the two segments, from first to second end.
struct PlacesOnSegments {
  double on_first, on_second;
};

/// Return the closest points of segments a b and c d if both are interior; empty if an end is as near, or the segments
/// are parallel (within 0.001) or have no length.
std::optional<PlacesOnSegments> nearest_inside(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Segment: an edge between two nodes, or a half diagonal from the first of four nodes to their mean.
struct Segment {
  std::array<NodeId, 4> nodes;
  int count;                             // number of nodes: 2 or 4
  std::array<std::size_t, 2> triangles;  // adjacent triangles, equal if there is only one
  double area;                           // um^2, reference: a third of each adjacent triangle
  std::set<NodeId> lying = {};           // nodes of other facets hanging on it

  /// Return the place at a fraction of its length.
  [[nodiscard]] SurfacePlace at(double part) const;
};

class EdgePairs {
 public:
  /// Weight of a pair relative to its area: one place bears what points bear over facets, within half the distance.
  static constexpr double stiffening = 4;

  EdgePairs() = default;
  /// Collect the segments of facets of the full tissue, with reference areas (0 for images). Triangle 4 f + i is at
  /// edge i of facet f. `lying`: nodes that hang on an edge, keyed with the smaller node first.
  EdgePairs(std::span<const std::array<NodeId, 4>> facets, std::span<const double> areas,
            const std::map<std::pair<NodeId, NodeId>, std::set<NodeId>>& lying = {});

  struct Surface {
    std::span<const Vec3> positions;       // nodes of the full tissue
    std::span<const Vec3> triangle_areas;  // area vectors, in any common unit
  };
  /// Find pairs of non-adjacent segments nearer than 4 `distance` whose closest points are interior, in order of
  /// segments. They repel from half the distance on. `known`: pairs of the step that ends here, in order;
  /// `is_searched`: by node of the side, whether segments of its facets are examined.
  [[nodiscard]] std::vector<ContactPair> find(const Surface& surface, double distance, const Mirror& mirror,
                                              std::span<const ContactPair> known,
                                              const std::vector<char>& is_searched) const;
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }

 private:
  std::vector<Segment> segments_;
};

}  // namespace plica
