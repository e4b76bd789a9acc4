#include "tissue/shapes/even_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "support/mesh_error.hpp"
#include "tissue/shapes/egg_surface.hpp"
#include "tissue/shapes/surface_polygons.hpp"

namespace plica {
namespace {

TEST(EvenPoints, MakeCellsOfOneSizeThatAreNoCrystal) {
  const StarSurface egg = egg_surface({500, 180, 180, 17, 7});
  int cases = 0;
  for (const std::size_t count : {200, 2000})
    for (const std::uint64_t seed : {1, 2}) {
      const Vectors points = even_points(egg, count, seed);
      ASSERT_EQ(points.size(), count);
      const CellPolygons cells = polygons_of_points(points, egg);
      const std::vector<double> areas = polygon_areas(cells.surface);
      const double mean = std::accumulate(areas.begin(), areas.end(), 0.0) / static_cast<double>(count);
      double squares = 0;
      for (const double area : areas) squares += (area - mean) * (area - mean);
      EXPECT_LT(std::sqrt(squares / static_cast<double>(count)) / mean, 0.12);
      EXPECT_NEAR(mean * static_cast<double>(count), egg.area(), (count == 200 ? 0.02 : 0.002) * egg.area());
      const double hexagons = static_cast<double>(corner_counts(cells.surface)[6]) / static_cast<double>(count);
      EXPECT_GT(hexagons, 0.6);
      EXPECT_LT(hexagons, 0.8);
      const std::vector<double> lengths = edge_lengths(cells.surface);
      EXPECT_GT(*std::ranges::min_element(lengths) / std::accumulate(lengths.begin(), lengths.end(), 0.0) *
                    static_cast<double>(lengths.size()),
                0.149);
      ++cases;
    }
  EXPECT_EQ(cases, 4);
}

TEST(EvenPoints, FollowTheirSeed) {
  const StarSurface ball(Mat3::Identity(), Vec3(100, 100, 100), {1.0});
  EXPECT_EQ(even_points(ball, 100, 5), even_points(ball, 100, 5));
  EXPECT_NE(even_points(ball, 100, 5), even_points(ball, 100, 6));
}

TEST(EvenPoints, CanBeFew) {
  const StarSurface egg = egg_surface({500, 180, 180, {}, {}});
  int cases = 0;
  for (const std::size_t count : {12, 13, 20, 50})
    for (std::uint64_t seed = 0; seed < 10; ++seed, ++cases)
      EXPECT_EQ(polygons_of_points(even_points(egg, count, seed), egg).surface.polygons.size(), count);
  EXPECT_EQ(cases, 40);
  expect_mesh_error([&] { even_points(egg, 11, 1); }, "11 points");
}

}  // namespace
}  // namespace plica
