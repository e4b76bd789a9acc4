#include "show/boundary_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/errors.hpp"

namespace plica {
namespace {

// `count` cubes of 10 um in a row along x, each of two elements one above the other where `layers` is 2.
Frame row_of_cubes(int count, int layers) {
  Frame frame;
  const auto node = [&](int i, int j, int k) { return NodeId(i + (count + 1) * (j + 2 * k)); };
  for (int k = 0; k <= layers; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i <= count; ++i) frame.positions.emplace_back(10.0 * i, 10.0 * j, 10.0 * k / layers);
  for (int k = 0; k < layers; ++k)
    for (int i = 0; i < count; ++i) {
      frame.elements.push_back({node(i, 0, k), node(i + 1, 0, k), node(i + 1, 1, k), node(i, 1, k), node(i, 0, k + 1),
                                node(i + 1, 0, k + 1), node(i + 1, 1, k + 1), node(i, 1, k + 1)});
      frame.element_scalars["cell_id"].push_back(i);
    }
  return frame;
}

TEST(BoundarySurface, OutlinesPartCellsAndNotTheElementsOfOne) {
  const BoundarySurface coarse = boundary_surface_of(row_of_cubes(3, 1)),
                        fine = boundary_surface_of(row_of_cubes(3, 2));
  EXPECT_EQ(coarse.facets.size(), 14u);
  EXPECT_EQ(coarse.outlines.size(), 28u);  // every edge of three cubes
  EXPECT_EQ(fine.facets.size(), 6u + 2 * 8u);
  // Upright edges are of two pieces now; edges between the layers lie within a cell's side and are not drawn.
  EXPECT_EQ(fine.outlines.size(), 28u + 8u);
  EXPECT_EQ(std::ranges::count(coarse.facets, 5, &BoundaryFacet::face), 3);
  EXPECT_EQ(std::ranges::count(coarse.facets, 4, &BoundaryFacet::face), 3);
}

TEST(BoundarySurface, FacetsLookOutward) {
  const Frame frame = row_of_cubes(2, 1);
  Vec3 sum = Vec3::Zero();
  double volume = 0;
  for (const BoundaryFacet& facet : boundary_surface_of(frame).facets) {
    const auto at = [&](int i) { return frame.positions[facet.nodes[i].index()]; };
    const Vec3 area = (at(2) - at(0)).cross(at(3) - at(1)) / 2;
    sum += area;
    volume += area.dot(at(0) + at(2)) / 6;
  }
  EXPECT_NEAR(sum.norm(), 0, 1e-12);
  EXPECT_NEAR(volume, 2000, 1e-9);
}

TEST(BoundarySurface, RefusesAFrameWithoutCells) {
  Frame frame = row_of_cubes(1, 1);
  frame.element_scalars.clear();
  EXPECT_THROW(boundary_surface_of(frame), FileError);
}

TEST(CutByPlane, CutsASquareOutOfACube) {
  const Frame frame = row_of_cubes(3, 1);
  const auto polygons = cut_by_plane(frame, 0, 12.5);
  ASSERT_EQ(polygons.size(), 1u);
  EXPECT_EQ(polygons[0].element, 1u);
  ASSERT_EQ(polygons[0].corners.size(), 4u);
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto place = [&](const CutPolygon::Corner& corner) -> Vec3 {
      return (1 - corner.part) * frame.positions[corner.first.index()] +
             corner.part * frame.positions[corner.second.index()];
    };
    const Vec3 a = place(polygons[0].corners[i]), b = place(polygons[0].corners[(i + 1) % 4]);
    EXPECT_DOUBLE_EQ(a.x(), 12.5);
    area += a.cross(b).x() / 2;
  }
  EXPECT_NEAR(area, 100, 1e-9);
  EXPECT_EQ(cut_by_plane(frame, 1, 5).size(), 3u);
  EXPECT_TRUE(cut_by_plane(frame, 2, 50).empty());
}

}  // namespace
}  // namespace plica
