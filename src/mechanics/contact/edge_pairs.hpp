// Edges of a surface that cross near each other, as pairs of contact (docs/theory/self_contact.md).
//
// Segments are the edges of facets and their half diagonals, from a corner to the mean of the corners: the edges of the
// four triangles that a facet is. Points and facets see each other only where a point is; two ridges that cross between
// points are seen here. Rejected: continuous detection within a step, which would have to cut steps, and pairs of
// segments whose nearest places are ends, which the points are.
#pragma once

#include <array>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "mechanics/contact/contact_pair.hpp"
#include "tissue/mirror.hpp"

namespace plica {

/// An edge between two nodes, or a half diagonal: from the first of four nodes to their mean.
struct Segment {
  std::array<NodeId, 4> nodes;
  int count;                             // of the nodes: 2 or 4
  std::array<std::size_t, 2> triangles;  // that it bounds, twice the same where it bounds one
  double area;                           // um^2, at rest: a third of each of its triangles
  std::set<NodeId> lying = {};           // nodes of others that hang on it

  /// A part of the way along it.
  [[nodiscard]] SurfacePlace at(double part) const;
};

class EdgePairs {
 public:
  /// A pair counts so many times its area: it bears at one place what points bear over facets, within half the
  /// distance.
  static constexpr double stiffening = 4;

  EdgePairs() = default;
  /// Of facets of the whole, and their areas at rest, 0 of images. Triangle 4 f + i is the one at edge i of facet f.
  /// `lying`: nodes that hang on an edge, which has the smaller node first.
  EdgePairs(std::span<const std::array<NodeId, 4>> facets, std::span<const double> areas,
            const std::map<std::pair<NodeId, NodeId>, std::set<NodeId>>& lying = {});

  struct Surface {
    std::span<const Vec3> positions;       // nodes of the whole
    std::span<const Vec3> triangle_areas;  // area vectors, of any one length of scale
  };
  /// In the order of segments: pairs of segments that are not neighbours and nearer than 4 `distance`, whose nearest
  /// places lie inside both. They begin to push at half the distance. `known`: the pairs of the step that ends here, in
  /// their order; `is_searched`, by nodes as the side numbers them: whether segments of a facet with it are looked at.
  [[nodiscard]] std::vector<ContactPair> find(const Surface& surface, double distance, const Mirror& mirror,
                                              std::span<const ContactPair> known,
                                              const std::vector<char>& is_searched) const;
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }

 private:
  std::vector<Segment> segments_;
};

}  // namespace plica
