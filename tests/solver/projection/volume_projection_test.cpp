#include "solver/projection/volume_projection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "support/models.hpp"

namespace plica {
namespace {

using namespace support;

constexpr double duration_s = 2;

/// At rest but for the nodes, which lie elsewhere.
State moved_to(const Model& model, Vectors positions) {
  State state = rest_state(model);
  state.positions = std::move(positions);
  return state;
}

Vectors shaken(const Model& model, double size_um, unsigned seed) {
  Random random(seed);
  Vectors positions = model.tissue.rest_positions;
  for (Vec3& x : positions) x += random.vector(size_um);
  return positions;
}

StepReport project(const Model& model, const ProjectionRule& rule, State& state) {
  const State before = rest_state(model);
  StepReport report;
  VolumeProjection(model, rule).apply(before, duration_s, {}, state, report);
  return report;
}

double worst_error(const Model& model, const Vectors& positions) {
  double worst = 0;
  for (const double error : model.volumes.relative_errors(positions)) worst = std::max(worst, std::abs(error));
  return worst;
}

/// What a projection moved, times the nodes' drag where that is asked for.
Vectors displacements(const Model& model, const Vectors& before, const State& after, bool times_drag) {
  Vectors moved(before.size()), weight(before.size(), Vec3::Ones());
  if (times_drag) {
    std::fill(weight.begin(), weight.end(), Vec3::Zero());
    const Step step{before, before, before, 1, 0};
    SurfaceDrag(model.tissue, usual_drag).add_tangent_product(step, Vectors(before.size(), Vec3::Ones()), weight);
  }
  for (std::size_t n = 0; n < before.size(); ++n) moved[n] = weight[n].cwiseProduct(after.positions[n] - before[n]);
  return moved;
}

Vec3 sum_of(const Vectors& vectors) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& v : vectors) sum += v;
  return sum;
}

Model single_cube() {
  Model model(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 20, .cells = {1, 1, 1}}));
  add_drag(model);
  return model;
}

// A cube blown up by 3 % comes back as a cube, by l = ((V0/V)^(1/3) - 1)/a, a = s/2.
TEST(VolumeProjection, BlownUpCubeIsScaledBackInOneMove) {
  const Model model = single_cube();
  Vectors positions = model.tissue.rest_positions;
  for (Vec3& x : positions) x *= 1.01;
  State state = moved_to(model, positions);
  const StepReport report = project(model, {}, state);
  ASSERT_TRUE(report.converged());
  EXPECT_EQ(report.cubics, 1);
  EXPECT_EQ(report.cubics_with_three_roots, 0);
  EXPECT_EQ(report.projection_sweeps, 2);  // the second finds nothing to do
  const Vec3 shift = sum_of(displacements(model, model.tissue.rest_positions, state, false)) / 8;
  EXPECT_LE(shift.norm(), 1e-12);
  for (std::size_t n = 0; n < 8; ++n) EXPECT_LE((state.positions[n] - model.tissue.rest_positions[n]).norm(), 1e-7);
  // Its pressure: l over the step, with the mean of the nodes' mobility.
  const double l = (1 / 1.01 - 1) / 10.1, mean_drag = usual_drag * 2 * 400 / 8;
  EXPECT_NEAR(state.multipliers[0], l * mean_drag / duration_s, 1e-9 * std::abs(state.multipliers[0]));
}

// X + l dV/dX moves no cell as a whole and turns none: the gradient has neither resultant nor moment.
TEST(VolumeProjection, EqualWeightsKeepCentreAndMomentOfAFreeBody) {
  const Model model = single_cube();
  const Vectors before = shaken(model, 2, 1);
  State state = moved_to(model, before);
  ASSERT_TRUE(project(model, {}, state).converged());
  const Vectors moved = displacements(model, before, state, false);
  EXPECT_GT(largest(moved), 0.01);
  EXPECT_LE(sum_of(moved).norm(), 1e-12);
  Vec3 moment = Vec3::Zero();
  for (std::size_t n = 0; n < moved.size(); ++n) moment += before[n].cross(moved[n]);
  EXPECT_LE(moment.norm(), 1e-11);
}

// By mobility it is the drag-weighted sum that stays, which is what forces without resultant leave alone.
TEST(VolumeProjection, WeightsDecideWhichSumOfASheetStays) {
  const Model model = dimpling_sheet();
  const Vectors before = shaken(model, 2, 2);
  int cases = 0;
  for (const auto weights : {ProjectionRule::Weights::equal, ProjectionRule::Weights::mobility}) {
    State state = moved_to(model, before);
    const StepReport report = project(model, {.weights = weights}, state);
    ASSERT_TRUE(report.converged()) << report.reason();
    EXPECT_LE(worst_error(model, state.positions), 1e-9);
    const bool mobility = weights == ProjectionRule::Weights::mobility;
    const Vectors plain = displacements(model, before, state, false),
                  dragged = displacements(model, before, state, true);
    EXPECT_LE(sum_of(mobility ? dragged : plain).norm(), 1e-10 * largest(mobility ? dragged : plain));
    EXPECT_GT(sum_of(mobility ? plain : dragged).norm(), 1e-3 * largest(mobility ? plain : dragged));
    ++cases;
  }
  EXPECT_EQ(cases, 2);
}

TEST(VolumeProjection, HeldDirectionsStay) {
  Model model = dimpling_sheet();
  for (std::size_t n = 0; n < model.held.size(); n += 3) model.held[n] = {true, false, n % 2 == 0};
  const Vectors before = shaken(model, 1, 3);
  State state = moved_to(model, before);
  ASSERT_TRUE(project(model, {}, state).converged());
  EXPECT_LE(worst_error(model, state.positions), 1e-9);
  for (std::size_t n = 0; n < before.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (model.held[n][axis]) {
        EXPECT_EQ(state.positions[n][axis], before[n][axis]);
      }
}

TEST(VolumeProjection, ACellThatCannotMoveIsNamed) {
  Model model = dimpling_sheet();
  const auto& element = model.tissue.elements[5];
  for (const NodeId node : element) model.held[node.index()] = {true, true, true};
  Vectors positions = model.tissue.rest_positions;
  positions[element[6].index()].z() += 1;
  State state = moved_to(model, positions);
  const StepReport report = project(model, {.most_sweeps = 20}, state);
  EXPECT_EQ(report.status, StepReport::Status::not_projected);
  ASSERT_TRUE(report.cell);
  EXPECT_EQ(report.cell->index(), 5u);
  EXPECT_EQ(report.projection_sweeps, 20);
  EXPECT_NE(report.reason().find("cell 5"), std::string::npos) << report.reason();
}

// One volume around all: its cells may differ, their sum may not.
TEST(VolumeProjection, WholeSurfaces) {
  const Model model = furrowing_sphere();
  Vectors swollen = shaken(model, 0.5, 4);
  for (Vec3& x : swollen) x *= 0.98;
  State state = moved_to(model, swollen);
  StepReport report = project(model, {.surfaces = ProjectionRule::Surfaces::tissue}, state);
  ASSERT_TRUE(report.converged()) << report.reason();
  double volume = 0, target = 0;
  const std::vector<double> volumes = model.volumes.volumes(state.positions);
  for (std::size_t c = 0; c < volumes.size(); ++c) volume += volumes[c], target += model.volumes.targets()[c];
  EXPECT_NEAR(volume / target, 1, 1e-9);
  EXPECT_GT(worst_error(model, state.positions), 1e-3);

  // The apical surface fills its shell at rest: inside the shell its volume cannot be kept once it has folded in.
  state = moved_to(model, swollen);
  state.positions[0] *= 0.9;
  report = project(model, {.surfaces = ProjectionRule::Surfaces::embryo, .most_sweeps = 200}, state);
  EXPECT_EQ(report.status, StepReport::Status::not_projected);
  EXPECT_FALSE(report.cell);
  EXPECT_FALSE(report.reason().empty());
}

// The end is the nearest place that obeys shell and volumes, so a start on another way comes to the same one, but for
// second order in what is moved: the gradients are those of the places passed.
TEST(VolumeProjection, ShellAndVolumesAreMetTogetherFromAnyStart) {
  const Model model = furrowing_sphere();
  double previous = 0;
  int cases = 0;
  for (const double size : {0.4, 0.2, 0.1}) {
    const Vectors moved = shaken(model, size, 5);
    State cold = moved_to(model, moved), warm = moved_to(model, moved);
    ASSERT_TRUE(project(model, {}, cold).converged());
    State before = rest_state(model);
    for (std::size_t c = 0; c < before.multipliers.size(); ++c) before.multipliers[c] = 1.3 * cold.multipliers[c];
    for (double& force : before.contact_forces) force = 2 * size;
    StepReport report;
    VolumeProjection(model, ProjectionRule{}).apply(before, duration_s, {}, warm, report);
    ASSERT_TRUE(report.converged()) << report.reason();
    double apart = 0;
    for (std::size_t n = 0; n < moved.size(); ++n)
      apart = std::max(apart, (warm.positions[n] - cold.positions[n]).norm());
    for (const State* state : {&cold, &warm}) {
      EXPECT_LE(worst_error(model, state->positions), 1e-9);
      for (std::size_t k = 0; k < state->contact_forces.size(); ++k) {
        const double gap = Contacts(model).gap(k, state->positions).value;
        EXPECT_GE(gap, -1e-7);
        EXPECT_GE(state->contact_forces[k], 0);
        if (state->contact_forces[k] > 0) {
          EXPECT_LE(gap, 1e-7) << "a force at a distance";
        }
      }
    }
    std::printf("moved by up to %.1f um: two starts end %.1e um apart\n", size, apart);
    if (previous > 0) {
      EXPECT_LE(apart, 0.4 * previous);
    }
    previous = apart;
    ++cases;
  }
  EXPECT_EQ(cases, 3);
  EXPECT_LE(previous, 1e-3);
}

}  // namespace
}  // namespace plica
