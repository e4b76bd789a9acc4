// Contact of a surface with itself: points against facets, and edges against edges (docs/theory/self_contact.md).
//
// A facet is four triangles, from its edges to the mean of its corners; points are nodes, middles of edges and these
// means. At the beginning of a step each point takes the nearest facing triangle outside its own neighbourhood, and
// the nearest one of another part of the surface, if that is as near as 4 distances. The
// nearest place q on it, as weights of its facet's nodes, and the way N from there to the point stay fixed for the
// step; where the point p comes closer than `distance` along N it is pushed back:
//   E = k w/2 (distance - N.(p - q))^2,   w the area that the point stands for.
// Edges that cross between points are pairs in the same way (edge_pairs.hpp), from half the distance on.
// So within a step the law is linear in its forces, and gaps have a sign: a point beyond the surface is pushed out
// again. A point that faces the other side of a thin ridge lies beyond that, too: only one that touched in the step
// before may lie beyond. Friction is Coulomb's, by the pressure at the step's beginning.
//
// Where mirror planes leave one side of a tissue to be solved, its points take triangles of the whole, images too, and
// push the nodes that these are images of: half of the whole's energy, as the whole would have it.
#pragma once

#include <array>
#include <vector>

#include "mechanics/contact/contact_pair.hpp"
#include "mechanics/contact/edge_pairs.hpp"
#include "mechanics/law.hpp"
#include "tissue/mirror.hpp"
#include "tissue/tissue.hpp"

namespace plica {

struct SelfContactRule {
  CellSide side = CellSide::apical;
  double distance = 0.4;   // um
  double stiffness = 1;    // k, nN/um^3 (kPa/um)
  double search = 6;       // um: how near a facet must be at the step's beginning
  double friction = 0;     // the coefficient
  bool with_edges = true;  // without pairs of edges: for comparison
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

  using Pair = ContactPair;
  /// A node, the middle of an edge or that of a facet.
  struct Point {
    SurfacePlace place;
    double area = 0;  // um^2, at rest
  };
  /// In the order of points, then those of edges in theirs. `known`: the internal state of the step that ends at these
  /// positions.
  [[nodiscard]] std::vector<Pair> pairs(std::span<const Vec3> positions, std::span<const double> known = {}) const;
  /// The pairs of an internal state.
  [[nodiscard]] static std::vector<Pair> pairs_of(std::span<const double> internal);
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] CellSide side() const { return rule_.side; }

 private:
  struct Surface;
  /// Of a point: with the nearest triangle that faces it; after a `first` pair, with the nearest one of another part of
  /// the surface. `known`: the point's pairs of the step before.
  [[nodiscard]] std::optional<Pair> pair_of(std::size_t point, std::span<const Pair> known, const Surface& surface,
                                            const Pair* first) const;
  [[nodiscard]] bool is_nearest_about(const SurfacePlace& q, const Vec3& place, const Surface& surface) const;
  [[nodiscard]] double reach_of_second() const { return 4 * rule_.distance; }
  [[nodiscard]] bool may_touch(const Pair& pair) const { return pair.first_gap < 2 * rule_.distance; }
  /// Adds the nodes of each pair that may touch.
  void add_touching(std::span<const double> internal, NodeGroups& groups) const;
  void add_group(std::span<const NodeId> of_whole, NodeGroups& groups) const;
  /// Adds a push to the nodes of p, and its opposite to those of q.
  void add_push(const Pair& pair, const Vec3& push, std::span<Vec3> forces) const;
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
  // Of points, sorted: facets that share a node with theirs, or on whose edge a node of theirs hangs.
  std::vector<std::vector<std::size_t>> neighbours_;
  EdgePairs edges_;
};

}  // namespace plica
