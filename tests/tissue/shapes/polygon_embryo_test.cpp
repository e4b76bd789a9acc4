// Whole embryos of polygons: closed, upright, with walls in common, on their surface.
#include "tissue/shapes/polygon_embryo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "support/mesh_error.hpp"
#include "support/whole.hpp"
#include "tissue/mesh_quality.hpp"
#include "tissue/shapes/even_points.hpp"

namespace plica {
namespace {

using namespace support;

const EggShape small_egg{250, 120, 120, 11.0, 5.0};

class PolygonEmbryo : public testing::TestWithParam<PolygonSplit> {};

INSTANTIATE_TEST_SUITE_P(Splits, PolygonEmbryo, testing::Values(PolygonSplit::diagonals, PolygonSplit::kites),
                         [](const auto& given) { return given.param == PolygonSplit::kites ? "kites" : "diagonals"; });

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
  const Tissue tissue = build_about_points({points, 8, {{1.5, 1, 1}}}, {25, PolygonSplit::diagonals, 1});
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

constexpr double golden = std::numbers::phi;

// All even permutations of the coordinates with all signs.
Vectors orbit(const std::vector<Vec3>& seeds) {
  Vectors points;
  for (const Vec3& seed : seeds)
    for (int turn = 0; turn < 3; ++turn)
      for (int signs = 0; signs < 8; ++signs) {
        Vec3 point(seed[turn], seed[(turn + 1) % 3], seed[(turn + 2) % 3]);
        for (int axis = 0; axis < 3; ++axis)
          if ((signs >> axis & 1) != 0) point[axis] = -point[axis];
        if (std::ranges::none_of(points, [&](const Vec3& other) { return (other - point).norm() < 1e-9; }))
          points.push_back(point);
      }
  return points;
}

// A football: 12 pentagons, 20 hexagons, edges of 2.
PolygonSurface truncated_icosahedron() {
  PolygonSurface surface;
  surface.vertices = orbit({{0, 1, 3 * golden}, {1, 2 + golden, 2 * golden}, {golden, 2, 2 * golden + 1}});
  Vectors outward = orbit({{0, 1, golden}});
  const Vectors of_hexagons = orbit({{1, 1, 1}, {0, golden, 1 / golden}});
  outward.insert(outward.end(), of_hexagons.begin(), of_hexagons.end());
  for (const Vec3& direction : outward) {
    double farthest = 0;
    for (const Vec3& vertex : surface.vertices) farthest = std::max(farthest, vertex.dot(direction));
    auto& polygon = surface.polygons.emplace_back();
    for (std::size_t v = 0; v < surface.vertices.size(); ++v)
      if (surface.vertices[v].dot(direction) > farthest - 1e-9) polygon.push_back(v);
    const Vec3 u = direction.unitOrthogonal(), w = direction.normalized().cross(u);
    std::ranges::sort(
        polygon, {}, [&](std::size_t v) { return std::atan2(surface.vertices[v].dot(w), surface.vertices[v].dot(u)); });
  }
  return surface;
}

// The volume within plane faces: a pyramid each.
double volume_within(const Vectors& vertices, const std::vector<std::vector<std::size_t>>& polygons) {
  double volume = 0;
  for (const auto& polygon : polygons) volume += area_vector(vertices, polygon).dot(vertices[polygon[0]]) / 3;
  return volume;
}

double volume_of(const Tissue& tissue) {
  double volume = 0;
  for (const Cell& cell : tissue.cells) volume += cell_volume(tissue, cell, tissue.rest_positions);
  return volume;
}

const double football_volume = (125 + 43 * std::sqrt(5.0)) / 4;  // of an edge of 1
const double pentagon_area = std::sqrt(25 + 10 * std::sqrt(5.0)) / 4, hexagon_area = 1.5 * std::sqrt(3.0);

// Known: area and volume of the solid. Its vertices lie on a ball, so the basal faces are those of a smaller one.
TEST_P(PolygonEmbryo, UnderAFootballHasItsAreaAndVolume) {
  const PolygonSurface football = truncated_icosahedron();
  ASSERT_EQ(football.vertices.size(), 60U);
  ASSERT_EQ(football.polygons.size(), 32U);
  const double edge = 10, height = 8;
  const SurfaceTissue made =
      build_under_surface({.surface = football, .placement = {Vec3::Constant(edge / 2)}}, {height, GetParam(), 2});
  const Tissue& tissue = made.tissue;
  EXPECT_EQ(made.why_no_shape, "");
  EXPECT_EQ(tissue.cells.size(), 32U);
  EXPECT_EQ(expect_faces_enclose_the_cells(tissue).rims, 0U);
  const std::vector<double> areas = apical_areas(tissue, tissue.rest_positions);
  for (std::size_t c = 0; c < 32; ++c)
    EXPECT_NEAR(areas[c] / (edge * edge), c < 12 ? pentagon_area : hexagon_area, 1e-12);
  const double inside = 1 - height / (edge / 2 * football.vertices[0].norm());
  EXPECT_NEAR(volume_of(tissue) / (football_volume * std::pow(edge, 3) * (1 - std::pow(inside, 3))), 1, 1e-9);
  ASSERT_TRUE(tissue.outer_shape);
  for (const NodeId corner : tissue.cells[0].apical_corners())
    EXPECT_NEAR(tissue.outer_shape->gap(tissue.rest_positions[corner.index()]).value, 0, 1e-6);
}

// Off the origin there is no smooth surface. Its vertices are alike, so the basal faces are plane all the same, and
// known from the way that a vertex goes: against the mean of its faces' normals by area.
TEST_P(PolygonEmbryo, UnderAFootballElsewhereGoesAlongMeanNormals) {
  PolygonSurface football = truncated_icosahedron();
  const double height = 1.6;
  Vectors basal(60, Vec3::Zero());
  for (std::size_t c = 0; c < 32; ++c)
    for (const std::size_t v : football.polygons[c])
      basal[v] -=
          (c < 12 ? pentagon_area : hexagon_area) * area_vector(football.vertices, football.polygons[c]).normalized();
  for (std::size_t v = 0; v < 60; ++v) basal[v] = football.vertices[v] + height * basal[v].normalized();
  for (Vec3& vertex : football.vertices) vertex += Vec3(100, 50, 0);
  const SurfaceTissue made = build_under_surface({.surface = football}, {height, GetParam(), 1});
  EXPECT_NE(made.why_no_shape.find("points must surround the origin"), std::string::npos) << made.why_no_shape;
  EXPECT_NEAR(volume_of(made.tissue) / (8 * football_volume - volume_within(basal, football.polygons)), 1, 1e-9);
}

TEST(SurfaceEmbryo, TakesAHeightACellAndMovesToTheMiddle) {
  PolygonSurface football = truncated_icosahedron();
  for (Vec3& vertex : football.vertices) vertex += Vec3(100, 50, 0);
  std::vector<double> heights(32, 1.0);
  heights[3] = 1.3;
  const SurfaceTissue off = build_under_surface({.surface = football, .heights_um = heights}, {});
  EXPECT_NE(off.why_no_shape.find("points must surround the origin"), std::string::npos) << off.why_no_shape;
  EXPECT_FALSE(off.tissue.outer_shape);
  const SurfaceTissue centred =
      build_under_surface({.surface = football, .heights_um = heights, .placement = {.centre = true}}, {});
  EXPECT_EQ(centred.why_no_shape, "");
  const auto height = [&](std::size_t c) {
    const Cell& cell = centred.tissue.cells[c];
    return (centred.tissue.rest_positions[cell.apical_corners()[0].index()] -
            centred.tissue.rest_positions[cell.basal_corners()[0].index()])
        .norm();
  };
  EXPECT_NEAR(height(3), 1.1, 1e-9);  // the mean of three cells
  expect_mesh_error(
      [&] {
        build_under_surface({.surface = football, .heights_um = {1, 2}}, {});
      },
      "2 heights for 32 cells");
  heights[5] = 0;
  expect_mesh_error([&] { build_under_surface({.surface = football, .heights_um = heights}, {}); },
                    "the height of row 5 is 0 um; heights must be positive");
}

TEST(SurfaceEmbryo, AnOpenOneHasNoShape) {
  PolygonSurface football = truncated_icosahedron();
  football.polygons.pop_back();
  const SurfaceTissue made = build_under_surface({.surface = football}, {1});
  EXPECT_EQ(made.why_no_shape, "the surface has a boundary; give a closed surface");
  EXPECT_EQ(expect_faces_enclose_the_cells(made.tissue).rims, 6U);
}

}  // namespace
}  // namespace plica
