// Normals and bending of a surface of polygons.
#include "tissue/shapes/vertex_bends.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/prisms.hpp"
#include "tissue/shapes/even_points.hpp"
#include "tissue/shapes/surface_polygons.hpp"

namespace plica {
namespace {

TEST(VertexBends, OnASphere) {
  const StarSurface ball{Mat3::Identity(), Vec3::Constant(100), {1.0}};
  const PolygonSurface polygons = polygons_of_points(even_points(ball, 2000, 1), ball).surface;
  const std::vector<VertexBend> alone = vertex_bends(polygons), smooth = vertex_bends(polygons, ball);
  for (std::size_t v = 0; v < alone.size(); ++v) {
    EXPECT_NEAR(smooth[v].least_radius_um, 100, 1e-9);
    EXPECT_NEAR(alone[v].least_radius_um, 100, 3);
    EXPECT_GT(alone[v].normal.dot(smooth[v].normal), 0.999);
  }
}

// Outward and inward about a cylinder of 60 um.
TEST(VertexBends, OnACylinderAndInAPipe) {
  for (const bool outward : {true, false}) {
    const double radius = outward ? 60 : -60;
    const PrismSheet sheet = support::bent(support::honeycomb(8, 8, 4, 1), [&](const Vec3& x) {
      return Vec3(x.x(), (radius + x.z()) * std::sin(x.y() / radius), (radius + x.z()) * std::cos(x.y() / radius));
    });
    const std::vector<VertexBend> bends = vertex_bends({sheet.apical, sheet.cells});
    for (std::size_t v = 0; v < bends.size(); ++v) {
      const Vec3 normal = Vec3(0, sheet.apical[v].y(), sheet.apical[v].z()) / radius;
      EXPECT_GT(bends[v].normal.dot(normal), 0.98) << v;
      if (bends[v].normal.dot(normal) < 0.9995) continue;  // at the rim
      if (outward)
        EXPECT_NEAR(bends[v].least_radius_um, 60, 6) << v;
      else
        EXPECT_GT(bends[v].least_radius_um, 600) << v;
    }
  }
}

// A corner of one hexagon has five others, all on one circle with it: they do not say how it bends, and a nanometre
// there is no curvature.
TEST(VertexBends, AtTheRimOfADome) {
  PrismSheet sheet = support::bent(support::honeycomb(12, 12, 4.6, 1), [](const Vec3& x) {
    return Vec3(x.x(), x.y(), -(x.x() * x.x() + x.y() * x.y()) / 600);
  });
  support::Random random(1);
  for (Vec3& x : sheet.apical) x.z() += 1e-3 * random.number();
  for (const VertexBend& bend : vertex_bends({sheet.apical, sheet.cells})) EXPECT_GT(bend.least_radius_um, 150);
}

TEST(VertexBends, OfAFlatPatch) {
  const PrismSheet sheet = support::irregular_polygons(6, 5, 4, 1, 0.2, 1);
  for (const VertexBend& bend : vertex_bends({sheet.apical, sheet.cells})) {
    EXPECT_NEAR(bend.normal.z(), 1, 1e-12);
    EXPECT_TRUE(std::isinf(bend.least_radius_um));
  }
}

}  // namespace
}  // namespace plica
