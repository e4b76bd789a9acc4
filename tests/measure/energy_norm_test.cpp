#include "measure/energy_norm.hpp"

#include <gtest/gtest.h>

#include "mechanics/elasticity/corotational.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

using namespace support;

TEST(EnergyNorm, IsThatOfTheStiffnessAtRest) {
  const Tissue tissue =
      distorted_block({.length_um = 40, .width_um = 20, .cell_height_um = 40, .cells = {2, 1, 1}}, 2, 3);
  const RestMesh mesh{tissue.elements, tissue.element_rest_shape, {}};
  Random random(5);
  const Vectors a = random.vectors(tissue.node_count()), b = random.vectors(tissue.node_count());
  const auto energy = [&](const Vectors& u, const ElasticModuli& moduli) {
    double sum = 0;
    for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
      Vec24 local;
      for (int i = 0; i < 8; ++i) local.segment<3>(3 * i) = u[tissue.elements[e][i].index()];
      sum += local.dot(incompatible_stiffness(tissue.element_rest_shape[e], moduli) * local);
    }
    return sum;
  };
  Vectors apart = a;
  for (std::size_t n = 0; n < apart.size(); ++n) apart[n] -= b[n];
  const ElasticModuli any_modulus = ElasticModuli::from_young(7, 0.3);
  const double expected = std::sqrt(energy(apart, any_modulus) / energy(b, any_modulus));
  EXPECT_NEAR(relative_energy_norm(mesh, 0.3, a, b).value(), expected, 1e-12 * expected);
  EXPECT_EQ(relative_energy_norm(mesh, 0.3, b, b), 0);
}

TEST(EnergyNorm, CountsChosenElementsOnlyAndNoWholeMotion) {
  const Tissue tissue = build_block({.length_um = 40, .width_um = 20, .cell_height_um = 40, .cells = {2, 1, 1}});
  RestMesh mesh{tissue.elements, tissue.element_rest_shape, {}};
  const Vectors shifted(tissue.node_count(), Vec3(30, -20, 10)), still(tissue.node_count(), Vec3::Zero());
  EXPECT_FALSE(relative_energy_norm(mesh, 0.45, still, shifted));
  EXPECT_FALSE(relative_energy_norm(mesh, 0.45, shifted, still));
  // Only the second cell is deformed.
  Vectors b = still;
  for (const NodeId node : tissue.elements[1])
    if (tissue.rest_positions[node.index()].x() > 0) b[node.index()].x() = 1;
  EXPECT_NEAR(relative_energy_norm(mesh, 0.45, still, b).value(), 1, 1e-12);
  mesh.chosen = {true, false};
  EXPECT_FALSE(relative_energy_norm(mesh, 0.45, still, b));
  mesh.chosen = {false, true};
  EXPECT_NEAR(relative_energy_norm(mesh, 0.45, still, b).value(), 1, 1e-12);
}

}  // namespace
}  // namespace plica
