// Contact of a surface with itself: points against facets (docs/theory/self_contact.md).
//
// A facet is four triangles, from its edges to the mean of its corners; points are nodes, middles of edges and these
// means. At the beginning of a step each point takes the nearest facing triangle outside its own neighbourhood. The
// nearest place q on it, as weights of its facet's nodes, and the way N from there to the point stay fixed for the
// step; where the point p comes closer than `distance` along N it is pushed back:
//   E = k w/2 (distance - N.(p - q))^2,   w the area that the point stands for.
// So within a step the law is linear in its forces, and gaps have a sign: a point beyond the surface is pushed out
// again. A point that faces the other side of a thin ridge lies beyond that, too: only one that touched in the step
// before may lie beyond. Friction is Coulomb's, by the pressure at the step's beginning.
//
// Where mirror planes leave one side of a tissue to be solved, its points take triangles of the whole, images too, and
// push the nodes that these are images of: half of the whole's energy, as the whole would have it.
#pragma once

#include <array>
#include <vector>

#include "mechanics/law.hpp"
#include "tissue/mirror.hpp"
#include "tissue/tissue.hpp"

namespace plica {

struct SelfContactRule {
  CellSide side = CellSide::apical;
  double distance = 0.4;  // um
  double stiffness = 1;   // k, nN/um^3 (kPa/um)
  double search = 6;      // um: how near a facet must be at the step's beginning
  double friction = 0;    // the coefficient
};

/// The pairs of a step are its internal state, found again when a step is accepted. Those that may touch in it join
/// their nodes, so that the pattern changes from step to step.
class SelfContact final : public Law {
 public:
  /// Of a tissue, or of its one side. Points, facets and pairs know nodes as the whole numbers them; positions, forces
  /// and blocks are the side's.
  SelfContact(const Tissue& whole, const SelfContactRule& rule, Mirror mirror = {});

  [[nodiscard]] std::string_view name() const override { return "self-contact"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<SelfContact>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const MadeStep& made) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] double rounding(const Step& step, double position_rounding) const override;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override;
  [[nodiscard]] int pattern_revision(std::span<const double> internal) const override {
    return internal.empty() ? 0 : static_cast<int>(internal.front());
  }
  [[nodiscard]] std::vector<double> first_internal(const Tissue& tissue) const override;
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override;
  /// Without pairs until the next step is accepted: of a part of the tissue, too, since contact is not a part's own.
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;
  [[nodiscard]] std::vector<double> internal_after_division(std::span<const double>, const Tissue&,
                                                            const Division&) const override {
    return {};  // no pairs
  }

  /// A point of the surface: the mean of `count` nodes (a node itself, the ends of an edge, the corners of a facet).
  struct Point {
    std::array<NodeId, 4> nodes;
    int count = 1;
    double area = 0;  // um^2, at rest
    /// Of any vectors of the whole's nodes.
    template <class VectorsOfNodes>
    [[nodiscard]] Vec3 at(const VectorsOfNodes& vectors) const {
      Vec3 sum = Vec3::Zero();
      for (int i = 0; i < count; ++i) sum += vectors[nodes[i].index()];
      return sum / count;
    }
  };
  /// What a point is kept from.
  struct Pair {
    std::size_t point;
    std::array<NodeId, 4> nodes;    // of the facet
    std::array<double, 4> weights;  // of the place on it
    Vec3 normal;
    double distance = 0;   // um: where it begins to push. That of the rule; less where it was nearer when first seen
    double first_gap = 0;  // um: at the step's beginning
    /// p - q; of any vectors of the whole's nodes.
    template <class VectorsOfNodes>
    [[nodiscard]] Vec3 apart(const Point& p, const VectorsOfNodes& vectors) const {
      Vec3 difference = p.at(vectors);
      for (int k = 0; k < 4; ++k) difference -= weights[k] * vectors[nodes[k].index()];
      return difference;
    }
    /// N.(p - q)
    template <class VectorsOfNodes>
    [[nodiscard]] double gap(const Point& p, const VectorsOfNodes& vectors) const {
      return normal.dot(apart(p, vectors));
    }
    /// What of it lies in the plane across N.
    [[nodiscard]] Vec3 along(const Vec3& vector) const { return vector - normal.dot(vector) * normal; }
  };
  /// In the order of points. `known`: the internal state of the step that ends at these positions.
  [[nodiscard]] std::vector<Pair> pairs(std::span<const Vec3> positions, std::span<const double> known = {}) const;
  /// The pairs of an internal state.
  [[nodiscard]] static std::vector<Pair> pairs_of(std::span<const double> internal);
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] CellSide side() const { return rule_.side; }

 private:
  [[nodiscard]] bool may_touch(const Pair& pair) const { return pair.first_gap < 2 * rule_.distance; }
  /// Adds the nodes of each pair that may touch.
  void add_touching(std::span<const double> internal, NodeGroups& groups) const;
  void add_group(std::span<const NodeId> of_whole, NodeGroups& groups) const;
  /// All nodes of a pair, as the whole numbers them: of the point, of the facet.
  [[nodiscard]] std::vector<NodeId> nodes_of(const Pair& pair) const;
  /// Adds a push to the point's nodes, and its opposite to the facet's.
  void add_push(const Point& point, const Pair& pair, const Vec3& push, std::span<Vec3> forces) const;
  [[nodiscard]] std::vector<double> packed(const std::vector<Pair>& pairs, std::span<const double> before) const;
  template <class Take>
  void for_pressed(const Step& step, const Take& take) const;
  template <class Take>
  void for_rubbing(const Step& step, const Take& take) const;

  SelfContactRule rule_;
  Mirror mirror_;
  std::vector<std::array<NodeId, 4>> facets_;  // of the whole
  struct RimEdge {
    NodeId from, to;
    std::size_t facet;
  };
  std::vector<RimEdge> rim_;  // edges of one facet only, counter-clockwise about it
  // Of the side: nodes of the surface, then means of its facets and edges.
  std::vector<Point> points_;
  std::vector<std::vector<std::size_t>> neighbours_;  // points: facets that share a node with theirs, sorted
};

}  // namespace plica
