// Whole embryos of polygons: closed, upright, with walls in common, on their surface.
#include "tissue/shapes/polygon_embryo.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "support/whole.hpp"
#include "tissue/mesh_quality.hpp"
#include "tissue/shapes/even_points.hpp"

namespace plica {
namespace {

using namespace support;

const EggShape small_egg{250, 120, 120, 11.0, 5.0};

class PolygonEmbryo : public testing::TestWithParam<PolygonSplit> {};

INSTANTIATE_TEST_SUITE_P(Splits, PolygonEmbryo, testing::Values(PolygonSplit::diagonals, PolygonSplit::kites),
                         [](const auto& info) { return info.param == PolygonSplit::kites ? "kites" : "diagonals"; });

TEST_P(PolygonEmbryo, IsClosedAndUpright) {
  const Tissue tissue = build_egg(small_egg, 400, 1, {20, GetParam(), 2});
  EXPECT_EQ(tissue.cells.size(), 400U);
  const Counted counted = expect_faces_enclose_the_cells(tissue);
  EXPECT_EQ(counted.rims, 0U);
  EXPECT_GT(min_scaled_jacobian(tissue, tissue.rest_positions), 0.1);
  std::size_t sides = 0;
  for (const Cell& cell : tissue.cells) sides += cell.sides();
  EXPECT_EQ(sides, 6U * 400 - 12) << "three cells at every vertex of a closed surface";
  for (const Cell& cell : tissue.cells)
    for (const NodeId corner : cell.apical_corners())
      EXPECT_NEAR(tissue.outer_shape->gap(tissue.rest_positions[corner.index()]).value, 0, 1e-3);
}

TEST(PolygonEmbryo, CellsAreOfOneSize) {
  const Tissue tissue = build_egg({500, 180, 180, 17.0, 7.0}, 1500, 3, {35, PolygonSplit::diagonals, 1});
  const std::vector<double> areas = apical_areas(tissue, tissue.rest_positions);
  const double mean = std::accumulate(areas.begin(), areas.end(), 0.0) / 1500;
  double squares = 0;
  for (const double area : areas) squares += (area - mean) * (area - mean);
  EXPECT_LT(std::sqrt(squares / 1500) / mean, 0.12);
  double shortest = 1e9, sum = 0;
  std::size_t edges = 0;
  for (const Cell& cell : tissue.cells)
    for (const CellEdge& edge : cell.edges) {
      if (edge.side != CellSide::apical) continue;
      const double length =
          (tissue.rest_positions[edge.nodes.back().index()] - tissue.rest_positions[edge.nodes.front().index()]).norm();
      shortest = std::min(shortest, length), sum += length, ++edges;
    }
  EXPECT_GT(shortest, 0.15 * sum / static_cast<double>(edges));
}

TEST(PolygonEmbryo, SeedsMakeTheSameAgainAndOthersOthers) {
  const PolygonCells cells{20, PolygonSplit::diagonals, 1};
  const Tissue one = build_egg(small_egg, 100, 1, cells), again = build_egg(small_egg, 100, 1, cells),
               other = build_egg(small_egg, 100, 2, cells);
  EXPECT_EQ(one.rest_positions, again.rest_positions);
  EXPECT_NE(one.rest_positions, other.rest_positions);
}

TEST(PolygonEmbryo, SaysWhatItHadToMend) {
  const Tissue tissue = build_egg(small_egg, 200, 1, {45, PolygonSplit::diagonals, 1});
  std::string all;
  for (const std::string& remark : tissue.remarks) all += remark + '\n';
  EXPECT_NE(all.find("cells are lower than 45 um"), std::string::npos) << all;
}

// About points of an egg that lie below its surface and have shrunk.
TEST(PolygonEmbryo, AboutPointsHasTheirSurface) {
  const StarSurface egg = egg_surface({300, 150, 150, {}, {}});
  Vectors points = even_points(egg, 600, 2);
  for (Vec3& point : points) point -= 8 * egg.closest(point).normal;
  const Tissue tissue = build_about_points({points, 8, {1.5, 1, 1}}, {25, PolygonSplit::diagonals, 1});
  ASSERT_EQ(tissue.cells.size(), points.size());
  double longest = 0, widest = 0;
  for (const Vec3& x : tissue.rest_positions)
    longest = std::max(longest, std::abs(x.x())), widest = std::max(widest, std::abs(x.y()));
  EXPECT_NEAR(longest, 225, 3);
  EXPECT_NEAR(widest, 75, 1);
  for (std::size_t c = 0; c < points.size(); ++c) {
    Vec3 apex = Vec3::Zero();
    for (const NodeId corner : tissue.cells[c].apical_corners()) apex += tissue.rest_positions[corner.index()];
    const Vec3 point = points[c].cwiseProduct(Vec3(1.5, 1, 1));
    EXPECT_LT((apex.normalized() - point.normalized()).norm(), 0.07) << "half a cell; cell " << c;
  }
}

}  // namespace
}  // namespace plica
