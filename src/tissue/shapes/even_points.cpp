#include "tissue/shapes/even_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/shapes/surface_polygons.hpp"

namespace plica {
namespace {

// As many as bring the areas' variation to 8 % from a random start; more would make a crystal of it.
constexpr int rounds = 35;
constexpr double overrelaxation = 1.5;  // of Lloyd's move; he converges slowly on long waves

// A number in [0, 1), the same with every standard library.
double next_number(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// Few points are chosen among several candidates each, the furthest from those before: purely random ones may leave
// half of the surface bare.
constexpr std::size_t few_points = 500;
constexpr int candidates_of_few = 10;

// Random places, as many everywhere by area: rejection by the area of the surface over that of the unit sphere.
Vectors random_points(const StarSurface& surface, std::size_t count, std::uint64_t seed) {
  double largest = 0;
  for (const Vec3& direction : even_directions(2000)) largest = std::max(largest, surface.area_over(direction));
  largest *= 1.05;
  std::mt19937_64 random(seed);
  const auto next_point = [&] {
    while (true) {
      const double z = 2 * next_number(random) - 1, angle = 2 * std::numbers::pi * next_number(random);
      const double r = std::sqrt(1 - z * z);
      const Vec3 direction(r * std::cos(angle), r * std::sin(angle), z);
      if (next_number(random) * largest < surface.area_over(direction)) return surface.in_direction(direction);
    }
  };
  Vectors points;
  while (points.size() < count) {
    Vec3 best = next_point();
    double furthest = -1;
    for (int k = 0; count < few_points && k < candidates_of_few; ++k) {
      const Vec3 candidate = next_point();
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec3& point : points) nearest = std::min(nearest, (point - candidate).squaredNorm());
      if (nearest <= furthest) continue;
      furthest = nearest;
      best = candidate;
    }
    points.push_back(best);
  }
  return points;
}

}  // namespace

Vectors even_points(const StarSurface& surface, std::size_t count, std::uint64_t seed) {
  if (count < 12) throw MeshError(fmt::format("{} points; a closed sheet requires at least 12 cells", count));
  Vectors points = random_points(surface, count, seed);
  // Cells that are neighbours should be near each other in memory, too.
  std::ranges::sort(points, {}, [](const Vec3& p) { return p.x(); });
  SurfaceTriangulation triangulation = hull_triangulation(points, surface);
  for (int round = 0; round < rounds; ++round) {
    flip_to_delaunay(points, triangulation);
    const PolygonSurface cells = dual_polygons(points, triangulation, surface);
    // Not further than the middle at first, while cells change their neighbours.
    const double share = round < 5 ? 1 : overrelaxation;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 middle = fan_about(cells.vertices, cells.polygons[i], points[i]).centroid;
      points[i] = surface.put_on(points[i] + share * (middle - points[i]));
    }
    // The old neighbours are a start for the new ones, unless a triangle has turned over.
    if (!looks_outward(points, triangulation)) triangulation = hull_triangulation(points, surface);
  }
  return points;
}

}  // namespace plica
