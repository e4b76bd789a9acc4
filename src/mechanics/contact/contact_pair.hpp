// Contact pair: two places of a surface that are kept apart, a point and a facet or two crossing edges
// (docs/theory/self_contact.md). Energy, force, tangent and friction are the same for both kinds.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "core/ids.hpp"
#include "core/vector.hpp"

namespace plica {

/// Node kept as a number, so that pairs are a view of the numbers of an internal state.
class KeptNode {
 public:
  KeptNode() = default;
  KeptNode(NodeId node) : number_(node.number()) {}    // NOLINT: meant to convert
  operator NodeId() const { return NodeId(index()); }  // NOLINT
  [[nodiscard]] std::size_t index() const { return static_cast<std::size_t>(number_); }
  [[nodiscard]] bool valid() const { return number_ >= 0; }

 private:
  double number_ = -1;
};

/// Place on a surface, as weights of up to four nodes of one facet; weights sum to 1.
struct SurfacePlace {
  std::array<KeptNode, 4> nodes;
  std::array<double, 4> weights = {};

  SurfacePlace() = default;
  SurfacePlace(const std::array<NodeId, 4>& of, int count, const std::array<double, 4>& weights_of = {})
      : weights(weights_of) {
    std::copy_n(of.begin(), count, nodes.begin());
  }
  [[nodiscard]] int count() const {
    int valid = 0;
    while (valid < 4 && nodes[valid].valid()) ++valid;
    return valid;
  }
  /// Interpolate vectors of the nodes of the full tissue.
  template <class VectorsOfNodes>
  [[nodiscard]] Vec3 at(const VectorsOfNodes& vectors) const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 4 && nodes[i].valid(); ++i) sum += weights[i] * vectors[nodes[i].index()];
    return sum;
  }
  [[nodiscard]] std::span<const KeptNode> all_nodes() const { return std::span(nodes).first(count()); }
};

struct ContactPair {
  double first;          // index of the point, or of one segment
  double second;         // other segment; no_segment for a point and a facet
  SurfacePlace p, q;     // q: on the facet, or on the other segment
  Vec3 normal;           // N, from q to p if p is outside
  double area = 0;       // um^2, reference: weight of the pair; for edges a multiple of theirs (edge_pairs.hpp)
  double distance = 0;   // um: onset of repulsion; that of the rule, or less if the pair was nearer at detection
  double first_gap = 0;  // um: at the beginning of the step

  static constexpr double no_segment = -1;
  [[nodiscard]] bool is_of_edges() const { return second != no_segment; }
  /// Return p - q, interpolated from vectors of the nodes of the full tissue.
  template <class VectorsOfNodes>
  [[nodiscard]] Vec3 apart(const VectorsOfNodes& vectors) const {
    return p.at(vectors) - q.at(vectors);
  }
  /// Return the gap N.(p - q).
  template <class VectorsOfNodes>
  [[nodiscard]] double gap(const VectorsOfNodes& vectors) const {
    return normal.dot(apart(vectors));
  }
  /// Return the part of p - q in the plane normal to N.
  [[nodiscard]] Vec3 along(const Vec3& vector) const { return vector - normal.dot(vector) * normal; }
};

/// Number of values of a pair in an internal state, where pairs follow one another.
constexpr std::size_t numbers_of_pair = 24;
static_assert(sizeof(ContactPair) == numbers_of_pair * sizeof(double));

}  // namespace plica
