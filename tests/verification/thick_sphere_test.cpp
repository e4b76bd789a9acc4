// A thick sphere under inner pressure (Lame), small strain: displacements converge as h^2, also near nu = 1/2.
#include <gtest/gtest.h>

#include <cstdio>

#include "mechanics/surroundings.hpp"
#include "support/linear_statics.hpp"

namespace plica {
namespace {

using namespace support;

constexpr double inner = 100, outer = 140, young = 1, pressure = 0.01;  // um, kPa: 10 Pa

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
  const FacePressure load(tissue, false, CellSet(tissue.cells.size(), true), pressure, {});
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
  int cases = 0;
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
      ++cases;
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
  RecordProperty("cases", cases);
}

// Cells refined along the surface only, one through the wall as in an embryo. What remains is the wall's own error:
// with u(ri)/u(re) = (re/ri)^2 = 1.96 the linear course across it is 1.48 in the middle where 1/r^2 is 1.36, 9 % too
// much strain.
TEST(ThickSphere, OneElementThroughTheWallIsLimitedByItsThickness) {
  int cases = 0;
  for (const double poisson : {0.3, 0.499}) {
    for (const std::array<int, 3>& cells : {std::array<int, 3>{9, 9, 8}, std::array<int, 3>{18, 18, 16}}) {
      const Radial u = solve_sphere(cells, 1, poisson);
      const double error_inner = u.inner / lame(inner, poisson) - 1, error_outer = u.outer / lame(outer, poisson) - 1;
      std::printf("thick sphere, nu = %.3f, %d x %d x %d cells, one through the wall: u(ri) %+.3f %%, u(re) %+.3f %%\n",
                  poisson, cells[0], cells[1], cells[2], 100 * error_inner, 100 * error_outer);
      EXPECT_LE(std::abs(error_inner), 0.12);
      EXPECT_LE(std::abs(error_outer), 0.12);
      ++cases;
    }
  }
  RecordProperty("cases", cases);
}

}  // namespace
}  // namespace plica
