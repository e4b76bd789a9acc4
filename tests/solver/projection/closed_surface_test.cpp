#include "solver/projection/closed_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mechanics/constraints/cell_volume.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

using namespace support;

std::vector<ClosedSurface::Quad> facets_of(const Tissue& tissue) {
  std::vector<ClosedSurface::Quad> facets;
  for (const auto& element : tissue.elements)
    for (const auto& f : hex_faces) facets.push_back({element[f[0]], element[f[1]], element[f[2]], element[f[3]]});
  return facets;
}

double volume(const ClosedSurface& surface, const Vectors& positions) {
  Vectors points, gradient;
  surface.gather(positions, points);
  surface.gradient(points, gradient);
  return dot(points, gradient) / 3;
}

/// The multiplier that scales a body whose gradient is radial back to `target`, and the volume there.
std::pair<double, double> scaled_back(const ClosedSurface& surface, Vectors positions, double target) {
  Vectors points, gradient, scratch;
  surface.gather(positions, points);
  surface.gradient(points, gradient);
  Cubic cubic = surface.volume_along(points, gradient, gradient, scratch);
  cubic.c0 -= target;
  const double l = root_nearest_zero(cubic).value();
  for (std::size_t i = 0; i < surface.nodes().size(); ++i) positions[surface.nodes()[i].index()] += l * gradient[i];
  return {l, volume(surface, positions)};
}

TEST(ClosedSurface, VolumeAndGradientAreTheHexahedrons) {
  const Tissue cell =
      distorted_block({.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}}, 4, 1);
  const ClosedSurface surface(facets_of(cell));
  const HexPoints points = gather(cell.rest_positions, cell.elements[0]);
  EXPECT_NEAR(volume(surface, cell.rest_positions), hex_volume(points), 1e-12 * hex_volume(points));
  Vectors local, gradient;
  surface.gather(cell.rest_positions, local);
  surface.gradient(local, gradient);
  const auto expected = hex_volume_gradient(points);
  for (int i = 0; i < 8; ++i)
    for (std::size_t k = 0; k < 8; ++k)
      if (surface.nodes()[k] == cell.elements[0][i]) {
        EXPECT_LE((gradient[k] - expected[i]).norm(), 1e-10);
      }
}

TEST(ClosedSurface, SharedFacetsCancel) {
  const Tissue block =
      distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 40, .cells = {3, 2, 2}}, 2, 1);
  const ClosedSurface surface(facets_of(block));
  double sum = 0;
  const CellVolumes volumes(block);
  for (const double of_cell : volumes.targets()) sum += of_cell;
  EXPECT_NEAR(volume(surface, block.rest_positions), sum, 1e-12 * sum);
  EXPECT_EQ(surface.nodes().size(), 36u - 2u);  // two nodes lie inside
}

TEST(ClosedSurface, VolumeAlongADirectionIsAnExactCubic) {
  const Tissue block =
      distorted_block({.length_um = 40, .width_um = 40, .cell_height_um = 40, .cells = {2, 2, 1}}, 3, 2);
  const ClosedSurface surface(facets_of(block));
  Random random(3);
  Vectors points, gradient, scratch;
  surface.gather(block.rest_positions, points);
  surface.gradient(points, gradient);
  int cases = 0;
  for (int k = 0; k < 5; ++k) {
    const Vectors direction = random.vectors(surface.nodes().size(), 10);
    const Cubic cubic = surface.volume_along(points, gradient, direction, scratch);
    for (const double l : {-2.0, -0.1, 0.5, 3.0}) {
      Vectors moved = block.rest_positions;
      for (std::size_t i = 0; i < direction.size(); ++i) moved[surface.nodes()[i].index()] += l * direction[i];
      const double expected = volume(surface, moved);
      EXPECT_NEAR(cubic.at(l), expected, 1e-10 * (std::abs(expected) + 1e5));
      ++cases;
    }
  }
  EXPECT_EQ(cases, 20);
}

// An octahedron of radius R has gradients radial at its 6 corners: dV/dx = a x, a = 3V/(6 R^2) = 2R/3, so V(l) =
// V (1 + a l)^3 and l = ((V0/V)^(1/3) - 1)/a.
TEST(ClosedSurface, OctahedronIsScaledBack) {
  for (const double radius : {1.0, 25.0}) {
    Vectors corners;
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) corners.emplace_back(sign * radius * Vec3::Unit(axis));
    std::vector<ClosedSurface::Quad> facets;
    for (int x : {0, 1})
      for (int y : {2, 3})
        for (int z : {4, 5}) {
          const bool outward = (x + y + z) % 2 == 0;
          facets.push_back(outward ? ClosedSurface::Quad{NodeId(x), NodeId(y), NodeId(z), NodeId(z)}
                                   : ClosedSurface::Quad{NodeId(y), NodeId(x), NodeId(z), NodeId(z)});
        }
    const ClosedSurface octahedron(facets);
    const double V = volume(octahedron, corners), V0 = 0.7 * V, a = 3 * V / (6 * radius * radius);
    EXPECT_NEAR(V, 4 * std::pow(radius, 3) / 3, 1e-12 * V);
    EXPECT_NEAR(a, 2 * radius / 3, 1e-12 * a);
    const auto [l, reached] = scaled_back(octahedron, corners, V0);
    EXPECT_NEAR(l, (std::cbrt(V0 / V) - 1) / a, 1e-13 / a);
    EXPECT_NEAR(reached, V0, 1e-12 * V0);
  }
}

// The same with a cube of side s: 8 corners at s sqrt(3)/2, a = s/2.
TEST(ClosedSurface, CubeIsScaledBack) {
  const double side = 20, V0 = 9000;
  const Tissue cube = build_block({.length_um = side, .width_um = side, .cell_height_um = side, .cells = {1, 1, 1}});
  const auto [l, reached] = scaled_back(ClosedSurface(facets_of(cube)), cube.rest_positions, V0);
  EXPECT_NEAR(l, (std::cbrt(V0 / 8000) - 1) / (side / 2), 1e-15);
  EXPECT_NEAR(reached, V0, 1e-9);
}

// Each pair of a brick's faces moves apart on its own: V(l) = V (1 + l A/2)(1 + l B/2)(1 + l C/2) with A = bc/a and so
// on. The paper calls the real root unique. For a brick a x a x h it is as long as h < 2a; the cells are 20 x 20 x 40.
TEST(ClosedSurface, TallBricksHaveThreeRealRoots) {
  int cases = 0;
  for (const auto& [height, three] : {std::pair{20.0, false}, {39.9, false}, {40.1, true}, {60.0, true}}) {
    const double a = 20;
    const Tissue brick = build_block({.length_um = a, .width_um = a, .cell_height_um = height, .cells = {1, 1, 1}});
    const ClosedSurface surface(facets_of(brick));
    Vectors points, gradient, scratch;
    surface.gather(brick.rest_positions, points);
    surface.gradient(points, gradient);
    Cubic cubic = surface.volume_along(points, gradient, gradient, scratch);
    for (const double l : {-0.01, 0.02, 0.3}) {
      const double expected = (a + l * a * height / 2) * (a + l * a * height / 2) * (height + l * a * a / 2);
      EXPECT_NEAR(cubic.at(l), expected, 1e-11 * expected);
    }
    cubic.c0 -= a * a * height * (1 + 1e-7);
    EXPECT_EQ(has_three_real_roots(cubic), three) << height;
    ++cases;
  }
  EXPECT_EQ(cases, 4);
}

}  // namespace
}  // namespace plica
