// Embryos of polygons, and the average fly embryo of the Berkeley Drosophila Transcription Network Project (Fowlkes et
// al. 2008, Cell 133:364): cells about its 6078 nuclei.
#include "tissue/shapes/polygon_embryo.hpp"

#include <fmt/format.h>

#include <chrono>

#include "support/mesh_error.hpp"
#include "support/prisms.hpp"
#include "support/whole.hpp"
#include "tissue/files/points_file.hpp"
#include "tissue/mesh_quality.hpp"
#include "tissue/shapes/extrusion.hpp"
#include "tissue/shapes/surface_polygons.hpp"

namespace {

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
  const std::vector<double> areas = face_areas(tissue, CellSide::apical, tissue.rest_positions);
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
  EXPECT_SAYS(all, "cells are lower than 45 um");
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
  const std::vector<double> areas = face_areas(tissue, CellSide::apical, tissue.rest_positions);
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
  EXPECT_SAYS(made.why_no_shape, "points must surround the origin");
  EXPECT_NEAR(volume_of(made.tissue) / (8 * football_volume - volume_within(basal, football.polygons)), 1, 1e-9);
}

TEST(SurfaceEmbryo, TakesAHeightACellAndMovesToTheMiddle) {
  PolygonSurface football = truncated_icosahedron();
  for (Vec3& vertex : football.vertices) vertex += Vec3(100, 50, 0);
  std::vector<double> heights(32, 1.0);
  heights[3] = 1.3;
  const SurfaceTissue off = build_under_surface({.surface = football, .heights_um = heights}, {});
  EXPECT_SAYS(off.why_no_shape, "points must surround the origin");
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
}

TEST(SurfaceEmbryo, AnOpenOneHasNoShape) {
  PolygonSurface football = truncated_icosahedron();
  football.polygons.pop_back();
  const SurfaceTissue made = build_under_surface({.surface = football}, {1});
  EXPECT_EQ(made.why_no_shape, "the surface has a boundary; give a closed surface");
  EXPECT_EQ(expect_faces_enclose_the_cells(made.tissue).rims, 6U);
}

// Nuclei lie 8 um below the surface of the fixed embryo, so they are moved out first and the embryo, surface and all,
// is then scaled to the living one.
Vectors living(const Vectors& nuclei, const StarSurface& fixed) {
  Vectors points;
  for (const Vec3& nucleus : nuclei)
    points.push_back((nucleus + 8 * fixed.closest(nucleus).normal).cwiseProduct(Vec3(1.22, 1.12, 1.12)));
  return points;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double percent(const std::vector<std::size_t>& counts, std::size_t corners, std::size_t all) {
  return corners < counts.size() ? 100.0 * static_cast<double>(counts[corners]) / static_cast<double>(all) : 0;
}

class MeasuredEmbryo : public testing::Test {
 protected:
  const Vectors nuclei = read_points_file(PLICA_SOURCE_DIR "/scenarios/data/drosophila_atlas.csv").points;
};

TEST_F(MeasuredEmbryo, HasCellsOfAnEpithelium) {
  ASSERT_EQ(nuclei.size(), 6078U);
  const StarFit fit = fit_star_surface(nuclei);
  EXPECT_LT(fit.rms_um, 0.4);
  const CellPolygons cells = polygons_of_points(nuclei, fit.surface);
  EXPECT_NEAR(static_cast<double>(cells.flipped_edges), 5000, 500);
  const auto counts = corner_counts(cells.surface);
  EXPECT_NEAR(percent(counts, 4, 6078), 0.3, 0.1);
  EXPECT_NEAR(percent(counts, 5, 6078), 15, 1);
  EXPECT_NEAR(percent(counts, 6, 6078), 69, 1);
  EXPECT_NEAR(percent(counts, 7, 6078), 14, 1);
  EXPECT_NEAR(percent(counts, 8, 6078), 0.6, 0.2);
}

TEST_F(MeasuredEmbryo, LivesAsAnEggOfTheKnownSize) {
  double begin = seconds_now();
  const auto stage = [&](const char* name) {
    fmt::print("{}: {:.3f} s\n", name, seconds_now() - begin);
    begin = seconds_now();
  };
  const Vectors points = living(nuclei, fit_star_surface(nuclei).surface);
  stage("fixed surface");
  const StarFit fit = fit_star_surface(points);
  stage("living surface");
  const CellPolygons cells = polygons_of_points(points, fit.surface);
  stage("polygons");
  const ExtrudedSheet sheet = extrude(cells.surface, vertex_bends(cells.surface, fit.surface), std::array{35.0});
  stage("prisms");

  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  for (const Vec3& vertex : sheet.apical) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  const Vec3 size = high - low;
  EXPECT_NEAR(size.x(), 500, 5);
  EXPECT_NEAR(size.y(), 180, 3);
  EXPECT_NEAR(size.z(), 180, 3);

  const std::vector<double> areas = polygon_areas({sheet.apical, sheet.cells}),
                            basal = polygon_areas({sheet.basal, sheet.cells}), volumes = prism_volumes(sheet);
  std::vector<double> ventral_tapers, ventral_areas;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    // 42 degrees to either side of the belly, over the middle three fifths of the length.
    const bool ventral = std::abs(points[i].y()) < 0.9 * -points[i].z() && std::abs(points[i].x()) < 150;
    if (!ventral) continue;
    ventral_tapers.push_back(basal[i] / areas[i]);
    ventral_areas.push_back(areas[i]);
  }
  const auto counts = corner_counts(cells.surface);
  fmt::print("size {:.1f} x {:.1f} x {:.1f} um; fit rms {:.2f} um, largest {:.2f} um\n", size.x(), size.y(), size.z(),
             fit.rms_um, fit.largest_um);
  fmt::print("corners 4 to 8: {:.1f} {:.1f} {:.1f} {:.1f} {:.1f} %; {} edges lengthened, {} corners sharpened\n",
             percent(counts, 4, 6078), percent(counts, 5, 6078), percent(counts, 6, 6078), percent(counts, 7, 6078),
             percent(counts, 8, 6078), cells.lengthened_edges, cells.sharpened_corners);
  fmt::print("apical area {:.1f} um^2, ventral {:.1f}; volume {:.0f} um^3; ventral taper {:.3f}\n", mean(areas),
             mean(ventral_areas), mean(volumes), mean(ventral_tapers));
  fmt::print("lower than asked for: {} cells, least {:.1f} um\n", sheet.lower_cells, sheet.lowest_um);
  EXPECT_NEAR(mean(areas), 39, 2);
  EXPECT_NEAR(mean(volumes), 1000, 50);
  EXPECT_GT(mean(ventral_tapers), 0.52);
  EXPECT_LT(mean(ventral_tapers), 0.61);
  EXPECT_GT(*std::ranges::min_element(volumes), 400);
  const double yolk = 1 - mean(volumes) * static_cast<double>(volumes.size()) / fit.surface.volume();
  EXPECT_GT(yolk, 0.26);
  EXPECT_LT(yolk, 0.36);
  EXPECT_LT(sheet.lower_cells, 1000);
}

}  // namespace
