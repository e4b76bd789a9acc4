// Self-contact of a surface: points against facets, and edges against edges (docs/theory/self_contact.md).
//
// A facet consists of four triangles, from its edges to the mean of its corners; points are nodes, edge midpoints and
// these means. At the beginning of a step each point takes the nearest facing triangle outside its neighbourhood, and
// the nearest one of another part of the surface if that is within 4 distances. The closest point q on it (as weights
// of the nodes of its facet) and the direction N from there to the point stay fixed for the step; if the point p is
// closer than `distance` along N it is repelled:
//   E = k w/2 (distance - N.(p - q))^2,   w the area of the point.
// Crossing edges form pairs in the same way (edge_pairs.hpp), from half the distance on. Within a step forces are thus
// linear and gaps have a sign: a point beyond the surface is pushed out again. A point facing the other side of a thin
// ridge is beyond that side too; only a point that touched in the previous step may be beyond. Friction is Coulomb's,
// with the pressure at the beginning of the step.
//
// If mirror planes leave one side of a tissue to solve, its points meet triangles of the full tissue, including images,
// and push the nodes that these are images of: half of the energy of the full tissue.
#pragma once

#include <array>
#include <vector>

#include "core/box_grid.hpp"
#include "mechanics/contact/contact_pair.hpp"
#include "mechanics/contact/edge_pairs.hpp"
#include "mechanics/coulomb.hpp"
#include "mechanics/derivatives.hpp"
#include "mechanics/internal_change.hpp"
#include "mechanics/law.hpp"
#include "tissue/mirror.hpp"
#include "tissue/tissue.hpp"

namespace plica {

struct SelfContactRule {
  CellSide side = CellSide::apical;
  double distance = 0.4;   // um
  double stiffness = 1;    // k, nN/um^3 (kPa/um)
  double search = 6;       // um: search radius at the beginning of the step
  double friction = 0;     // friction coefficient
  bool with_edges = true;  // false: no edge pairs, for comparison
};

/// Self-contact law. The pairs of a step are its internal state, detected again when a step is accepted. Pairs that may
/// touch join their nodes, so the sparsity pattern changes from step to step.
class SelfContact final : public Law, public LawDerivatives, public InternalChange {
 public:
  /// Make the law for a tissue, or for one side of it. Points, facets and pairs number nodes as in the full tissue;
  /// positions, forces and blocks are those of the side.
  SelfContact(const Tissue& whole, const SelfContactRule& rule, Mirror mirror = {});

  [[nodiscard]] std::string_view name() const override { return "self-contact"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<SelfContact>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const CompletedStep& completed) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] double rounding(const Step& step, double position_rounding) const override;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override;
  [[nodiscard]] int groups_revision(std::span<const double> internal) const override {
    return internal.empty() ? 0 : static_cast<int>(internal.front());
  }
  [[nodiscard]] std::vector<double> first_internal(const Tissue& tissue) const override {
    return packed(pairs(tissue.rest_positions), {});
  }
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override {
    return packed(pairs(step.positions, step.internal), step.internal);
  }
  /// Return the pairs and their images, as read by measures: `first` and `second` are those of the side.
  [[nodiscard]] std::optional<std::vector<double>> internal_of_whole(std::span<const double> of_side) const override;
  [[nodiscard]] bool accepts(std::span<const double> internal, const Tissue& /*tissue*/) const override {
    return internal.empty() || internal.size() % numbers_of_pair == 1;
  }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> positions) const override;
  /// Return pairs found again. A point may be as far beyond the surface as the nearest point that touched before. For a
  /// part of the tissue there are none, since contact belongs to no part.
  [[nodiscard]] std::vector<double> internal_after_change(std::span<const double> internal, const Tissue& tissue,
                                                          const TissueChange& change,
                                                          const ChangePositions& positions) const override;

  /// Pairs keep their features.
  [[nodiscard]] const LawDerivatives& derivatives() const override { return *this; }
  void add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                          const BeginningGradient& gradient) const override;
  void add_internal_gradient(const Step& step, std::span<const double> next, std::span<const double> adjoint,
                             std::span<Vec3> positions, const BeginningGradient& gradient) const override;
  void add_internal_change(const Step& step, std::span<const double> next, const StepChange& change,
                           std::span<double> of_next) const override;
  [[nodiscard]] std::vector<double> next_internal_like(const Law& /*law*/, const Step& /*step*/,
                                                       std::span<const double> /*next*/) const override {
    return {};
  }

  using Pair = ContactPair;
  /// Contact point: a node, an edge midpoint or a facet mean.
  struct Point {
    SurfacePlace place;
    double area = 0;  // um^2, at rest
  };
  /// Find pairs in the order of points, then of edges. `known`: internal state of the step that ends at these
  /// positions.
  [[nodiscard]] std::vector<Pair> pairs(std::span<const Vec3> positions, std::span<const double> known = {}) const;
  /// Return the pairs of an internal state, a view of it.
  [[nodiscard]] static std::span<const Pair> pairs_of(std::span<const double> internal);
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] CellSide side() const { return rule_.side; }
  [[nodiscard]] const SelfContact* self_contact() const override { return this; }

 private:
  struct Surface;
  /// Boxes of facets, widened by the search and a margin: they serve until a node has moved by more than the margin.
  struct KeptGrid {
    Vectors positions;  // full tissue, when it was made
    BoxGrid facets;
  };
  [[nodiscard]] double margin() const { return 0.25 * rule_.search; }
  /// Return a grid whose facets near a place are at least those within the search of it.
  [[nodiscard]] const BoxGrid& grid_of(std::span<const Vec3> positions) const;
  /// Pair of the previous step, as it is now.
  struct Touch {
    Vec3 place;  // q
    double gap, distance;
  };
  [[nodiscard]] static std::vector<Touch> touches_of(std::span<const Pair> pairs, std::span<const Vec3> x);
  /// Find pairs, given those of edges in the previous step, and known_of(point, positions) for touches of points.
  template <class KnownOf>
  [[nodiscard]] std::vector<Pair> pairs(std::span<const Vec3> positions, std::span<const Pair> before,
                                        const KnownOf& known_of) const;
  [[nodiscard]] std::vector<Pair> pairs_at(std::size_t p, std::span<const Touch> known, const Surface& surface) const;
  /// Find the pair of a point with the nearest facing triangle; after a `first` pair, with the nearest one of another
  /// part of the surface. `known`: those of the point in the previous step.
  [[nodiscard]] std::optional<Pair> pair_of(std::size_t point, std::span<const Touch> known, const Surface& surface,
                                            const Pair* first) const;
  [[nodiscard]] bool is_nearest_about(const SurfacePlace& q, const Vec3& place, const Surface& surface) const;
  [[nodiscard]] double reach_of_second() const { return 4 * rule_.distance; }
  [[nodiscard]] bool may_touch(const Pair& pair) const { return pair.first_gap < 2 * rule_.distance; }
  /// Add the nodes of each pair that may touch.
  void add_touching(std::span<const double> internal, NodeGroups& groups) const;
  void add_group(std::span<const KeptNode> of_whole, NodeGroups& groups) const;
  /// Add a push to the nodes of p, and its opposite to those of q.
  void add_push(const Pair& pair, const Vec3& push, std::span<Vec3> forces) const;
  [[nodiscard]] std::vector<double> packed(const std::vector<Pair>& pairs, std::span<const double> before) const;
  /// Call take(pair, penetration of its contact distance) for every pair under pressure.
  template <class Take>
  void for_pressed(const Step& step, const Take& take) const {
    for (const Pair& pair : pairs_of(step.internal)) {
      const double inside = pair.distance - pair.gap(MirroredVectors{mirror_, step.positions});
      if (inside > 0) take(pair, inside);
    }
  }
  /// Call take(pair, friction, velocity of p along q) for every pair under pressure at the beginning of the step.
  template <class Take>
  void for_rubbing(const Step& step, const Take& take) const {
    if (rule_.friction == 0) return;
    for (const Pair& pair : pairs_of(step.internal)) {
      const double inside = pair.distance - pair.first_gap;
      if (inside <= 0) continue;
      const auto apart = [&](std::span<const Vec3> x) { return pair.apart(MirroredVectors{mirror_, x}); };
      take(pair, Coulomb{rule_.friction * rule_.stiffness * pair.area * inside},
           pair.along(apart(step.positions) - step.before(apart)) / step.rate_s);
    }
  }

  SelfContactRule rule_;
  Mirror mirror_;
  std::vector<std::array<NodeId, 4>> facets_;  // full tissue
  struct RimEdge {
    NodeId from, to;
    std::size_t facet;
  };
  std::vector<RimEdge> rim_;  // edges of a single facet, counter-clockwise
  // Side only: nodes of the surface, then means of its facets and edges.
  std::vector<Point> points_;
  // Per point, sorted: facets that share a node with its facets, or on whose edge one of their nodes hangs.
  std::vector<std::vector<std::size_t>> neighbours_;
  EdgePairs edges_;
  mutable KeptGrid grid_;  // pairs do not depend on when it was made
};

}  // namespace plica
