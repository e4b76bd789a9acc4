// Divisions in the loop: who divides when, and what a run with divisions keeps at every step.
#include <gtest/gtest.h>

#include <cmath>

#include "simulation/simulation.hpp"
#include "support/divided.hpp"
#include "support/ran.hpp"

namespace plica {
namespace {

using namespace support;

Model row_of_cells(int cells) {
  Model model(build_block({.length_um = 20.0 * cells, .width_um = 20, .cell_height_um = 40, .cells = {cells, 1, 1}}));
  add_elasticity(model);
  add_drag(model);
  return model;
}

DivisionRule at(double time_s, const std::string& region, double growth_s, DivisionPlane plane) {
  DivisionRule rule;
  rule.region = region;
  rule.threshold = time_s;
  rule.plane = plane;
  rule.growth_s = growth_s;
  rule.max_generation = 100;
  return rule;
}

RunControls controls_of(std::vector<DivisionRule> rules) {
  RunControls controls;
  controls.end_s = 20000;
  controls.max_step_s = 200;
  controls.equilibrium_speed_um_per_s = 1e-7;
  for (const DivisionRule& rule : rules)
    if (rule.trigger == DivisionTrigger::time) controls.program_points_s.push_back(rule.threshold);
  controls.divisions = std::move(rules);
  return controls;
}

// What holds at every step of a run with divisions.
struct Kept {
  double volume_error = 0;  // of cells against their targets
  double gap = 0;           // sum of cells over the volume inside the boundary, less 1
  int steps = 0;

  StepWatcher watcher() {
    return [&](const AcceptedStep& step, const Model& model) {
      for (const double error : model.volumes.relative_errors(step.state.positions))
        volume_error = std::max(volume_error, std::abs(error));
      const double inside = volume_inside_boundary(model.tissue, step.state.positions);
      gap = std::max(gap, std::abs(volume_of_cells(model.tissue, step.state.positions) / inside - 1));
      ++steps;
    };
  }
};

// Lengths of the twelve edges of a cell, in order.
std::vector<double> edge_lengths(const Cell& cell, const Vectors& positions) {
  std::vector<double> lengths;
  for (const auto& [a, b] : hex_edges)
    lengths.push_back((positions[cell.corners[b].index()] - positions[cell.corners[a].index()]).norm());
  return lengths;
}

TEST(DivisionRun, FreeDaughtersEndWithTheirMothersShapeAndVolume) {
  for (const DivisionPlane plane : {DivisionPlane::transverse, DivisionPlane::sagittal}) {
    Model model = row_of_cells(3);
    model.tissue.regions["middle"] = {false, true, false};
    Kept kept;
    const auto mother = edge_lengths(model.tissue.cells[1], model.tissue.rest_positions);
    const Simulation result = ran(std::move(model), controls_of({at(60, "middle", 300, plane)}), kept.watcher());
    EXPECT_EQ(result.status(), RunStatus::equilibrium);
    const Tissue& tissue = result.model().tissue;
    ASSERT_EQ(tissue.cells.size(), 4u);
    EXPECT_EQ(result.divisions(), 1);
    EXPECT_LE(kept.volume_error, 1e-9);
    EXPECT_LE(kept.gap, 1e-12);
    double shape = 0;
    for (const int daughter : {1, 3}) {
      const Cell& cell = tissue.cells[daughter];
      EXPECT_NEAR(cell_volume(tissue, cell, result.state().positions) / 16000, 1, 1e-9);
      const auto lengths = edge_lengths(cell, result.state().positions);
      for (int e = 0; e < 12; ++e) shape = std::max(shape, std::abs(lengths[e] / mother[e] - 1));
    }
    // Along the row the ends are free; side by side the two are held together by neighbours that stay narrow.
    if (plane == DivisionPlane::transverse) {
      EXPECT_LE(shape, 0.01);
    }
    std::cout << kept.steps << " steps: volumes to " << kept.volume_error << ", gap " << kept.gap
              << ", daughters' edges off by " << shape << "\n";
  }
}

TEST(DivisionRun, FourParallelSlicesOfOneCellGrowOneAfterTheOther) {
  Model model = row_of_cells(1);
  Kept kept;
  const Simulation result =
      ran(std::move(model),
          controls_of({at(10, "all", 300, DivisionPlane::transverse), at(100, "all", 200, DivisionPlane::transverse)}),
          kept.watcher());
  EXPECT_EQ(result.status(), RunStatus::equilibrium);
  EXPECT_EQ(result.divisions(), 3);
  ASSERT_EQ(result.model().tissue.cells.size(), 4u);
  EXPECT_LE(kept.volume_error, 1e-9);
  EXPECT_LE(kept.gap, 1e-12);
  double extent = 0;
  for (const Vec3& x : result.state().positions) extent = std::max(extent, std::abs(x.x()));
  EXPECT_NEAR(extent, 40, 0.4);  // four cells of 20 um in a row
  std::cout << kept.steps << " steps: volumes to " << kept.volume_error << ", gap " << kept.gap << "\n";
}

TEST(DivisionRun, ByThresholdEndsWithTheLastGenerationAllowed) {
  for (const auto& [trigger, threshold] :
       {std::pair{DivisionTrigger::volume, 15000.0}, {DivisionTrigger::apical_area, 390.0}}) {
    Model model = row_of_cells(2);
    DivisionRule rule = at(threshold, "all", 100, DivisionPlane::transverse);
    rule.trigger = trigger;
    rule.max_generation = 2;
    Kept kept;
    const Simulation result = ran(std::move(model), controls_of({rule}), kept.watcher());
    EXPECT_EQ(result.model().tissue.cells.size(), 8u);
    EXPECT_EQ(result.divisions(), 6);
    EXPECT_EQ(result.status(), RunStatus::equilibrium);
    for (const Cell& cell : result.model().tissue.cells) EXPECT_EQ(cell.lineage.generation, 2);
    EXPECT_LE(kept.volume_error, 1e-9);
  }
}

TEST(DivisionRun, ByElongationCutsTheLongerSide) {
  Model model(build_block({.length_um = 60, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}}));
  add_elasticity(model);
  add_drag(model);
  DivisionRule rule = at(2, "all", 10, DivisionPlane::longest_axis);
  rule.trigger = DivisionTrigger::elongation;
  rule.volume_ratio = 0.5;
  const Simulation result = ran(std::move(model), controls_of({rule}));
  const Tissue& tissue = result.model().tissue;
  ASSERT_EQ(tissue.cells.size(), 2u);  // 30 by 20: not elongated enough to go on
  EXPECT_NEAR(cell_centre(tissue.cells[0], tissue.rest_positions).x(), -15, 1e-9);
}

// 3 steps of 0.7 s are 4e-16 s short of 2.1 s.
TEST(DivisionRun, ATimeHasComeWhateverRoundingSays) {
  const Model model = row_of_cells(1);
  const std::vector<DivisionRule> rules = {at(2.1, "all", 10, DivisionPlane::transverse)};
  State state = rest_state(model);
  state.time_s = 0.7 + 0.7;
  EXPECT_TRUE(due_divisions(model, state, rules).empty());
  state.time_s = 3 * 0.7;
  ASSERT_LT(state.time_s, 2.1);
  EXPECT_EQ(due_divisions(model, state, rules).size(), 1u);
  state.divided_until_s = state.time_s;
  state.time_s = 4 * 0.7;
  EXPECT_TRUE(due_divisions(model, state, rules).empty());
}

TEST(DivisionRun, EquilibriumCountsAfterTheLastDivision) {
  Model model = row_of_cells(1);
  RunControls controls = controls_of({at(500, "all", 100, DivisionPlane::transverse)});
  controls.program_points_s.clear();  // as of a threshold: nobody knows of it beforehand
  controls.stop_at_equilibrium = false;
  controls.end_s = 3000;
  std::optional<double> first_at_rest_s;
  const Simulation result = ran(std::move(model), controls, [&](const AcceptedStep& step, const Model&) {
    if (step.at_equilibrium && !first_at_rest_s) first_at_rest_s = step.state.time_s;
  });
  EXPECT_EQ(result.divisions(), 1);
  EXPECT_LT(first_at_rest_s.value(), 500);
  EXPECT_GT(result.equilibrium_time_s().value(), 600);
}

TEST(DivisionRun, GivesTheSameBitsAgain) {
  const auto once = [] {
    Model model = row_of_cells(3);
    const Simulation result = ran(std::move(model), controls_of({at(60, "all", 100, DivisionPlane::transverse)}));
    return result.state().positions;
  };
  EXPECT_EQ(once(), once());
}

}  // namespace
}  // namespace plica
