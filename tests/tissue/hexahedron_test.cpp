// Hexahedra, quality of their meshes, and shapes around them.
#include "tissue/hexahedron.hpp"

#include "support/tissues.hpp"
#include "tissue/mesh_quality.hpp"
#include "tissue/outer_shape.hpp"
#include "tissue/shapes/embryo.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace {

/// A brick of 20 x 20 x 40 um with every corner moved at random: hexahedra with warped faces.
HexPoints warped(Random& random, double size_um = 6) {
  HexPoints points;
  for (int i = 0; i < 8; ++i)
    points[i] = hex_reference_nodes[i].cwiseProduct(Vec3(10, 10, 20)) + random.vector(size_um);
  return points;
}

TEST(Hexahedron, ReferenceNodesAreInVtksOrder) {
  const std::array<Vec3, 8> expected = {Vec3(-1, -1, -1), {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                        {-1, -1, 1},      {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  for (int i = 0; i < 8; ++i) EXPECT_EQ(hex_reference_nodes[i], expected[i]);
}

TEST(Hexahedron, EdgesAndFacesAreThoseOfTheCube) {
  for (int e = 0; e < 12; ++e) {
    const Vec3 along = hex_reference_nodes[hex_edges[e][1]] - hex_reference_nodes[hex_edges[e][0]];
    EXPECT_EQ(along, 2 * Vec3::Unit(e / 4)) << "edge " << e;
  }
  for (int f = 0; f < 6; ++f) {
    std::array<Vec3, 4> points;
    for (int i = 0; i < 4; ++i) points[i] = hex_reference_nodes[hex_faces[f][i]];
    const Vec3 outward = (f % 2 == 0 ? -1 : 1) * Vec3::Unit(f / 2);
    EXPECT_LE((facet_area_vector(points) - 4 * outward).norm(), 1e-14) << "face " << f;
  }
}

TEST(Hexahedron, ShapeFunctionsInterpolateAndAddUpToOne) {
  Random random(1);
  for (int i = 0; i < 8; ++i) {
    const auto N = hex_shape(hex_reference_nodes[i]);
    for (int j = 0; j < 8; ++j) EXPECT_EQ(N[j], i == j ? 1 : 0);
  }
  for (int k = 0; k < 10; ++k) {
    const Vec3 at = random.vector();
    double sum = 0;
    Vec3 gradient_sum = Vec3::Zero();
    const auto N = hex_shape(at);
    const auto gradients = hex_shape_gradients(at);
    for (int i = 0; i < 8; ++i) {
      sum += N[i];
      gradient_sum += gradients[i];
      for (int axis = 0; axis < 3; ++axis) {
        const double d = 1e-5;
        const Vec3 step = d * Vec3::Unit(axis);
        EXPECT_NEAR(gradients[i][axis], (hex_shape(at + step)[i] - hex_shape(at - step)[i]) / (2 * d), 1e-10);
      }
    }
    EXPECT_NEAR(sum, 1, 1e-15);
    EXPECT_LE(gradient_sum.norm(), 1e-15);
  }
}

// Four-point Gauss integration of det J, two orders more than its degree needs.
TEST(Hexahedron, VolumeIsTheIntegralOfTheJacobian) {
  const std::array<double, 4> points = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                        0.8611363115940526};
  const std::array<double, 4> weights = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                         0.3478548451374538};
  Random random(2);
  for (int round = 0; round < 50; ++round) {
    const HexPoints x = warped(random);
    double integral = 0;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        for (int k = 0; k < 4; ++k)
          integral += weights[i] * weights[j] * weights[k] *
                      hex_jacobian(x, Vec3(points[i], points[j], points[k])).determinant();
    EXPECT_NEAR(hex_volume(x), integral, 1e-12 * 16000);
  }
}

TEST(Hexahedron, VolumeGradientAgreesWithFiniteDifferencesAndEulersIdentity) {
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    HexPoints x = warped(random);
    const auto gradient = hex_volume_gradient(x);
    double euler = 0;
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 8; ++i) {
      euler += x[i].dot(gradient[i]);
      sum += gradient[i];
      for (int axis = 0; axis < 3; ++axis) {
        // V is linear in each coordinate by itself: the difference is exact at any step.
        const double kept = x[i][axis];
        x[i][axis] = kept + 1;
        const double above = hex_volume(x);
        x[i][axis] = kept - 1;
        const double below = hex_volume(x);
        x[i][axis] = kept;
        EXPECT_NEAR(gradient[i][axis], (above - below) / 2, 1e-9);
      }
    }
    EXPECT_NEAR(euler, 3 * hex_volume(x), 1e-9);
    EXPECT_LE(sum.norm(), 1e-10);
  }
}

TEST(Hexahedron, VolumeHessianAgreesWithDifferencesOfTheGradient) {
  Random random(4);
  for (int k = 0; k < 20; ++k) {
    const HexPoints x = warped(random);
    std::array<Vec3, 8> direction;
    for (Vec3& d : direction) d = random.vector();
    HexPoints above = x, below = x;
    for (int i = 0; i < 8; ++i) {
      above[i] += direction[i];
      below[i] -= direction[i];
    }
    // The gradient is quadratic, so central differences are exact at any step.
    const auto g_above = hex_volume_gradient(above), g_below = hex_volume_gradient(below);
    const auto hessian = hex_volume_hessian(x);
    for (int i = 0; i < 8; ++i) {
      Vec3 product = Vec3::Zero();
      for (int j = 0; j < 8; ++j) {
        product += hessian[i][j].cross(direction[j]);
        EXPECT_LE((hessian[i][j] + hessian[j][i]).norm(), 1e-13);
      }
      EXPECT_LE((product - (g_above[i] - g_below[i]) / 2).norm(), 1e-10);
    }
  }
}

TEST(Hexahedron, ScaledJacobianIsOneForBricksAndNotPositiveWhenACornerFolds) {
  Random random(5);
  HexPoints brick;
  const Mat3 R = random.rotation();
  for (int i = 0; i < 8; ++i) brick[i] = R * hex_reference_nodes[i].cwiseProduct(Vec3(1, 20, 300));
  EXPECT_NEAR(hex_scaled_jacobian(brick), 1, 1e-13);
  HexPoints cube = hex_reference_nodes;
  cube[6] = Vec3(0, 0, -0.5);  // pushed through the diagonal plane of its three neighbours
  EXPECT_LT(hex_scaled_jacobian(cube), 0);
  // A parallelepiped leaning by 60 degrees: sin 30 of the right angle is left.
  HexPoints leaning = hex_reference_nodes;
  for (Vec3& x : leaning) x.x() += std::tan(std::numbers::pi / 3) * x.z();
  EXPECT_NEAR(hex_scaled_jacobian(leaning), 0.5, 1e-13);
}

TEST(Hexahedron, FacetAreaAndItsVector) {
  const std::array<Vec3, 4> square = {Vec3(0, 0, 5), {3, 0, 5}, {3, 2, 5}, {0, 2, 5}};
  EXPECT_NEAR(facet_area(square), 6, 1e-14);
  EXPECT_LE((facet_area_vector(square) - Vec3(0, 0, 6)).norm(), 1e-14);
  // The hyperbolic paraboloid z = h x y on the unit square: its area is the integral of
  // sqrt(1 + h^2 (x^2 + y^2)), here by the midpoint rule, and its area vector depends on the boundary only.
  const double h = 0.5;
  const std::array<Vec3, 4> saddle = {Vec3(0, 0, 0), {1, 0, 0}, {1, 1, h}, {0, 1, 0}};
  double fine = 0;
  const int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = (i + 0.5) / n, y = (j + 0.5) / n;
      fine += std::sqrt(1 + h * h * (x * x + y * y)) / (n * n);
    }
  EXPECT_NEAR(facet_area(saddle), fine, 5e-4);
  EXPECT_LE((facet_area_vector(saddle) - Vec3(-h / 2, -h / 2, 1)).norm(), 1e-14);
}

// A corner is pushed through the opposite face, little by little.
TEST(Hexahedron, IsUprightAsLongAsItsScaledJacobianIsPositive) {
  int upright = 0, cases = 0;
  for (int corner = 0; corner < 8; ++corner)
    for (double part = 0; part <= 1.5; part += 0.05, ++cases) {
      HexPoints points;
      for (int i = 0; i < 8; ++i) points[i] = hex_reference_nodes[i];
      points[corner] *= 1 - 2 * part;
      EXPECT_EQ(hex_is_upright(points), hex_scaled_jacobian(points) > 0) << "corner " << corner << ", " << part;
      upright += hex_is_upright(points);
    }
  EXPECT_GT(upright, 8);
  EXPECT_LT(upright, cases - 8);
  HexPoints broken{};
  broken[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(hex_is_upright(broken));
}

void expect_all(const Spread& spread, double value) {
  EXPECT_NEAR(spread.min, value, 1e-9);
  EXPECT_NEAR(spread.mean, value, 1e-9);
  EXPECT_NEAR(spread.max, value, 1e-9);
}

TEST(MeshQuality, ARegularBlockIsPerfect) {
  for (const std::array<int, 3>& elements : {std::array<int, 3>{1, 1, 1}, {2, 3, 2}}) {
    const Tissue block = build_block(
        {.length_um = 60, .width_um = 30, .cell_height_um = 40, .cells = {3, 2, 1}, .elements_per_cell = elements});
    const MeshQuality quality = mesh_quality(block, block.rest_positions);
    expect_all(quality.volume_um3, 20 * 15 * 40);
    expect_all(quality.apical_area_um2, 20 * 15);
    expect_all(quality.along_um, 20);
    expect_all(quality.across_um, 15);
    expect_all(quality.height_um, 40);
    EXPECT_NEAR(quality.min_scaled_jacobian, 1, 1e-13);
  }
}

TEST(MeshQuality, MeasuresThePositionsItIsGiven) {
  const Tissue block = build_block({.length_um = 40, .width_um = 20, .cell_height_um = 40, .cells = {2, 1, 1}});
  Vectors positions = block.rest_positions;
  for (Vec3& x : positions)
    if (x.x() == 0) x.x() = 5;  // cells of 25 and 15 um
  const MeshQuality quality = mesh_quality(block, positions);
  EXPECT_NEAR(quality.volume_um3.min, 15 * 800, 1e-9);
  EXPECT_NEAR(quality.volume_um3.mean, 20 * 800, 1e-9);
  EXPECT_NEAR(quality.volume_um3.max, 25 * 800, 1e-9);
  EXPECT_NEAR(quality.along_um.min, 15, 1e-12);
  EXPECT_NEAR(quality.along_um.max, 25, 1e-12);
  positions[0] += Vec3(0, 0, 50);
  EXPECT_LT(mesh_quality(block, positions).min_scaled_jacobian, 0);
}

TEST(MeshQuality, OnlySurfaceCellsHaveAnApicalArea) {
  const Tissue block = build_block({.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 3}});
  expect_all(mesh_quality(block, block.rest_positions).apical_area_um2, 400);
}

OuterShape egg(double length_um, double width_um) {
  return OuterShape(std::make_shared<const StarSurface>(egg_surface({length_um, width_um, width_um, {}, {}})));
}

void expect_derivatives(const OuterShape& shape, const Vec3& point) {
  const OuterShape::Gap gap = shape.gap(point);
  EXPECT_NEAR(gap.inward.norm(), 1, 1e-9);
  constexpr double step = 1e-3;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 way = step * Vec3::Unit(axis);
    const OuterShape::Gap after = shape.gap(point + way), before = shape.gap(point - way);
    EXPECT_NEAR((after.value - before.value) / (2 * step), gap.inward[axis], 1e-6);
    EXPECT_LE(((after.inward - before.inward) / (2 * step) - gap.hessian.col(axis)).norm(), 1e-6);
  }
}

TEST(OuterShape, GapsHaveTheirDerivatives) {
  Random random(4);
  const OuterShape capsule(Capsule{60, 90}), surface = egg(500, 180).moved_out(0.5);
  for (int i = 0; i < 20; ++i) {
    const Vec3 way = random.vector().normalized();
    expect_derivatives(capsule, 100 * way);
    // On the egg, and some um to either side.
    const Vec3 on(250 * way.x(), 90 * way.y(), 90 * way.z());
    expect_derivatives(surface, (1 + random.number(0.01)) * on);
  }
}

TEST(OuterShape, OfAnEggThatIsABallIsTheBall) {
  const OuterShape ball(Capsule{0, 90}), surface = egg(180, 180);
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const Vec3 point = (85 + random.number(10)) * random.vector().normalized();
    EXPECT_NEAR(surface.gap(point).value, ball.gap(point).value, 1e-6);
    EXPECT_LE((surface.gap(point).hessian - ball.gap(point).hessian).norm(), 1e-6);
    Vec3 outward(random.number(), 0, random.number()), inside = random.vector(40);
    outward.normalize(), inside.y() = 0;
    EXPECT_NEAR(surface.depth(inside, outward), ball.depth(inside, outward), 1e-6);
  }
  EXPECT_NEAR(surface.volume() / ball.volume(), 1, 1e-4);
  EXPECT_NEAR(surface.moved_out(5).volume() / ball.moved_out(5).volume(), 1, 1e-4);
  EXPECT_NEAR(surface.moved_out(5).gap({80, 0, 0}).value, 15, 1e-6);
}

// Deep inside a gap is a lower bound or near it: nothing is kept there.
TEST(OuterShape, IsFarFromWhatLiesDeep) {
  const OuterShape surface = egg(500, 180);
  for (const Vec3& point : {Vec3(0, 0, 0), Vec3(10, 0, 20), Vec3(-150, 10, 30)}) EXPECT_GT(surface.gap(point).value, 5);
}

}  // namespace
