// Two places of a surface that are kept apart: a point and what it faces, or two edges where they cross
// (docs/theory/self_contact.md). Energy, force, tangent and friction of a pair do not ask which.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"

namespace plica {

/// A place of a surface, as weights of up to four nodes of one facet; they add up to 1.
struct SurfacePlace {
  std::array<NodeId, 4> nodes;
  std::array<double, 4> weights = {};
  int count = 0;

  /// Of any vectors of the whole's nodes.
  template <class VectorsOfNodes>
  [[nodiscard]] Vec3 at(const VectorsOfNodes& vectors) const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < count; ++i) sum += weights[i] * vectors[nodes[i].index()];
    return sum;
  }
  [[nodiscard]] std::span<const NodeId> all_nodes() const { return {nodes.data(), static_cast<std::size_t>(count)}; }
};

struct ContactPair {
  std::size_t first;     // the number of the point, or of one segment
  int second;            // of the other segment; no_segment where a point faces a facet
  SurfacePlace p, q;     // q: on the facet, or on the other segment
  Vec3 normal;           // N, from q to p where p is outside
  double area = 0;       // um^2, at rest: what the pair counts for; of edges, a multiple of theirs (edge_pairs.hpp)
  double distance = 0;   // um: where it begins to push. That of the rule; less where it was nearer when first seen
  double first_gap = 0;  // um: at the step's beginning

  static constexpr int no_segment = -1;
  [[nodiscard]] bool is_of_edges() const { return second != no_segment; }
  /// p - q; of any vectors of the whole's nodes.
  template <class VectorsOfNodes>
  [[nodiscard]] Vec3 apart(const VectorsOfNodes& vectors) const {
    return p.at(vectors) - q.at(vectors);
  }
  /// N.(p - q)
  template <class VectorsOfNodes>
  [[nodiscard]] double gap(const VectorsOfNodes& vectors) const {
    return normal.dot(apart(vectors));
  }
  /// What of it lies in the plane across N.
  [[nodiscard]] Vec3 along(const Vec3& vector) const { return vector - normal.dot(vector) * normal; }
};

/// How many numbers a pair is in an internal state.
constexpr std::size_t numbers_of_pair = 24;

/// Adds a pair's numbers: first, second, nodes and weights of p, those of q, normal, area, distance, first gap.
void pack(const ContactPair& pair, std::vector<double>& numbers);
ContactPair unpacked(std::span<const double> numbers);

}  // namespace plica
