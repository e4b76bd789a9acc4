// Runs of sheets that repeat themselves: where a period ends does not show.
#include <gtest/gtest.h>

#include <cstdio>

#include "core/threads.hpp"
#include "mechanics/active/cortex.hpp"
#include "record/archive.hpp"
#include "record/checkpoint.hpp"
#include "scenario/load.hpp"
#include "support/models.hpp"
#include "support/ran.hpp"
#include "tissue/shapes/polygon_sheet.hpp"
#include "tissue/shapes/rectangle_polygons.hpp"

namespace plica {
namespace {

using namespace support;

constexpr double length = 40, width = 60;
const SheetShape sheet{length, width, {0, 0}, {true, true}};
const Rectangle rectangle{{length, width}, {true, true}};

// How far each cell has moved when a stripe along x has contracted for a while.
Vectors moves(const SheetShape& shape, const Vectors& points, LinearMethod method = LinearMethod::automatic) {
  Model model(build_sheet(shape, points, {10, PolygonSplit::diagonals, 1}));
  const Tissue& tissue = model.tissue;
  CellSet stripe(points.size());
  for (std::size_t c = 0; c < points.size(); ++c) stripe[c] = std::abs(points[c].y()) < 8;
  add_elasticity(model);
  add_contraction(model, stripe, {.stiffness = 3, .across_ratio = 0.4});
  model.laws.push_back(std::make_unique<Cortex>(tissue, CellSet(points.size(), true),
                                                CortexRule{.side = CellSide::lateral, .tension = 0.3}));
  add_drag(model);
  RunControls controls;
  controls.scheme.linear_method = method;
  controls.fixed_step_s = 2;
  controls.end_s = 20;
  controls.stop_at_equilibrium = false;
  const Simulation simulation = ran(std::move(model), controls);
  EXPECT_EQ(simulation.status(), RunStatus::end_time) << simulation.failure();
  Vectors result;
  const Tissue& after = simulation.model().tissue;
  for (const Cell& cell : after.cells)
    result.push_back(cell_centre(cell, simulation.state().positions) - cell_centre(cell, after.rest_positions));
  return result;
}

double furthest(const Vectors& moves) {
  double most = 0;
  for (const Vec3& move : moves) most = std::max(most, move.norm());
  return most;
}

double apart(std::span<const Vec3> one, std::span<const Vec3> other) {
  EXPECT_EQ(one.size(), other.size());
  double most = 0;
  for (std::size_t i = 0; i < one.size(); ++i) most = std::max(most, (one[i] - other[i]).norm());
  return most;
}

TEST(PeriodicRun, MayBeginAnywhere) {
  const Vectors points = even_points(rectangle, 70, 1);
  Vectors moved = points;
  for (Vec3& x : moved) x.x() += x.x() < 0 ? length / 2 : -length / 2;
  const Vectors one = moves(sheet, points), other = moves(sheet, moved);
  std::printf("cells move by up to %.3g um, and by %.1e um otherwise\n", furthest(one), apart(one, other));
  EXPECT_GT(furthest(one), 0.3);
  EXPECT_LT(apart(one, other), 1e-9);
}

// The middle of a longer sheet is the same, when that is endless, too.
TEST(PeriodicRun, TwoPeriodsDoWhatOneDoes) {
  const Vectors points = even_points(rectangle, 70, 1);
  Vectors twice;
  for (const double shift : {-length / 2, length / 2})
    for (const Vec3& x : points) twice.push_back(x + shift * Vec3::UnitX());
  const Vectors one = moves(sheet, points), both = moves({2 * length, width, {0, 0}, {true, true}}, twice);
  for (const std::size_t first : {std::size_t{0}, points.size()}) {
    const double difference = apart(one, std::span(both).subspan(first, points.size()));
    std::printf("%.1e um apart\n", difference);
    EXPECT_LT(difference, 1e-9);
  }
}

TEST(PeriodicRun, IsTheSameWithEveryLinearSolver) {
  const Vectors points = even_points(rectangle, 70, 1), expected = moves(sheet, points, LinearMethod::direct);
  for (const LinearMethod method : {LinearMethod::cholesky, LinearMethod::multigrid})
    EXPECT_LT(apart(expected, moves(sheet, points, method)), 1e-6);
}

// With contact and second order in time; so many cells that threads share loops.
TEST(PeriodicRun, GoesOnToTheSameBitsOnAnyNumberOfThreads) {
  const Scenario scenario = load_scenario({"test", "test.toml", R"(format = 1
[embryo]
shape = "sheet"
length_um = 60
width_um = 80
cell_count = 240
cell_height_um = 10
periodic = ["x"]
rim = "held"
[region.stripe]
y_um = [-7, 7]
[cortex.apical]
region = "stripe"
tension_mN_per_m = 1
[self_contact]
surface = "apical"
[time]
end_s = 8
integrator = "bdf2"
[stop]
at_equilibrium = false
)"});
  Simulation whole(scenario);
  for (int step = 0; step < 5; ++step) ASSERT_TRUE(whole.step()) << whole.failure();
  Checkpoint checkpoint{"", "", "", whole.memory(), {}};
  checkpoint.record.rows.push_back(whole.measures());
  if (can_archive()) checkpoint = read_checkpoint_bytes(checkpoint_bytes(checkpoint));
  Simulation resumed(scenario), fork = whole;
  resumed.go_on_from(std::move(checkpoint.run), checkpoint.record.rows.back());
  ASSERT_EQ(whole.run(), RunStatus::end_time) << whole.failure();
  ASSERT_EQ(resumed.run(), RunStatus::end_time) << resumed.failure();
  const ThreadCount two(2);
  ASSERT_EQ(fork.run(), RunStatus::end_time) << fork.failure();
  for (const Simulation* other : {&resumed, &fork}) {
    EXPECT_EQ(other->state().positions, whole.state().positions);
    EXPECT_EQ(other->state().velocities, whole.state().velocities);
    EXPECT_EQ(other->state().multipliers, whole.state().multipliers);
  }
  // Images have stayed where they belong, but for rounding.
  const Tissue& tissue = whole.model().tissue;
  Vectors placed = whole.state().positions;
  tissue.place_hanging_positions(placed);
  EXPECT_LT(apart(placed, whole.state().positions), 1e-10);
}

}  // namespace
}  // namespace plica
