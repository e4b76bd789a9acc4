#include "tissue/shapes/polygon_surface.hpp"

#include <gtest/gtest.h>

#include "support/mesh_error.hpp"

namespace plica {
namespace {

// A cube of side 2 about the origin.
PolygonSurface cube() {
  PolygonSurface surface;
  for (int k = 0; k < 8; ++k) surface.vertices.emplace_back(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
  surface.polygons = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return surface;
}

TEST(PolygonSurface, KnowsACube) {
  const PolygonSurface surface = cube();
  for (const double area : polygon_areas(surface)) EXPECT_DOUBLE_EQ(area, 4);
  const std::vector<double> lengths = edge_lengths(surface);
  EXPECT_EQ(lengths.size(), 12);
  for (const double length : lengths) EXPECT_DOUBLE_EQ(length, 2);
  EXPECT_EQ(corner_counts(surface), (std::vector<std::size_t>{0, 0, 0, 0, 6}));
  // Outward: the vector of a face is 4 along its middle.
  for (const auto& polygon : surface.polygons) {
    Vec3 middle = Vec3::Zero();
    for (const std::size_t vertex : polygon) middle += surface.vertices[vertex] / 4;
    EXPECT_LT((area_vector(surface.vertices, polygon) - 4 * middle).norm(), 1e-14);
  }
}

TEST(PolygonSurface, NeighboursAreMutualAndShareTheEdge) {
  const PolygonSurface surface = cube();
  const auto neighbours = polygon_neighbours(surface);
  EXPECT_EQ(neighbours[0], (std::vector<std::size_t>{4, 3, 5, 2}));
  for (const PolygonEdge& edge : polygon_edges(surface)) EXPECT_NE(edge.right, no_polygon);
}

TEST(PolygonSurface, HasARimWhereAPolygonIsMissing) {
  PolygonSurface surface = cube();
  surface.polygons.pop_back();
  const auto edges = polygon_edges(surface);
  EXPECT_EQ(edges.size(), 12);
  EXPECT_EQ(std::ranges::count(edges, no_polygon, &PolygonEdge::right), 4);
}

TEST(PolygonSurface, RefusesPolygonsThatDoNotFitTogether) {
  PolygonSurface surface = cube();
  std::ranges::reverse(surface.polygons[2]);
  expect_mesh_error([&] { polygon_edges(surface); }, "runs the same way in two cells");
  surface = cube();
  surface.polygons.push_back({1, 0, 6});
  expect_mesh_error([&] { polygon_edges(surface); }, "belongs to more than two cells");
}

TEST(PolygonSurface, AFanHasTheMiddleOfAnUnevenPolygon) {
  // An L-like trapezium in the plane z = 0 with corners (0,0), (4,0), (2,2), (0,2): area 6, centroid by hand.
  const Vectors vertices = {{0, 0, 0}, {4, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  const PolygonFan fan = fan_about(vertices, {0, 1, 2, 3}, Vec3(1, 1, 0));
  EXPECT_DOUBLE_EQ(fan.area, 6);
  EXPECT_LT((fan.centroid - Vec3(14.0 / 9, 8.0 / 9, 0)).norm(), 1e-14);
}

}  // namespace
}  // namespace plica
