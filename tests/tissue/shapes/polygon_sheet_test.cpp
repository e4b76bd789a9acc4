// Patches of polygons, flat and bent.
#include "tissue/shapes/polygon_sheet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "support/mesh_error.hpp"
#include "support/whole.hpp"
#include "tissue/mesh_quality.hpp"

namespace plica {
namespace {

using namespace support;

const PolygonCells cells{12, PolygonSplit::diagonals, 1};

TEST(PolygonSheet, FillsItsRectangle) {
  const Tissue tissue = build_sheet({140, 70, {0, 0}}, 200, 1, cells);
  EXPECT_EQ(tissue.cells.size(), 200U);
  const Counted counted = expect_faces_enclose_the_cells(tissue);
  EXPECT_NEAR(counted.rim_area, 12 * 2 * (140 + 70), 1e-9);
  EXPECT_GT(min_scaled_jacobian(tissue, tissue.rest_positions), 0.15);
  const std::vector<double> areas = apical_areas(tissue, tissue.rest_positions);
  const double mean = 140.0 * 70 / 200;
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0) / 200, mean, 1e-9);
  double squares = 0;
  for (const double area : areas) squares += std::pow(area / mean - 1, 2);
  EXPECT_LT(std::sqrt(squares / 200), 0.12);
  EXPECT_FALSE(tissue.outer_shape);
  for (const Vec3& x : tissue.rest_positions) EXPECT_NEAR(std::abs(x.z()), 6, 1e-12);
}

TEST(PolygonSheet, SeedsMakeTheSameAgainAndOthersOthers) {
  const Tissue one = build_sheet({100, 60, {0, 0}}, 60, 1, cells), again = build_sheet({100, 60, {0, 0}}, 60, 1, cells),
               other = build_sheet({100, 60, {0, 0}}, 60, 2, cells);
  EXPECT_EQ(one.rest_positions, again.rest_positions);
  EXPECT_NE(one.rest_positions, other.rest_positions);
}

// Volume of a bent sheet by Steiner's formula: area and twice the mean curvature where the basal side is parallel.
TEST(PolygonSheet, BendsToACylinderADomeAndASaddle) {
  const auto volume = [](const Tissue& tissue) {
    double sum = 0;
    for (const Cell& cell : tissue.cells) sum += cell_volume(tissue, cell, tissue.rest_positions);
    return sum;
  };
  const double L = 200, W = 120, h = 12;
  // Across a cylinder of radius 100: a sector between the radii 88 and 100.
  Tissue tissue = build_sheet({L, W, {0, 0.01}}, 1200, 1, cells);
  EXPECT_NEAR(volume(tissue) / (L * W * h * (1 - 0.5 * h / 100)), 1, 2e-3);
  for (const Cell& cell : tissue.cells)
    for (const NodeId corner : cell.apical_corners()) {
      const Vec3& x = tissue.rest_positions[corner.index()];
      EXPECT_NEAR(std::hypot(x.y(), x.z() + 100 - h / 2), 100, 1e-9);
    }
  // A ball of radius 100, from -1 to 1 rad along and -0.6 to 0.6 across: its area is 2 * 2 sin(0.6) R^2.
  tissue = build_sheet({L, W, {0.01, 0.01}}, 1200, 1, cells);
  for (const Cell& cell : tissue.cells)
    for (const NodeId corner : cell.apical_corners())
      EXPECT_NEAR((tissue.rest_positions[corner.index()] + Vec3(0, 0, 100 - h / 2)).norm(), 100, 1e-9);
  EXPECT_NEAR(volume(tissue) / (4 * std::sin(0.6) / 3 * (1e6 - std::pow(88, 3))), 1, 3e-3);
  // A saddle: area of this part of a torus, less the mean curvature's part.
  tissue = build_sheet({L, W, {0.005, -0.005}}, 1200, 1, cells);
  const double r = 200, a = 0.5 * W / r;
  const double area = L * (2 * r * (2 * a - std::sin(a)));  // L (1 + (1 - cos t / r)) dt
  EXPECT_NEAR(volume(tissue) / (area * h), 1, 0.02);
  EXPECT_GT(min_scaled_jacobian(tissue, tissue.rest_positions), 0.15);
  expect_faces_enclose_the_cells(tissue);
}

TEST(PolygonSheet, IsLowerWhereItBendsSharply) {
  const Tissue tissue = build_sheet({100, 30, {0, 0.1}}, 300, 1, cells);
  ASSERT_FALSE(tissue.remarks.empty());
  EXPECT_NE(tissue.remarks.back().find("cells are lower than 12 um"), std::string::npos) << tissue.remarks.back();
}

TEST(PolygonSheet, SaysWhatIsWrong) {
  expect_mesh_error([] { build_sheet({100, 100, {0.07, 0}}, 50, 1, cells); }, "would close upon itself");
  expect_mesh_error(
      [] {
        build_sheet({100, 200, {0.01, 0.013}}, 50, 1, cells);
      },
      "times as long at its sides as in its middle");
  expect_mesh_error([] { rectangle_polygons({{0, 0, 0}, {0, 0, 0}}, 10, 10); }, "points 0 and 1 are in one place");
}

TEST(RectanglePolygons, OfTwoPointsAreHalves) {
  const PolygonSurface halves = rectangle_polygons({{-1, 0, 0}, {2, 0, 0}}, 10, 4);
  EXPECT_EQ(halves.vertices.size(), 6U);
  EXPECT_NEAR(polygon_areas(halves)[0], 5.5 * 4, 1e-12);
  EXPECT_NEAR(polygon_areas(halves)[1], 4.5 * 4, 1e-12);
  EXPECT_EQ(polygon_edges(halves).size(), 7U);
}

}  // namespace
}  // namespace plica
