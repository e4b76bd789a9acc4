// Patches of polygons, flat and bent.
#include "tissue/shapes/polygon_sheet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "support/mesh_error.hpp"
#include "support/whole.hpp"
#include "tissue/division.hpp"
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
  expect_mesh_error([] { build_sheet({100, 100, {0.07, 0}}, 50, 1, cells); }, "would overlap itself");
  expect_mesh_error(
      [] {
        build_sheet({100, 200, {0.01, 0.013}}, 50, 1, cells);
      },
      "times as long at its sides as in its middle");
}

// How many walls a tissue has, and how many of them at a rim.
std::pair<std::size_t, std::size_t> walls_of(const Tissue& tissue) {
  const std::vector<Face> faces = faces_of(tissue, CellSide::lateral);
  const auto at_rim = std::ranges::count_if(faces, [](const Face& face) { return !face.beyond; });
  return {faces.size(), static_cast<std::size_t>(at_rim)};
}

TEST(PolygonSheet, OfTwoPeriodsHasNoRim) {
  const SheetShape shape{90, 70, {0, 0}, {true, true}};
  for (const PolygonCells& built :
       {cells, PolygonCells{12, PolygonSplit::diagonals, 3}, PolygonCells{12, PolygonSplit::kites, 2}}) {
    const Tissue tissue = build_sheet(shape, 60, 1, built);
    const std::size_t faces_a_wall =
        static_cast<std::size_t>(built.layers) * (built.split == PolygonSplit::kites ? 2 : 1);
    EXPECT_EQ(walls_of(tissue), (std::pair{3 * 60 * faces_a_wall, std::size_t{0}}));
    std::size_t neighbours = 0;
    for (const auto& of_cell : wall_neighbours(tissue)) neighbours += of_cell.size();
    EXPECT_EQ(neighbours, 6U * 60);
    for (const auto* facets : {&tissue.apical_facets, &tissue.basal_facets}) {
      EXPECT_TRUE(rim_of(tissue, *facets).empty());
      EXPECT_FALSE(encloses(tissue, *facets));
    }
    EXPECT_NEAR(min_scaled_jacobian(tissue, tissue.rest_positions), 0.5, 0.35);
    EXPECT_TRUE(why_indivisible(tissue));
    EXPECT_EQ(tissue.remarks.size(), build_sheet({90, 70}, 60, 1, built).remarks.size());
  }
}

TEST(PolygonSheet, ImagesAreAPeriodAway) {
  const SheetShape shape{90, 70, {0, 0}, {true, true}};
  const Tissue tissue = build_sheet(shape, 60, 1, cells);
  ASSERT_EQ(tissue.hanging_shifts.size(), tissue.hanging.size());
  Vectors placed = tissue.rest_positions;
  tissue.place_hanging_positions(placed);
  std::size_t images = 0, middles_across = 0;
  for (std::size_t h = 0; h < tissue.hanging.size(); ++h) {
    const NodeId node(tissue.free_node_count() + h);
    const Vec3& shift = tissue.hanging_shifts[h];
    EXPECT_LT((placed[node.index()] - tissue.rest_positions[node.index()]).norm(), 1e-10);
    if (tissue.original(node) == node) {
      middles_across += !shift.isZero(0);
      continue;
    }
    EXPECT_EQ(shift, Vec3(90 * std::round(shift.x() / 90), 70 * std::round(shift.y() / 70), 0));
    EXPECT_FALSE(shift.isZero(0));
    ++images;
  }
  EXPECT_GT(images, 30U);
  EXPECT_GT(middles_across, 0U);
  // A vertex has one free node on either side of the sheet, and a cell two vertices of its own.
  EXPECT_EQ(tissue.free_node_count(), 2U * 2 * 60);
}

TEST(PolygonSheet, OfOnePeriodMayBeATrough) {
  for (const int axis : {0, 1}) {
    SheetShape shape{90, 90};
    shape.is_periodic[axis] = true;
    shape.curvature_per_um[1 - axis] = 0.01;
    const Tissue tissue = build_sheet(shape, 80, 1, cells);
    double rim = 0;
    for (const Face& face : faces_of(tissue, CellSide::lateral)) {
      if (face.beyond) continue;
      const auto& x = tissue.rest_positions;
      rim += std::abs(x[face.nodes[1].index()][axis] - x[face.nodes[0].index()][axis]);
    }
    EXPECT_NEAR(rim, 2 * 90, 1e-9);
    for (const Cell& cell : tissue.cells)
      for (const NodeId corner : cell.apical_corners()) {
        const Vec3& x = tissue.rest_positions[corner.index()];
        EXPECT_NEAR(std::hypot(x[1 - axis], x.z() + 100 - 6), 100, 1e-9);
      }
    shape.curvature_per_um[axis] = 0.001;
    expect_mesh_error([&] { build_sheet(shape, 80, 1, cells); }, "cannot be periodic along a direction");
  }
}

}  // namespace
}  // namespace plica
