#include "measure/surface_distance.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

/// Distance to a triangle the long way: to its plane where the foot lies inside, else to its edges.
double to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const auto inside = [&](const Vec3& from, const Vec3& to) { return normal.cross(to - from).dot(p - from) >= 0; };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(normal.dot(p - a));
  const auto to_edge = [&](const Vec3& from, const Vec3& to) {
    const double part = std::clamp((p - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
    return (p - from - part * (to - from)).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

TEST(SurfaceDistance, IsThatOfTheNearestTriangle) {
  Random random(11);
  TriangleSurface surface;
  surface.points = random.vectors(300, 100);
  for (int t = 0; t < 100; ++t) surface.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  const SurfaceDistance distance(surface);
  for (const double size : {50.0, 150.0, 1000.0})  // among, beside and far from them
    for (int i = 0; i < 300; ++i) {
      const Vec3 point = random.vector(size);
      double nearest = 1e300;
      for (const auto& [a, b, c] : surface.triangles)
        nearest = std::min(nearest, to_triangle(point, surface.points[a], surface.points[b], surface.points[c]));
      ASSERT_NEAR(distance.from(point), nearest, 1e-9) << point.transpose();
    }
  for (const Vec3& point : surface.points) EXPECT_LE(distance.from(point), 1e-12);
}

TEST(SurfaceDistance, ToASingleFlatTriangle) {
  const SurfaceDistance distance({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  EXPECT_NEAR(distance.from({0.2, 0.2, 3}), 3, 1e-12);
  EXPECT_NEAR(distance.from({0.2, 0.2, -3}), 3, 1e-12);
  EXPECT_NEAR(distance.from({4, 0, 4}), 5, 1e-12);
}

// Else a child process that starts meanwhile may wait for a lock that only its parent's thread could open. (Threads
// that tests before this one have started are counted too; the suite runs each test in a process of its own.)
TEST(SurfaceDistance, StartsNoThreads) {
  const auto threads = [] {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return std::distance(begin(tasks), end(tasks));
  };
  const auto before = threads();
  Random random(12);
  TriangleSurface surface;
  surface.points = random.vectors(3000, 100);
  for (int t = 0; t < 1000; ++t) surface.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  EXPECT_GT(SurfaceDistance(surface).from({1000, 0, 0}), 0);
  EXPECT_EQ(threads(), before);
}

}  // namespace
}  // namespace plica
