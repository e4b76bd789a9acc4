#include "measure/closing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "measure/cells.hpp"
#include "mechanics/constraints/enclosed_volume.hpp"
#include "mechanics/contact/self_contact.hpp"
#include "mechanics/obstacles/vitelline.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"
#include "support/models.hpp"

namespace plica {
namespace {

using namespace support;

// 0.5 um/min up to 6 um at 12 min, then 4 um/min; rows as uneven as those of a run.
TEST(Knee, IsWhereTwoStraightLinesMeet) {
  std::vector<double> times, depths;
  for (double t = 0; t < 1200; t += 5 + 20 * std::abs(std::sin(t))) {
    times.push_back(t);
    depths.push_back(t < 720 ? t / 120 : 6 + (t - 720) / 15);
  }
  const std::optional<Knee> found = knee(times, depths);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->time_s, 720, 25);  // a row's
  EXPECT_NEAR(found->depth_um, 6, 0.6);
  // What comes after 20 um does not matter.
  std::vector<double> stopped = depths;
  for (double& depth : stopped) depth = std::min(depth, 21.0);
  EXPECT_EQ(knee(times, stopped)->depth_um, found->depth_um);
  for (double& depth : depths) depth /= 10;
  EXPECT_FALSE(knee(times, depths));
  EXPECT_FALSE(knee(std::span(times).first(5), std::span(stopped).first(5)));
}

TEST(TimeOfReaching, IsLinearBetweenRows) {
  const std::vector<double> times = {0, 10, 30}, values = {-1, 4, 24};
  EXPECT_DOUBLE_EQ(*time_of_reaching(times, values, 14), 20);
  EXPECT_DOUBLE_EQ(*time_of_reaching(times, values, -2), 0);
  EXPECT_FALSE(time_of_reaching(times, values, 25));
}

TEST(FlankVolume, IsWhatLiesOnTheSides) {
  const Tissue tissue = build_shell({.length_um = 460, .cells = {18, 9, 8}});
  const double at_rest = *flank_volume(tissue, tissue.rest_positions);
  EXPECT_GT(at_rest, 0);
  // Squeezed along x, all of it is less by the same.
  Vectors positions = tissue.rest_positions;
  for (Vec3& x : positions) x.x() *= 0.9;
  EXPECT_NEAR(*flank_volume(tissue, positions) / at_rest, 0.9, 1e-9);
  // Turned by 0.2 rad, left loses at the top what right loses at the bottom, and both gain as much.
  for (std::size_t n = 0; n < positions.size(); ++n)
    positions[n] = Eigen::AngleAxisd(0.2, Vec3::UnitX()) * tissue.rest_positions[n];
  EXPECT_NEAR(*flank_volume(tissue, positions) / at_rest, 1, 0.02);
  EXPECT_FALSE(flank_volume(build_block({}), build_block({}).rest_positions));
}

// Of a cylinder a ring sector: (120 - 60)/180 of half the ring, on two sides.
TEST(FlankSectionArea, IsWhatIsCutOnTheSides) {
  for (const int across : {8, 9}) {
    const Tissue tissue = build_shell({.length_um = 460, .cells = {18, across, across}});
    double low = 1e300, high = 0;
    for (const Vec3& x : tissue.rest_positions)
      if (std::abs(x.x()) < 100)
        low = std::min(low, std::hypot(x.y(), x.z())), high = std::max(high, std::hypot(x.y(), x.z()));
    const double at_rest = *flank_section_area(tissue, tissue.rest_positions), sector = std::numbers::pi / 3;
    EXPECT_NEAR(at_rest, sector * (high * high - low * low), 0.02 * at_rest) << "chords for arcs";
    // A fifth farther from the axis everywhere.
    Vectors positions = tissue.rest_positions;
    for (Vec3& x : positions) x.y() *= 1.2, x.z() *= 1.2;
    EXPECT_NEAR(*flank_section_area(tissue, positions) / at_rest, 1.44, 1e-9);
    // What the belly does is nothing to it.
    positions = tissue.rest_positions;
    for (Vec3& x : positions)
      if (x.z() < -std::abs(x.y())) x.z() *= 0.9;
    EXPECT_NEAR(*flank_section_area(tissue, positions) / at_rest, 1, 1e-9);
  }
  EXPECT_FALSE(flank_section_area(build_block({}), build_block({}).rest_positions));
}

TEST(ShortEdges, AreThoseShorterThanATenthOfTheirLengthAtRest) {
  const Tissue tissue = build_block({.length_um = 60, .width_um = 40, .cells = {3, 2, 1}});
  EXPECT_EQ(short_edges(tissue, tissue.rest_positions), 0u);
  Vectors positions = tissue.rest_positions;
  for (Vec3& x : positions) x.x() *= 0.11;
  EXPECT_EQ(short_edges(tissue, positions), 0u);
  for (Vec3& x : positions) x.x() *= 0.9;
  EXPECT_EQ(short_edges(tissue, positions), 9u) << "along x: three a row, each once, and none below";
}

TEST(ShellFluid, IsTheShellLessWhatIsInside) {
  Model model(build_shell({.length_um = 300, .diameter_um = 200, .cells = {12, 9, 8}}));
  EXPECT_FALSE(fluid_under_shell_um3(model, model.tissue.rest_positions));
  model.obstacles.push_back(std::make_unique<Vitelline>(model.tissue, model.tissue.outer_shape->moved_out(10)));
  const double whole = std::numbers::pi * 110 * 110 * (100 + 4 * 110 / 3.0);
  Vectors shrunk = model.tissue.rest_positions;
  for (Vec3& x : shrunk) x *= 0.5;
  const double fluid = *fluid_under_shell_um3(model, model.tissue.rest_positions);
  const double inside = whole - fluid;
  EXPECT_GT(fluid, 0);
  EXPECT_NEAR(whole - *fluid_under_shell_um3(model, shrunk), inside / 8, 1e-6 * whole);
}

// The shell around a slice has caps that the slice has not.
TEST(ShellFluid, IsNotToldOfASlice) {
  EXPECT_FALSE(Simulation(load_scenario(find_scenario("furrow-slice"))).measures()["shell_fluid_um3"]);
}

TEST(EnclosedVolume, HasItsRatioAndPressure) {
  Model model(build_shell({.length_um = 300, .diameter_um = 200, .cells = {12, 9, 8}}));
  EXPECT_FALSE(enclosed(model, rest_state(model)));
  model.laws.push_back(std::make_unique<ElasticVolume>(model.tissue, 5));
  State state = rest_state(model);
  for (Vec3& x : state.positions) x *= 0.9;
  EXPECT_NEAR(enclosed(model, state)->volume_ratio, 0.729, 1e-12);
  EXPECT_NEAR(enclosed(model, state)->pressure_kPa, 5 * 0.271, 1e-12);
  Model held(model.tissue);
  held.constraints.push_back(std::make_unique<EnclosedVolume>(held.tissue));
  State of_held = rest_state(held);
  of_held.multipliers.back() = 0.25;
  EXPECT_NEAR(enclosed(held, of_held)->volume_ratio, 1, 1e-12);
  EXPECT_EQ(enclosed(held, of_held)->pressure_kPa, 0.25);
}

// A gutter along x, 60 um long, whose two sides come nearer than the contact's distance at one end, or everywhere.
TEST(ContactState, TellsHowFarTheLipsHaveClosed) {
  const auto gutter = [](double gap_um) {
    return mapped_lattice(6, 8, 1, [&](int i, int j, int k) {
      const double x = 10.0 * i - 30, out = gap_um / 2 + (k == 0 ? 10 : 0);
      if (j <= 2) return Vec3(x, -out, 20 - 10.0 * j);
      if (j >= 6) return Vec3(x, out, 10.0 * (j - 6));
      const double angle = M_PI * (j - 2) / 4;
      return Vec3(x, -out * std::cos(angle), -out * std::sin(angle));
    });
  };
  Model model(gutter(2));
  EXPECT_FALSE(contact_state(model, rest_state(model)));
  model.laws.push_back(std::make_unique<SelfContact>(model.tissue, SelfContactRule{.search = 3}));
  State state = rest_state(model);
  ASSERT_TRUE(contact_state(model, state));
  EXPECT_EQ(contact_state(model, state)->pairs, 0);
  EXPECT_GT(*contact_state(model, state)->least_gap_um, 0.4);
  EXPECT_LT(*contact_state(model, state)->least_gap_um, 2.1);
  EXPECT_EQ(contact_state(model, state)->closed_length_ratio, 0);
  // The sides beyond `from_x` come nearer by 1.8 um.
  const auto closed_from = [&](double from_x) {
    State there = state;
    for (Vec3& x : there.positions)
      if (x.z() >= 0 && x.x() > from_x) x.y() += x.y() > 0 ? -0.9 : 0.9;
    const Step step{.positions = there.positions,
                    .previous_positions = there.positions,
                    .previous_velocities = there.velocities,
                    .rate_s = 1,
                    .internals = state.internals};
    there.internals = next_internals(model, step);
    return *contact_state(model, there);
  };
  const ContactState end = closed_from(15), whole = closed_from(-100);
  for (const ContactState& found : {end, whole}) {
    EXPECT_GT(found.pairs, 0);
    EXPECT_GT(*found.least_gap_um, 0);
    EXPECT_LT(*found.least_gap_um, 0.4);
  }
  EXPECT_GE(end.closed_length_ratio, 1.0 / 6 - 1e-9);  // the last column of six; the one before it is half closed
  EXPECT_LE(end.closed_length_ratio, 2.0 / 6 + 1e-9);
  EXPECT_FALSE(end.middle_is_closed);
  EXPECT_NEAR(whole.closed_length_ratio, 1, 1e-9);
  EXPECT_TRUE(whole.middle_is_closed);
}

}  // namespace
}  // namespace plica
