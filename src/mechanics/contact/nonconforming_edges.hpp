// Edges of the facets of a surface where nodes hang.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Facets that meet at hanging nodes: their edges differ, but are parts of one line.
class NonconformingEdges {
 public:
  using Edge = std::pair<NodeId, NodeId>;  // as its facet has it

  NonconformingEdges(const Tissue& tissue, const std::map<Edge, std::size_t>& edges);

  /// Whether a facet lies beyond an edge that no other facet has in opposite direction.
  [[nodiscard]] bool is_inner(const Edge& edge) const { return inner_.contains(edge); }
  /// Facets on whose edges a node lies without being one of their nodes.
  [[nodiscard]] std::set<std::size_t> across(NodeId node) const {
    const auto found = across_.find(node);
    return found == across_.end() ? std::set<std::size_t>() : found->second;
  }
  /// Nodes of other facets that lie on an edge, by edge with the smaller node first.
  [[nodiscard]] const std::map<Edge, std::set<NodeId>>& lying() const { return lying_; }
  [[nodiscard]] std::set<NodeId> lying_on(const Edge& edge) const {
    const auto found = lying_.find(std::minmax(edge.first, edge.second));
    return found == lying_.end() ? std::set<NodeId>() : found->second;
  }

 private:
  // In weights of free nodes, relative to the weight of the first of them that changes along it: slopes, and values
  // where that is 0; rounded.
  using Line = std::vector<std::tuple<NodeId, std::int64_t, std::int64_t>>;
  struct Part {
    Line line;
    double from, to;  // weights of that first node
    Edge edge;
    std::size_t facet;
    [[nodiscard]] bool is_forward() const { return from < to; }
    [[nodiscard]] bool holds(double place) const {
      constexpr double rounding = 1e-9;
      return place > std::min(from, to) + rounding && place < std::max(from, to) - rounding;
    }
  };
  void add_end(const Part& part, NodeId node, double place);
  static std::optional<Part> part_of(const Tissue& tissue, const Edge& edge, std::size_t facet);

  std::map<Line, std::vector<Part>> lines_;
  std::set<Edge> inner_;
  std::map<NodeId, std::set<std::size_t>> across_;
  std::map<Edge, std::set<NodeId>> lying_;
};

}  // namespace plica
