// Polygons about points in a rectangle, which may repeat itself.
#include "tissue/shapes/rectangle_polygons.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>

#include "support/mesh_error.hpp"

namespace plica {
namespace {

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
  int cases = 0;
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
      ++cases;
    }
  std::printf("%d patterns\n", cases);
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

}  // namespace
}  // namespace plica
