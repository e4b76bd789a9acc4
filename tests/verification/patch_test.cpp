// The patch test of MacNeal and Harder (1985): seven distorted hexahedra in a unit cube, a linear displacement on the
// boundary. Inner nodes, stresses and the supports' forces must be exact. The same of polygons, and a thick sphere.
#include "mechanics/constraints/cell_volume.hpp"
#include "mechanics/surroundings.hpp"
#include "support/elements.hpp"
#include "support/law_checks.hpp"
#include "support/linear_statics.hpp"
#include "support/prisms.hpp"

namespace {

const ElasticModuli moduli = ElasticModuli::from_young(1e6, 0.25);

/// With inner nodes drawn by `calm` towards those of a regular inner cube (1: all the way).
Tissue patch(double calm = 0) {
  Vectors nodes = {{0, 0, 0},          {1, 0, 0},          {1, 1, 0},          {0, 1, 0},
                   {0, 0, 1},          {1, 0, 1},          {1, 1, 1},          {0, 1, 1},
                   {.249, .342, .192}, {.826, .288, .288}, {.850, .649, .263}, {.273, .750, .230},
                   {.320, .186, .643}, {.677, .305, .683}, {.788, .693, .644}, {.165, .745, .702}};
  for (int i = 0; i < 8; ++i) nodes[8 + i] += calm * (0.25 * Vec3::Ones() + 0.5 * nodes[i] - nodes[8 + i]);
  return tissue_from_hexahedra({{8, 9, 10, 11, 12, 13, 14, 15},
                                {0, 1, 2, 3, 8, 9, 10, 11},
                                {12, 13, 14, 15, 4, 5, 6, 7},
                                {0, 1, 9, 8, 4, 5, 13, 12},
                                {1, 2, 10, 9, 5, 6, 14, 13},
                                {2, 3, 11, 10, 6, 7, 15, 14},
                                {3, 0, 8, 11, 7, 4, 12, 15}},
                               nodes);
}

/// u = 10^-3 (2x + y + z, x + 2y + z, x + y + 2z) / 2.
Mat3 gradient() { return 0.5e-3 * (Mat3::Ones() + Mat3::Identity()); }

// In this famous patch det J < 0 at a corner of the element towards y = 0, though it is positive at every Gauss point.
// plica refuses cells with such a corner, so the patch is assembled from the elements' stiffness.
TEST(Patch, HasSevenHexahedraOfVolumeOneOneOfThemWithAFoldedCorner) {
  const Tissue tissue = patch();
  double volume = 0;
  int folded = 0;
  for (const HexPoints& shape : tissue.element_rest_shape) {
    folded += hex_scaled_jacobian(shape) <= 0;
    for (const Vec3& corner : hex_reference_nodes)
      EXPECT_GT(hex_jacobian(shape, corner / std::sqrt(3.0)).determinant(), 0);
    volume += hex_volume(shape);
  }
  EXPECT_EQ(folded, 1);
  EXPECT_THROW(Corotational(tissue, in_elements(tissue, moduli), 0), std::domain_error);
  EXPECT_EQ(tissue.elements.size(), 7u);
  EXPECT_NEAR(volume, 1, 1e-14);
}

void expect_linear_displacement_is_exact(const Tissue& tissue, LinearStatics statics, const char* name) {
  for (std::size_t n = 0; n < 8; ++n) statics.prescribe(n, gradient() * tissue.rest_positions[n]);
  const Vectors u = statics.solve();
  double worst_displacement = 0, worst_stress = 0, worst_force = 0;
  for (std::size_t n = 8; n < 16; ++n)
    worst_displacement = std::max(worst_displacement, (u[n] - gradient() * tissue.rest_positions[n]).norm() / 1e-3);

  int points = 0;
  const Mat3 exact = 400 * Mat3::Ones() + 1600 * Mat3::Identity();  // 2000 on the diagonal
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    for (const Vec3& corner : hex_reference_nodes) {
      const Vec3 point = corner / std::sqrt(3.0);
      const Mat3 inverse = hex_jacobian(tissue.element_rest_shape[e], point).inverse();
      const auto shape = hex_shape_gradients(point);
      Mat3 H = Mat3::Zero();
      for (int i = 0; i < 8; ++i) H += u[tissue.elements[e][i].index()] * (inverse.transpose() * shape[i]).transpose();
      const Mat3 strain = 0.5 * (H + H.transpose());
      const Mat3 stress = moduli.lame_lambda * strain.trace() * Mat3::Identity() + 2 * moduli.shear_modulus * strain;
      worst_stress = std::max(worst_stress, (stress - exact).cwiseAbs().maxCoeff() / 2000);
      ++points;
    }

  // What the stiffness makes of it: the supports carry the exact stress, sigma n / 4 at each corner of a face.
  const Vectors reactions = statics.reactions(u);
  for (std::size_t n = 0; n < 8; ++n) {
    const Vec3 outward = 2 * tissue.rest_positions[n] - Vec3::Ones();
    worst_force = std::max(worst_force, (reactions[n] - exact * outward / 4).norm() / 2000);
  }
  std::printf("%s: relative errors of displacement %.1e, stress %.1e, supports' forces %.1e\n", name,
              worst_displacement, worst_stress, worst_force);
  EXPECT_LE(worst_displacement, 1e-10);
  EXPECT_LE(worst_stress, 1e-10);
  EXPECT_LE(worst_force, 1e-10);
  EXPECT_EQ(points, 56);
}

TEST(Patch, LinearDisplacementIsExactWithItsStress) {
  const Tissue tissue = patch();
  expect_linear_displacement_is_exact(tissue, LinearStatics::of_elements(tissue, moduli), "patch");
}

TEST(Patch, LinearDisplacementIsExactThroughTheLaws) {
  const Tissue tissue = patch(0.3);
  expect_linear_displacement_is_exact(tissue, {tissue, moduli}, "calmer patch, through the laws");
}

// The patch deformed and then turned by a finite rotation: the forces are those before, turned.
TEST(Patch, RotatedPatchHasRotatedForces) {
  const Tissue tissue = patch(0.3);
  const Corotational elasticity(tissue, in_elements(tissue, moduli), 0);
  const Dilatation dilatation(tissue, in_elements(tissue, moduli.bulk_modulus()), false);
  Motion motion = at_rest(tissue);
  for (Vec3& x : motion.positions) x += 20 * (gradient() * x);
  Vectors before = forces_of(elasticity, motion.step());
  dilatation.add_forces(motion.step(), before);
  Random random(1);
  int cases = 0;
  double worst = 0;
  for (; cases < 50; ++cases) {
    const Mat3 R = random.rotation();
    Motion turned = motion;
    for (Vec3& x : turned.positions) x = R * x;
    Vectors after = forces_of(elasticity, turned.step());
    dilatation.add_forces(turned.step(), after);
    for (std::size_t n = 0; n < after.size(); ++n)
      worst = std::max(worst, (after[n] - R * before[n]).norm() / largest(before));
  }
  std::printf("rotated patch: relative error of forces %.1e in %d rotations\n", worst, cases);
  EXPECT_LE(worst, 1e-10);
}

// Free faces carry nothing: at a uniform finite stretch the inner nodes of the patch are in balance.
TEST(Patch, InnerNodesBalanceAtAFiniteUniformStretch) {
  const Tissue tissue = patch(0.3);
  const Corotational elasticity(tissue, in_elements(tissue, moduli), 0);
  const Dilatation dilatation(tissue, in_elements(tissue, moduli.bulk_modulus()), false);
  Motion motion = at_rest(tissue);
  const Mat3 F = Vec3(1.3, 0.9, 0.95).asDiagonal();
  for (Vec3& x : motion.positions) x = F * x;
  Vectors forces = forces_of(elasticity, motion.step());
  dilatation.add_forces(motion.step(), forces);
  for (std::size_t n = 8; n < 16; ++n) EXPECT_LE(forces[n].norm(), 1e-10 * largest(forces));
}

constexpr double young = 1;

using Case = std::pair<PolygonSplit, double>;  // split, Poisson's ratio

class PolygonSheets : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Splits, PolygonSheets,
                         testing::Values(Case{PolygonSplit::diagonals, 0.3}, Case{PolygonSplit::diagonals, 0.45},
                                         Case{PolygonSplit::kites, 0.3}, Case{PolygonSplit::kites, 0.45}),
                         [](const auto& given) {
                           return std::string(given.param.first == PolygonSplit::kites ? "kites" : "diagonals") +
                                  (given.param.second == 0.3 ? "3" : "45");
                         });

/// Free nodes of walls that have a cell on one side only.
std::set<std::size_t> rim_of(const Tissue& tissue) {
  std::set<std::size_t> rim;
  std::map<std::pair<NodeId, NodeId>, int> cells_of;  // edges
  for (const Cell& cell : tissue.cells)
    for (const CellEdge& edge : cell.edges)
      if (edge.side != CellSide::lateral) ++cells_of[std::minmax(edge.nodes.front(), edge.nodes.back())];
  for (const Cell& cell : tissue.cells)
    for (const CellEdge& edge : cell.edges) {
      if (edge.side == CellSide::lateral || cells_of.at(std::minmax(edge.nodes.front(), edge.nodes.back())) > 1)
        continue;
      for (const NodeId node : edge.nodes) rim.insert(node.index());
    }
  return rim;
}

// Stretched along and across, free above and below: u = (a x, b y, -nu/(1 - nu) (a + b) z).
TEST_P(PolygonSheets, StretchAsAPlateDoes) {
  const auto [split, poisson] = GetParam();
  const Tissue tissue = tissue_from_prisms(irregular_polygons(9, 8, 4, 12, 0.15, 3), split, 1);
  LinearStatics statics(tissue, ElasticModuli::from_young(young, poisson));
  const double thins = -poisson / (1 - poisson) * (2e-3 - 1e-3);
  const auto exact = [&](const Vec3& x) { return Vec3(2e-3 * x.x(), -1e-3 * x.y(), thins * x.z()); };
  for (const std::size_t n : rim_of(tissue)) statics.prescribe(n, exact(tissue.rest_positions[n]));
  const Vectors u = statics.solve();
  for (std::size_t n = 0; n < u.size(); ++n)
    EXPECT_LE((u[n] - exact(tissue.rest_positions[n])).norm(), 1e-12) << "node " << n;
}

/// The energy of a sheet that is bent across the middle of its height, as a part of a plate's: along x by a curvature,
/// flat along y.
double bending_over_exact(const PrismSheet& sheet, PolygonSplit split, double poisson, double height) {
  const Tissue tissue = tissue_from_prisms(sheet, split, 1);
  LinearStatics statics(tissue, ElasticModuli::from_young(young, poisson));
  constexpr double curvature = 1e-4;
  const auto exact = [&](const Vec3& x) {
    const double z = x.z() + height / 2;
    return Vec3(-curvature * x.x() * z, 0, curvature / 2 * (x.x() * x.x() + poisson / (1 - poisson) * z * z));
  };
  for (const std::size_t n : rim_of(tissue)) statics.prescribe(n, exact(tissue.rest_positions[n]));
  const Vectors u = statics.solve(), forces = statics.reactions(u);
  double energy = 0, area = 0;
  for (std::size_t n = 0; n < tissue.free_node_count(); ++n) energy += 0.5 * u[n].dot(forces[n]);
  for (const double of_cell : face_areas(tissue, CellSide::apical, tissue.rest_positions)) area += of_cell;
  const double plate = young / (1 - poisson * poisson) * height * height * height / 12;
  return energy / (0.5 * plate * curvature * curvature * area);
}

// Cells 7 um wide and 12 high, and finer ones of the same height: what is left falls with the square of their width.
TEST_P(PolygonSheets, BendAsAPlateDoes) {
  const auto [split, poisson] = GetParam();
  constexpr double height = 12, edge = 4;
  double last = 0;
  for (const int times : {1, 2}) {
    const PrismSheet sheet = irregular_polygons(12 * times, 14 * times, edge / times, height, 0.1, 3);
    const double error = bending_over_exact(sheet, split, poisson, height) - 1;
    std::printf("bending, %s, nu = %.2f, edges of %.0f um: energy over a plate's %.4f\n",
                split == PolygonSplit::kites ? "kites" : "diagonals", poisson, edge / times, 1 + error);
    EXPECT_NEAR(error, 0, 0.05);
    if (times > 1) {
      EXPECT_LT(error, 0.4 * last);
    }
    last = error;
  }
}

constexpr double inner = 100, outer = 140, pressure = 0.01;  // um, kPa: 10 Pa

/// Lame's radial displacement at radius r.
double lame(double r, double poisson) {
  const double a3 = inner * inner * inner, b3 = outer * outer * outer;
  return pressure * a3 / (young * (b3 - a3)) * ((1 - 2 * poisson) * r + (1 + poisson) * b3 / (2 * r * r));
}

struct Radial {
  double inner, outer;  // um, means over the nodes of a surface
};

Radial solve_sphere(std::array<int, 3> cells, int elements, double poisson) {
  const Tissue tissue =
      build_shell({.length_um = 2 * outer, .cells = cells, .elements_per_cell = {elements, elements, elements}});
  LinearStatics statics(tissue, ElasticModuli::from_young(young, poisson));
  const FacePressure load(tissue, CellSide::basal, CellSet(tissue.cells.size(), true), pressure, {});
  const Motion rest = at_rest(tissue);
  statics.add_loads(forces_of(load, rest.step()));
  // The load balances itself, so six displacements held take no force; what rigid motion they leave has no mean radial
  // part, the mesh being symmetric.
  const std::array<NodeId, 8>& corner = tissue.elements[0];
  const Vec3 along = tissue.rest_positions[corner[1].index()] - tissue.rest_positions[corner[0].index()];
  int first = 0;  // the axis along which these two nodes lie apart most
  along.cwiseAbs().maxCoeff(&first);
  statics.prescribe(corner[0].index(), Vec3::Zero());
  const Vec3 aside = tissue.rest_positions[corner[3].index()] - tissue.rest_positions[corner[0].index()];
  int second = 0;
  Vec3 rest_of_aside = aside.cwiseAbs();
  rest_of_aside[first] = 0;
  rest_of_aside.maxCoeff(&second);
  const int third = 3 - first - second;
  statics.prescribe(corner[1].index(), second, 0);
  statics.prescribe(corner[1].index(), third, 0);
  statics.prescribe(corner[3].index(), third, 0);
  const Vectors u = statics.solve();
  const Vectors reactions = statics.reactions(u);
  EXPECT_LE(largest(reactions), 1e-7 * pressure * 4 * std::numbers::pi * inner * inner);
  std::array<double, 2> sum{}, count{};
  for (std::size_t n = 0; n < u.size(); ++n) {
    const double radius = tissue.rest_positions[n].norm();
    for (int side = 0; side < 2; ++side)
      if (std::abs(radius - (side == 0 ? inner : outer)) < 1e-6) {
        sum[side] += u[n].dot(tissue.rest_positions[n]) / radius;
        count[side] += 1;
      }
  }
  return {sum[0] / count[0], sum[1] / count[1]};
}

TEST(ThickSphere, FormulaGivesThePrintedFigures) {
  // Computed apart from plica, to four decimals.
  EXPECT_NEAR(lame(inner, 0.3), 1.2521, 5e-5);
  EXPECT_NEAR(lame(outer, 0.3), 0.8429, 5e-5);
  EXPECT_NEAR(lame(inner, 0.49), 1.1836, 5e-5);
  EXPECT_NEAR(lame(outer, 0.49), 0.6141, 5e-5);
  EXPECT_NEAR(lame(inner, 0.499), 1.1804, 5e-5);
  EXPECT_NEAR(lame(outer, 0.499), 0.6033, 5e-5);
}

TEST(ThickSphere, ConvergesAsTheSquareOfTheElementSizeWithoutLocking) {
  std::array<double, 3> finest{};  // a Poisson ratio
  int ratio = 0;
  for (const double poisson : {0.3, 0.49, 0.499}) {
    std::array<std::array<double, 2>, 3> errors{};
    for (int n = 1; n <= 3; ++n) {
      const Radial u = solve_sphere({9, 9, 8}, n, poisson);
      errors[n - 1] = {u.inner / lame(inner, poisson) - 1, u.outer / lame(outer, poisson) - 1};
      std::printf(
          "thick sphere, nu = %.3f, %d x %d x %d elements a cell: u(ri) %.5f (%+.3f %%), u(re) %.5f (%+.3f %%)\n",
          poisson, n, n, n, u.inner, 100 * errors[n - 1][0], u.outer, 100 * errors[n - 1][1]);
    }
    for (int side = 0; side < 2; ++side) {
      // Order between the two finest meshes.
      const double order = std::log(std::abs(errors[1][side] / errors[2][side])) / std::log(1.5);
      std::printf("thick sphere, nu = %.3f, %s: order %.2f\n", poisson, side == 0 ? "u(ri)" : "u(re)", order);
      EXPECT_GE(order, 1.8);
      EXPECT_LE(std::abs(errors[2][side]), 0.02);
    }
    finest[ratio++] = std::abs(errors[2][0]);
  }
  // Locking would make the error grow without bound as nu -> 1/2. That it doubles from 0.3 on is the field, not the
  // element: nearer 1/2 it varies as 1/r^2 across the wall, and elements are linear there.
  EXPECT_LE(finest[2], 1.2 * finest[1]);
  EXPECT_LE(finest[2], 2.5 * finest[0]);
}

// Cells refined along the surface only, one through the wall as in an embryo. What remains is the wall's own error:
// with u(ri)/u(re) = (re/ri)^2 = 1.96 the linear course across it is 1.48 in the middle where 1/r^2 is 1.36, 9 % too
// much strain.
TEST(ThickSphere, OneElementThroughTheWallIsLimitedByItsThickness) {
  for (const double poisson : {0.3, 0.499}) {
    for (const std::array<int, 3>& cells : {std::array<int, 3>{9, 9, 8}, std::array<int, 3>{18, 18, 16}}) {
      const Radial u = solve_sphere(cells, 1, poisson);
      const double error_inner = u.inner / lame(inner, poisson) - 1, error_outer = u.outer / lame(outer, poisson) - 1;
      std::printf("thick sphere, nu = %.3f, %d x %d x %d cells, one through the wall: u(ri) %+.3f %%, u(re) %+.3f %%\n",
                  poisson, cells[0], cells[1], cells[2], 100 * error_inner, 100 * error_outer);
      EXPECT_LE(std::abs(error_inner), 0.12);
      EXPECT_LE(std::abs(error_outer), 0.12);
    }
  }
}

}  // namespace
