// Contact pair: two places of a surface that are kept apart, a point and a facet or two crossing edges
// (docs/theory/self_contact.md). Energy, force, tangent and friction are the same for both kinds.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"

namespace plica {

/// Place on a surface, as weights of up to four nodes of one facet; weights sum to 1.
struct SurfacePlace {
  std::array<NodeId, 4> nodes;
  std::array<double, 4> weights = {};
  int count = 0;

  /// Interpolate vectors of the nodes of the full tissue.
  template <class VectorsOfNodes>
  [[nodiscard]] Vec3 at(const VectorsOfNodes& vectors) const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < count; ++i) sum += weights[i] * vectors[nodes[i].index()];
    return sum;
  }
  [[nodiscard]] std::span<const NodeId> all_nodes() const { return {nodes.data(), static_cast<std::size_t>(count)}; }
};

struct ContactPair {
  std::size_t first;     // index of the point, or of one segment
  int second;            // other segment; no_segment for a point and a facet
  SurfacePlace p, q;     // q: on the facet, or on the other segment
  Vec3 normal;           // N, from q to p if p is outside
  double area = 0;       // um^2, reference: weight of the pair; for edges a multiple of theirs (edge_pairs.hpp)
  double distance = 0;   // um: onset of repulsion; that of the rule, or less if the pair was nearer at detection
  double first_gap = 0;  // um: at the beginning of the step

  static constexpr int no_segment = -1;
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

/// Number of values of a pair in an internal state.
constexpr std::size_t numbers_of_pair = 24;

/// Append the values of a pair: first, second, nodes and weights of p, those of q, normal, area, distance, first gap.
void pack(const ContactPair& pair, std::vector<double>& numbers);
ContactPair unpacked(std::span<const double> numbers);

}  // namespace plica
