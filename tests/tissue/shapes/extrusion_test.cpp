#include "tissue/shapes/extrusion.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "support/mesh_error.hpp"
#include "tissue/shapes/egg_surface.hpp"
#include "tissue/shapes/even_points.hpp"
#include "tissue/shapes/surface_polygons.hpp"

namespace plica {
namespace {

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
}  // namespace plica
