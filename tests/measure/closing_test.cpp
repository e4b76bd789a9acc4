// A furrow that closes: sections, speeds, onset of fast invagination, fluid and contact.
#include "measure/closing.hpp"

#include "measure/cells.hpp"
#include "measure/cross_section.hpp"
#include "mechanics/constraints/enclosed_volume.hpp"
#include "mechanics/contact/self_contact.hpp"
#include "mechanics/obstacles/vitelline.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"
#include "support/models.hpp"

namespace {

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

std::vector<SectionCell> at_place(const std::vector<SectionCell>& cells, int percent) {
  std::vector<SectionCell> found;
  for (const SectionCell& one : cells)
    if (one.place_percent == percent) found.push_back(one);
  return found;
}

Vec3 rest_centre(const Tissue& tissue, CellId cell) {
  return cell_centre(tissue.cells[cell.index()], tissue.rest_positions);
}

// Even and odd numbers of cells along and across: one ring a place, each cell once, numbers in the order of angles.
TEST(CrossSection, IsARingOfCellsAtEachPlace) {
  for (const auto& counts : {std::array{20, 8, 8}, {21, 9, 8}, {20, 9, 7}}) {
    const Tissue tissue = build_shell({.length_um = 500, .diameter_um = 180, .cell_height_um = 35, .cells = counts});
    const std::vector<SectionCell> all = section_cells(tissue, -Vec3::UnitZ());
    EXPECT_EQ(all.front().place_percent, 50);
    const bool odd = counts[1] % 2 == 1;
    const int around = 2 * counts[1] + 2 * counts[2];
    for (const int percent : {25, 50, 75}) {
      const std::vector<SectionCell> ring = at_place(all, percent);
      ASSERT_EQ(ring.size(), static_cast<std::size_t>(around)) << percent;
      std::set<int> numbers;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec3 centre = rest_centre(tissue, ring[i].cell);
        EXPECT_NEAR(centre.x(), 5 * percent - 250, 500.0 / counts[0]);
        EXPECT_TRUE(numbers.insert(ring[i].from_midline).second);
        if (std::abs(centre.y()) > 1e-6) {
          EXPECT_EQ(ring[i].from_midline > 0, centre.y() > 0);
        }
        if (i > 0) {
          EXPECT_GT(ring[i].from_midline, ring[i - 1].from_midline) << "from left to right";
        }
      }
      EXPECT_EQ(numbers.contains(0), odd);
      EXPECT_EQ(*numbers.rbegin(), around / 2);
      EXPECT_EQ(*numbers.begin(), odd ? 1 - around / 2 : -around / 2);
      // The first ones lie on the belly, mirror images of each other; the last ones on the back.
      for (const SectionCell& one : ring) {
        const Vec3 centre = rest_centre(tissue, one.cell);
        if (std::abs(one.from_midline) == 1) {
          EXPECT_LT(centre.z(), -60);
        }
        if (std::abs(one.from_midline) == around / 2 - 1) {
          EXPECT_GT(centre.z(), 60);
        }
      }
    }
  }
}

// A slice has one ring of one cell, wherever it is cut; a sheet's cells are counted along it.
TEST(CrossSection, OfAShortTissueIsOne) {
  const Tissue slice = build_slice({.length_um = 7, .diameter_um = 180, .cell_height_um = 35, .cells = {1, 20, 20}});
  EXPECT_EQ(section_cells(slice, -Vec3::UnitZ()).size(), 80u);
  const Tissue sheet = build_block({.length_um = 20, .width_um = 60, .cells = {1, 3, 1}});
  const std::vector<SectionCell> cells = section_cells(sheet, Vec3::UnitZ());
  ASSERT_EQ(cells.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(cells[i].from_midline, i - 1);
    EXPECT_NEAR(rest_centre(sheet, cells[i].cell).y(), 20 * (i - 1), 1e-9);
  }
}

// A rectangle of 24 by 6 um, turned in its plane by 30 degrees; one element or several.
TEST(ApicalShape, OfARectangleIsItsSides) {
  for (const int elements : {1, 3}) {
    const Tissue tissue = build_block({.length_um = 24,
                                       .width_um = 6,
                                       .cell_height_um = 10,
                                       .cells = {1, 1, 1},
                                       .elements_per_cell = {elements, elements, 1}});
    const std::vector<CellId> cells = {CellId(0)};
    Vectors positions = tissue.rest_positions;
    const double turn = 30 * M_PI / 180;
    for (Vec3& x : positions) x = Eigen::AngleAxisd(turn, Vec3::UnitZ()) * x;
    const FaceShape shape = apical_shapes(tissue, cells, positions).front();
    EXPECT_NEAR(shape.long_axis_um, 24, 1e-9);
    EXPECT_NEAR(shape.short_axis_um, 6, 1e-9);
    EXPECT_NEAR(shape.direction_deg, 30, 1e-9);
    EXPECT_NEAR(shape.width_across_um, std::hypot(24 * std::sin(turn), 6 * std::cos(turn)), 1e-9);
    EXPECT_NEAR(shape.length_along_um, std::hypot(24 * std::cos(turn), 6 * std::sin(turn)), 1e-9);
    // Tilted as a whole about the axis: no other shape. Standing on its end: it has no direction.
    for (Vec3& x : positions) x = Eigen::AngleAxisd(0.7, Vec3::UnitX()) * x;
    EXPECT_NEAR(apical_shapes(tissue, cells, positions).front().direction_deg, 30, 1e-9);
    for (std::size_t n = 0; n < positions.size(); ++n)
      positions[n] = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()) * tissue.rest_positions[n];
    EXPECT_TRUE(std::isnan(apical_shapes(tissue, cells, positions).front().direction_deg));
  }
}

/// A step: the speeds of VML and VCE, and their displacements.
FurrowSpeeds row(double time_s, double vml_speed, double vce_speed, double vml_displacement, double vce_displacement) {
  return {time_s, vml_speed, vce_speed, vml_displacement, vce_displacement};
}

/// The ends lead by most at 2 s, three to one; both are as fast at 4 s, halfway between two rows.
std::vector<FurrowSpeeds> ends_first() {
  return {FurrowSpeeds{},  // at rest, without speeds
          row(1, 1, 2, 1, 2), row(2, 2, 6, 3, 8), row(3, 5, 7, 10, 30), row(5, 8, 6, 20, 34), row(6, 4, 5, 24, 39)};
}

TEST(SpeedHistory, EndsLeadMostAtThePeakAndUntilSpeedsAreEqual) {
  const SpeedHistory history = speed_history(ends_first());
  EXPECT_DOUBLE_EQ(history.peak_ratio.value(), 3);
  EXPECT_EQ(history.peak_ratio_time_s.value(), 2);
  EXPECT_DOUBLE_EQ(history.ends_lead_until_s.value(), 4);
  EXPECT_DOUBLE_EQ(history.vml_displacement_at_equal_speed_um.value(), 15);
  EXPECT_DOUBLE_EQ(history.vce_displacement_at_equal_speed_um.value(), 32);
}

TEST(SpeedHistory, StepsInWhichTheMiddleHardlyMovesAreNoPeak) {
  std::vector<FurrowSpeeds> rows = ends_first();
  const double limit = 0.01 * 8;  // 1 % of the middle's fastest
  rows.insert(rows.begin() + 1, row(0.5, limit, 50, 0.1, 9));
  EXPECT_EQ(speed_history(rows).peak_ratio_time_s.value(), 2);
  rows[1] = row(0.5, 1.01 * limit, 50, 0.1, 9);
  EXPECT_EQ(speed_history(rows).peak_ratio_time_s.value(), 0.5);
}

TEST(SpeedHistory, SpeedsThatAreEqualInARowMeetThere) {
  const std::vector<FurrowSpeeds> rows = {row(1, 1, 3, 1, 3), row(2, 4, 4, 5, 7), row(3, 5, 4, 10, 11)};
  const SpeedHistory history = speed_history(rows);
  EXPECT_EQ(history.ends_lead_until_s.value(), 2);
  EXPECT_EQ(history.vml_displacement_at_equal_speed_um.value(), 5);
  EXPECT_EQ(history.vce_displacement_at_equal_speed_um.value(), 7);
}

TEST(SpeedHistory, AMiddleThatMovesByRoundingOnlyHasNoRatio) {
  EXPECT_FALSE(row(1, 4.5e-23, 0.96, 0, 0).speed_ratio());
  EXPECT_FALSE(row(1, 0, 0, 0, 0).speed_ratio());
  EXPECT_DOUBLE_EQ(*row(1, 0.1, 0.3, 0, 0).speed_ratio(), 0.3 / 0.1);
}

TEST(SpeedHistory, WhatNeverHappensHasNoValue) {
  for (const auto& rows : {std::vector<FurrowSpeeds>{}, {FurrowSpeeds{}}, {row(1, 0, 0, 0, 0)}}) {
    const SpeedHistory none = speed_history(rows);
    EXPECT_FALSE(none.peak_ratio || none.peak_ratio_time_s || none.ends_lead_until_s);
  }
  const std::vector<FurrowSpeeds> to_the_end = {row(1, 1, 3, 1, 3), row(2, 4, 5, 5, 8)};
  const SpeedHistory leading = speed_history(to_the_end);
  EXPECT_EQ(leading.peak_ratio_time_s.value(), 1);
  EXPECT_FALSE(leading.ends_lead_until_s || leading.vml_displacement_at_equal_speed_um ||
               leading.vce_displacement_at_equal_speed_um);
}

}  // namespace
