// Incompressibility of the paper (2.5): after the force step, X <- X + l W dV/dX with the real root l nearest zero of
// the cubic V(X + l W dV/dX) = V0, one closed surface after another, alternating obstacles and volumes, until all hold.
// Theory: docs/theory/paper_algorithm.md.
#pragma once

#include <functional>

#include "solver/projection/closed_surface.hpp"
#include "solver/step/stepper.hpp"

namespace plica {

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
  /// stay. Adds the multipliers over the step to those of the volumes and contact forces of `after`, which contain the
  /// part of the force step; with equal weights, as if every node had the mean mobility. Sweeps start from the values
  /// in `before`. The report receives the counts and a status: converged, not_projected (with the worst cell), or
  /// interrupted.
  void apply(const State& before, double duration_s, const std::function<bool()>& stop_requested, State& after,
             StepReport& report);

 private:
  struct Kept {
    ClosedSurface surface;
    double target;
    std::optional<CellId> cell;
  };

  void set_weights(const State& before, double duration_s);
  [[nodiscard]] double contact_weight(std::size_t k, double duration_s) const;  // um/nN
  void repeat_last_step(const State& before, double duration_s, State& after);
  void push(std::size_t k, double distance_um, Vectors& positions);
  bool project_obstacles(Vectors& positions);
  bool project(std::size_t k, Vectors& positions, StepReport& report);
  double look_at(const Kept& kept, const Vectors& positions);
  void move(std::size_t k, double l, Vectors& positions);
  void judge(const Vectors& positions, StepReport& report) const;

  const Model& model_;
  Contacts contacts_;
  ProjectionRule rule_;
  std::vector<Kept> kept_;
  std::vector<double> weights_;                      // nodes; um/(nN s)
  std::vector<double> moved_;                        // kept surfaces; sum of l, kPa s
  std::vector<double> pushed_;                       // contacts; inward displacement of their nodes, um
  Vectors points_, gradient_, direction_, scratch_;  // nodes of one surface
};

}  // namespace plica
