// Sheets of polygons: rectangles, periods, extrusion.
#include "tissue/shapes/polygon_sheet.hpp"

#include "support/mesh_error.hpp"
#include "support/prisms.hpp"
#include "support/whole.hpp"
#include "tissue/division.hpp"
#include "tissue/mesh_quality.hpp"
#include "tissue/shapes/extrusion.hpp"
#include "tissue/shapes/polygon_embryo.hpp"
#include "tissue/shapes/surface_polygons.hpp"

namespace {

const PolygonCells cells{12, PolygonSplit::diagonals, 1};

TEST(PolygonSheet, FillsItsRectangle) {
  const Tissue tissue = build_sheet({140, 70, {0, 0}}, 200, 1, cells);
  EXPECT_EQ(tissue.cells.size(), 200U);
  const Counted counted = expect_faces_enclose_the_cells(tissue);
  EXPECT_NEAR(counted.rim_area, 12 * 2 * (140 + 70), 1e-9);
  EXPECT_GT(min_scaled_jacobian(tissue, tissue.rest_positions), 0.15);
  const std::vector<double> areas = face_areas(tissue, CellSide::apical, tissue.rest_positions);
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
  EXPECT_SAYS(tissue.remarks.back(), "cells are lower than 12 um");
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

double total_area(const PolygonSurface& surface) {
  const std::vector<double> areas = polygon_areas(surface);
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

std::size_t rim_edges(const PolygonSurface& surface) {
  const std::vector<PolygonEdge> edges = polygon_edges(surface);
  return static_cast<std::size_t>(
      std::ranges::count_if(edges, [](const PolygonEdge& edge) { return edge.right == no_polygon; }));
}

TEST(RectanglePolygons, OfTwoPointsAreHalves) {
  const PolygonSurface halves = rectangle_polygons({{-1, 0, 0}, {2, 0, 0}}, {{10, 4}});
  EXPECT_EQ(halves.vertices.size(), 6U);
  EXPECT_NEAR(polygon_areas(halves)[0], 5.5 * 4, 1e-12);
  EXPECT_NEAR(polygon_areas(halves)[1], 4.5 * 4, 1e-12);
  EXPECT_EQ(polygon_edges(halves).size(), 7U);
  EXPECT_FALSE(halves.periods.is_used());
}

// Three edges meet at each vertex. On a torus V - E + F = 0 then says E = 3 F: six neighbours on average.
TEST(RectanglePolygons, OfTwoPeriodsHaveSixNeighboursOnAverage) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5})
    for (const std::size_t count : {24, 60, 200}) {
      const Rectangle rectangle{{90, 70}, {true, true}};
      const PolygonSurface surface = rectangle_polygons(even_points(rectangle, count, seed), rectangle);
      EXPECT_EQ(polygon_edges(surface).size(), 3 * count);
      EXPECT_EQ(rim_edges(surface), 0U);
      EXPECT_NEAR(total_area(surface), 90 * 70, 1e-9);
      std::size_t own = 0;
      for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        const Vec3 way = surface.vertices[v] - surface.vertices[surface.periods.original(v)];
        EXPECT_LT((way - surface.periods.whole(way)).norm(), 1e-9);
        own += surface.periods.original(v) == v;
      }
      EXPECT_EQ(own, 2 * count);
    }
}

TEST(RectanglePolygons, OfOnePeriodHaveARimOnTheOtherSides) {
  for (const int axis : {0, 1}) {
    Rectangle rectangle{{90, 70}};
    rectangle.is_periodic[axis] = true;
    const PolygonSurface surface = rectangle_polygons(even_points(rectangle, 80, 1), rectangle);
    EXPECT_NEAR(total_area(surface), 90 * 70, 1e-9);
    double rim = 0;
    for (const PolygonEdge& edge : polygon_edges(surface))
      if (edge.right == no_polygon)
        rim += (surface.vertices[edge.vertices[1]] - surface.vertices[edge.vertices[0]]).norm();
    EXPECT_NEAR(rim, 2 * rectangle.size_um[axis], 1e-9);
  }
}

// Where a period ends is nowhere: cells keep their outlines when all points are moved on.
TEST(RectanglePolygons, DoNotDependOnWhereAPeriodEnds) {
  const Rectangle rectangle{{90, 70}, {true, true}};
  const Vectors points = even_points(rectangle, 60, 1);
  Vectors moved = points;
  for (Vec3& x : moved) x += Vec3(x.x() < 0 ? 45 : -45, x.y() < 0 ? 35 : -35, 0);
  const PolygonSurface one = rectangle_polygons(points, rectangle), other = rectangle_polygons(moved, rectangle);
  for (std::size_t p = 0; p < points.size(); ++p) {
    EXPECT_EQ(one.polygons[p].size(), other.polygons[p].size());
    EXPECT_NEAR(polygon_areas(one)[p], polygon_areas(other)[p], 1e-9);
  }
}

TEST(RectanglePolygons, SayWhatIsWrong) {
  expect_mesh_error([] { rectangle_polygons({{0, 0, 0}, {0, 0, 0}}, {{10, 10}}); }, "points 0 and 1 coincide");
  const Rectangle narrow{{10, 100}, {true, false}};
  expect_mesh_error(
      [&] { rectangle_polygons(even_points(narrow, 20, 1), narrow); },
      "would meet itself, or another cell twice, across the period; lengthen the period, or give more cells");
}

StarSurface ball_of(double radius) { return {Mat3::Identity(), Vec3::Constant(radius), {1.0}}; }

ExtrudedSheet extrude_on(const PolygonSurface& polygons, const StarSurface& surface,
                         std::span<const double> heights_um) {
  return extrude(polygons, vertex_bends(polygons, surface), heights_um);
}

PolygonSurface cells_on(const StarSurface& surface, std::size_t count) {
  return polygons_of_points(even_points(surface, count, 1), surface).surface;
}

TEST(PrismSheet, OnASphereHasTheVolumeOfTheShell) {
  const StarSurface ball = ball_of(100);
  const ExtrudedSheet sheet = extrude_on(cells_on(ball, 2000), ball, std::array{30.0});
  EXPECT_EQ(sheet.lower_cells, 0);
  EXPECT_NEAR(sheet.lowest_um, 30, 1e-9);
  for (std::size_t v = 0; v < sheet.apical.size(); ++v) {
    EXPECT_NEAR(sheet.basal[v].norm(), 70, 1e-9);
    EXPECT_LT((sheet.basal[v] - 0.7 * sheet.apical[v]).norm(), 1e-9);
  }
  const std::vector<double> volumes = prism_volumes(sheet);
  const double shell = 4 * std::numbers::pi / 3 * (1e6 - 343e3);
  // Flat faces lie a little below the spheres.
  EXPECT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0) / shell, 1 - 1.3e-3, 1e-3);
  const std::vector<double> apical = polygon_areas({sheet.apical, sheet.cells}),
                            basal = polygon_areas({sheet.basal, sheet.cells});
  for (std::size_t i = 0; i < apical.size(); ++i) EXPECT_NEAR(basal[i] / apical[i], 0.49, 1e-9);
}

TEST(PrismSheet, OfACubeHasItsVolume) {
  PrismSheet sheet;
  sheet.apical = {{0, 0, 3}, {2, 0, 3}, {2, 2, 3}, {0, 2, 3}};
  sheet.basal = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  sheet.cells = {{0, 1, 2, 3}};
  EXPECT_NEAR(prism_volumes(sheet)[0], 12, 1e-12);
  EXPECT_NEAR(prism_heights(sheet)[0], 3, 1e-12);
}

TEST(PrismSheet, IsLowerWhereTheSurfaceBendsSharply) {
  const StarSurface egg = egg_surface({500, 180, 180, {}, {}});  // least radius 32 um, at the poles
  const PolygonSurface polygons = cells_on(egg, 1500);
  const ExtrudedSheet sheet = extrude_on(polygons, egg, std::array{35.0});
  EXPECT_GT(sheet.lower_cells, 10);
  EXPECT_LT(sheet.lower_cells, polygons.polygons.size() / 4);
  EXPECT_LT(sheet.lowest_um, 25);
  EXPECT_GT(sheet.lowest_um, 15);
  for (std::size_t v = 0; v < sheet.apical.size(); ++v) {
    const double height = (sheet.apical[v] - sheet.basal[v]).norm(), radius = egg.bend(sheet.apical[v]).radii[0];
    EXPECT_LT(height, largest_height_share * radius);
    if (radius > 77) {
      EXPECT_NEAR(height, 35, 1e-9);
    }
  }
  // Nothing is turned inside out, however high.
  for (const double volume : prism_volumes(extrude_on(polygons, egg, std::array{500.0}))) EXPECT_GT(volume, 0);
}

TEST(PrismSheet, TakesAHeightACell) {
  const StarSurface ball = ball_of(100);
  const PolygonSurface polygons = cells_on(ball, 200);
  std::vector<double> heights(200, 20.0);
  heights[50] = 26;
  const ExtrudedSheet sheet = extrude_on(polygons, ball, heights);
  for (std::size_t k = 0; k < polygons.polygons[50].size(); ++k) {
    const std::size_t vertex = polygons.polygons[50][k];
    EXPECT_NEAR((sheet.apical[vertex] - sheet.basal[vertex]).norm(), 22, 1e-9);  // (26 + 20 + 20) / 3
  }
  EXPECT_NEAR(prism_heights(sheet)[50], 22, 1e-9);
}

TEST(PrismSheet, RefusesHeightsThatDoNotFit) {
  const StarSurface ball = ball_of(100);
  const PolygonSurface polygons = cells_on(ball, 50);
  expect_mesh_error([&] { extrude_on(polygons, ball, std::vector<double>(49, 20.0)); }, "49 heights for 50 cells");
  std::vector<double> heights(50, 20.0);
  heights[13] = 0;
  expect_mesh_error([&] { extrude_on(polygons, ball, heights); }, "row 13");
}

}  // namespace
