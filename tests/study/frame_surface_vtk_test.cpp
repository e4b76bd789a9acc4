#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "study/frame_surface.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

using namespace support;

Frame frame_of(const Tissue& tissue) {
  Frame frame;
  frame.positions = tissue.rest_positions;
  frame.elements = tissue.elements;
  return frame;
}

Frame block(std::array<int, 3> elements_per_cell = {1, 1, 1}) {
  return frame_of(build_block({.length_um = 60,
                               .width_um = 40,
                               .cell_height_um = 40,
                               .cells = {3, 2, 1},
                               .elements_per_cell = elements_per_cell}));
}

Frame shifted(Frame frame, const Vec3& by) {
  for (Vec3& x : frame.positions) x += by;
  return frame;
}

Distances between(const Frame& a, const Frame& b) {
  return distances_to(SurfaceDistance(fine_triangles(b, apical_facets(b))), a, apical_facets(a));
}

TEST(FrameSurface, FacetsAreThoseOfTheOutermostElements) {
  for (const int layers : {1, 2}) {
    const Frame frame = block({2, 1, layers});
    EXPECT_EQ(apical_facets(frame).size(), 12U);
    EXPECT_EQ(basal_facets(frame).size(), 12U);
    EXPECT_NEAR(total_area(frame, apical_facets(frame)), 2400, 1e-9);
    double highest = -1e300;
    for (const Vec3& x : frame.positions) highest = std::max(highest, x.z());
    for (const auto& facet : apical_facets(frame))
      for (const NodeId node : facet) EXPECT_EQ(frame.positions[node.index()].z(), highest);
  }
}

TEST(FrameSurface, TrianglesCoverFlatFacetsAndStayNearTwistedOnes) {
  const Frame flat = block();
  const TriangleSurface triangles = fine_triangles(flat, apical_facets(flat));
  EXPECT_EQ(triangles.triangles.size(), 6U * 256);
  double area = 0;
  for (const auto& [a, b, c] : triangles.triangles)
    area += (triangles.points[b] - triangles.points[a]).cross(triangles.points[c] - triangles.points[a]).norm() / 2;
  EXPECT_NEAR(area, 2400, 1e-9);
  EXPECT_EQ(facet_error(flat, apical_facets(flat)), 0);

  // One facet with a corner lifted by 16 um: z = 16 u v.
  Frame twisted = frame_of(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}}));
  const auto facet = apical_facets(twisted).at(0);
  twisted.positions[facet[2].index()].z() += 16;
  EXPECT_NEAR(facet_error(twisted, apical_facets(twisted)), 16.0 / 1024, 1e-12);
  const SurfaceDistance distance(fine_triangles(twisted, apical_facets(twisted)));
  const Vec3 origin = twisted.positions[facet[0].index()];
  const Vec3 u = twisted.positions[facet[1].index()] - origin, v = twisted.positions[facet[3].index()] - origin;
  double farthest = 0;
  for (int i = 0; i <= 64; ++i)
    for (int j = 0; j <= 64; ++j) {
      const double s = i / 64.0, t = j / 64.0;
      farthest = std::max(farthest, distance.from(origin + s * u + t * v + Vec3(0, 0, 16 * s * t)));
    }
  EXPECT_LE(farthest, 16.0 / 1024);
  EXPECT_GE(farthest, 0.3 * 16 / 1024) << "the bound is not idle";
}

TEST(FrameSurface, OfItselfAndOfAShiftedSurface) {
  const Frame frame = frame_of(distorted_block({60, 40, 40, {3, 2, 1}, {1, 1, 1}}, 3, 5));
  EXPECT_LE(between(frame, frame).max, 1e-12);
  const Frame flat = block();
  const Distances up = between(flat, shifted(flat, {0, 0, 5}));
  for (const double value : {up.mean, up.rms, up.max}) EXPECT_NEAR(value, 5, 1e-12);
  // Along x, only the strip of 6 of 60 um that sticks out lies away, by 0 to 6 um; the last facet has 4 samples in x,
  // at 2.5, 7.5, ... um from its end: one of 12 columns, 3.5 um away.
  const Distances along = between(flat, shifted(flat, {6, 0, 0}));
  EXPECT_NEAR(along.max, 6, 1e-12);
  EXPECT_NEAR(along.mean, 3.5 / 12, 1e-12);
  EXPECT_NEAR(along.rms, 3.5 / std::sqrt(12.0), 1e-12);
}

// A plane against a wave of height 1 um over it: mean 2/pi, root mean square 1/sqrt(2), one side nearly as the other.
TEST(FrameSurface, OfDifferentMeshes) {
  const Frame coarse = block();
  Frame wave = block({20, 1, 1});
  for (const auto& facet : apical_facets(wave))
    for (const NodeId node : facet) {
      Vec3& x = wave.positions[node.index()];
      x.z() = coarse.positions[apical_facets(coarse)[0][0].index()].z() + std::sin(2 * std::numbers::pi * x.x() / 60);
    }
  const Distances distances = between(wave, coarse);
  EXPECT_NEAR(distances.mean, 2 / std::numbers::pi, 0.01);
  EXPECT_NEAR(distances.rms, 1 / std::sqrt(2.0), 0.01);
  EXPECT_NEAR(distances.max, 1, 0.01);
  EXPECT_NEAR(between(coarse, wave).mean, 2 / std::numbers::pi, 0.01);
}

TEST(FrameSurface, NodesLieAwayFromTheirOwnSide) {
  const Frame frame = block({1, 1, 2});
  Frame other = frame;
  double middle = 0;
  for (const Vec3& x : frame.positions) middle += x.z() / static_cast<double>(frame.positions.size());
  for (Vec3& x : other.positions) x.z() += x.z() > middle + 1 ? 6 : 2;
  const std::vector<double> distances = node_distances(frame, other);
  int inner = 0;
  for (std::size_t n = 0; n < distances.size(); ++n) {
    const double height = frame.positions[n].z() - middle;
    if (std::abs(height) < 1) ++inner;
    EXPECT_NEAR(distances[n], height > 1 ? 6 : height < -1 ? 2 : 4, 1e-12) << "between them, the mean";
  }
  EXPECT_EQ(inner, 12);
}

}  // namespace
}  // namespace plica
