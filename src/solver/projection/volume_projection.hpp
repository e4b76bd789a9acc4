// The paper's incompressibility (2.5): after the force step, X <- X + l W dV/dX with the real root l nearest zero of
// the cubic V(X + l W dV/dX) = V0, a closed surface after another, obstacles and volumes in turn, until all hold.
// Theory: docs/theory/paper_algorithm.md.
#pragma once

#include <functional>

#include "solver/projection/closed_surface.hpp"
#include "solver/step/stepper.hpp"

namespace plica {

/// How volumes are projected after the force step.
struct ProjectionRule {
  /// Closed surfaces whose volumes are kept: each cell's; that around all cells together; the apical surface, with
  /// the lumen inside.
  enum class Surfaces { cells, tissue, embryo } surfaces = Surfaces::cells;
  /// How far nodes go along the gradient: all alike, or each as far as its drag and mass let it.
  enum class Weights { equal, mobility } weights = Weights::equal;
  double tolerance = 1e-9;  // |V/target - 1|, every surface
  double gap_um = 1e-7;     // depth of a node outside the shell
  int most_sweeps = 1000;
};

class VolumeProjection {
 public:
  /// Without a rule only obstacles are kept.
  VolumeProjection(const Model& model, const std::optional<ProjectionRule>& rule);

  /// Moves `after`, where a force step has led from `before`, onto volumes and obstacles; held directions of nodes
  /// stay. Multipliers over the step's length are added to the multipliers of the volumes and contact forces of
  /// `after`, which come with the force step's own part; where weights are equal, as if every node had the mean
  /// mobility. The sweeps start from what of this `before` has. What was done goes into the report; the outcome is
  /// converged, not_projected (with the cell that is off most), or interrupted.
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
  std::vector<double> pushed_;                       // contacts; how far their nodes have been pushed in, um
  Vectors points_, gradient_, direction_, scratch_;  // of one surface's nodes
};

}  // namespace plica
