// Incompressibility of the paper (2.5): after the force step, X <- X + l W dV/dX with the real root l nearest zero of
// the cubic V(X + l W dV/dX) = V0, one closed surface after another, alternating obstacles and volumes, until all hold.
// Theory: docs/developers/paper-algorithm.md.
#pragma once

#include <functional>

#include "solver/step/stepper.hpp"

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

/// Closed surface of bilinear facets and its enclosed volume, which the projection conserves.
///
/// The volume is the sum of the hex_volume term over the facets, a homogeneous cubic polynomial of the points. So with
/// g(x) its gradient, V(x) = x.g(x)/3, and along a direction d
///   V(x + l d) = V(x) + l g(x).d + l^2 x.g(d) + l^3 d.g(d)/3    exactly.
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

/// Parameters of the projection.
struct ProjectionRule {
  /// Surfaces with conserved volume: each cell; the surface of all cells together; the apical surface, including the
  /// lumen.
  enum class Surfaces { cells, tissue, embryo } surfaces = Surfaces::cells;
  /// Step lengths along the gradient: equal, or by the mobility of each node (drag and mass).
  enum class Weights { equal, mobility } weights = Weights::equal;
  double tolerance = 1e-9;  // |V/target - 1|, every surface
  double gap_um = 1e-7;     // distance of a node outside the shell
  int most_sweeps = 1000;
};

class VolumeProjection {
 public:
  /// Make the projection; without a rule only obstacles are enforced.
  VolumeProjection(const Model& model, const std::optional<ProjectionRule>& rule);

  /// Project `after`, the result of a force step from `before`, onto volumes and obstacles; held directions of nodes
  /// stay. Adds the multipliers over the step to those of the volumes and obstacle forces of `after`, which contain the
  /// part of the force step; with equal weights, as if every node had the mean mobility. Sweeps start from the values
  /// in `before`. The report receives the counts and a status: converged, not_projected (with the worst cell), or
  /// interrupted.
  void apply(const State& before, double duration_s, const std::function<bool()>& stop_requested, State& after,
             StepReport& report);

 private:
  struct ProjectedVolume {
    ClosedSurface surface;
    double target;
    std::optional<CellId> cell;
  };

  void set_weights(const State& before, double duration_s);
  [[nodiscard]] double obstacle_weight(std::size_t k, double duration_s) const;  // um/nN
  void repeat_last_step(const State& before, double duration_s, State& after);
  void push(std::size_t k, double distance_um, Vectors& positions);
  bool project_obstacles(Vectors& positions);
  bool project(std::size_t k, Vectors& positions, StepReport& report);
  double volume_excess(const ProjectedVolume& volume, const Vectors& positions);
  void move(std::size_t k, double l, Vectors& positions);
  void judge(const Vectors& positions, StepReport& report) const;

  const Model& model_;
  ObstacleContacts contacts_;
  ProjectionRule rule_;
  std::vector<ProjectedVolume> volumes_;
  std::vector<double> weights_;                      // nodes; um/(nN s)
  std::vector<double> moved_;                        // kept surfaces; sum of l, kPa s
  std::vector<double> pushed_;                       // contacts; inward displacement of their nodes, um
  Vectors points_, gradient_, direction_, scratch_;  // nodes of one surface
};

}  // namespace plica
