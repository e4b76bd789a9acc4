// Laws on a tissue that repeats itself: what acts on an image acts on the node that it is an image of.
#include <gtest/gtest.h>

#include <cstdio>

#include "mechanics/active/contraction.hpp"
#include "mechanics/active/cortex.hpp"
#include "mechanics/constraints/cell_volume.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "support/law_checks.hpp"
#include "tissue/faces.hpp"
#include "tissue/shapes/polygon_sheet.hpp"

namespace plica {
namespace {

using namespace support;

constexpr std::size_t passive_laws = 3;  // the first of

std::vector<std::unique_ptr<Law>> laws_on(const Tissue& tissue) {
  const CellSet all(tissue.cells.size(), true);
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(std::make_unique<Corotational>(tissue, ElasticModuli::from_young(1, 0.3), 2));
  laws.push_back(std::make_unique<Dilatation>(tissue, 3));
  laws.push_back(std::make_unique<NeoHookean>(tissue, std::vector(tissue.cells.size(), 0.4)));
  for (const CellSide side : {CellSide::apical, CellSide::basal, CellSide::lateral}) {
    laws.push_back(std::make_unique<Cortex>(
        tissue, all, CortexRule{.side = side, .tension = 1.4, .saturation = 0.16, .stiffness = 0.7}));
    laws.push_back(std::make_unique<Contraction>(
        contraction_springs(tissue, all, {.side = side, .stiffness = 2, .across_ratio = 0.4, .preload = 1}),
        Program{}));
  }
  return laws;
}

class PeriodicLaws : public testing::TestWithParam<PolygonSplit> {
 protected:
  const Tissue tissue = build_sheet({40, 40, {0, 0}, {true, true}}, 20, 1, {10, GetParam(), 1});

  // Free nodes moved at random, and all others with them.
  [[nodiscard]] Vectors moved(double size_um, unsigned seed) const {
    Vectors x = tissue.rest_positions;
    Random random(seed);
    for (std::size_t n = 0; n < tissue.free_node_count(); ++n) x[n] += random.vector(size_um);
    tissue.place_hanging_positions(x);
    return x;
  }
  [[nodiscard]] Vectors carried_forces(const Law& law, const Step& step) const {
    Vectors forces(tissue.node_count(), Vec3::Zero());
    law.add_forces(step, forces);
    tissue.carry_hanging(forces);
    return forces;
  }
};

INSTANTIATE_TEST_SUITE_P(Splits, PeriodicLaws, testing::Values(PolygonSplit::diagonals, PolygonSplit::kites),
                         [](const auto& given) { return given.param == PolygonSplit::kites ? "kites" : "diagonals"; });

TEST_P(PeriodicLaws, DerivativesAgreeWithFiniteDifferences) {
  const CellSet all(tissue.cells.size(), true);
  check_derivatives(Cortex(tissue, all, {.side = CellSide::lateral, .tension = 1.4, .stiffness = 0.7}), tissue, 0.3, 1);
  check_derivatives(Corotational(tissue, ElasticModuli::from_young(1, 0.45), 2), tissue, 0.3, 1);
}

// The energy's change with a free node, whose images go along, is what is carried to it.
TEST_P(PeriodicLaws, ForcesThroughImagesAreMinusTheEnergysGradient) {
  int compared = 0;
  for (const auto& law : laws_on(tissue)) {
    Motion motion{moved(0.3, 1), tissue.rest_positions, Vectors(tissue.node_count(), Vec3::Zero())};
    const Vectors forces = carried_forces(*law, motion.step());
    const double scale = largest(forces);
    for (std::size_t n = 0; n < tissue.free_node_count(); n += 3)
      for (int axis = 0; axis < 3; ++axis, ++compared) {
        const auto energy_at = [&](double way) {
          Motion other = motion;
          other.positions[n][axis] += way;
          tissue.place_hanging_positions(other.positions);
          return law->energy(other.step());
        };
        const double difference = (energy_at(difference_um) - energy_at(-difference_um)) / (2 * difference_um);
        EXPECT_NEAR(forces[n][axis], -difference, 1e-6 * scale) << law->name() << ", node " << n;
      }
  }
  std::printf("%d components of forces\n", compared);
}

TEST_P(PeriodicLaws, NothingPushesTheWholeAndRestIsWithoutForce) {
  const Vectors still(tissue.node_count(), Vec3::Zero());
  const Motion motion{moved(0.5, 2), tissue.rest_positions, still};
  const Motion rest{tissue.rest_positions, tissue.rest_positions, still};
  const auto laws = laws_on(tissue);
  for (std::size_t l = 0; l < laws.size(); ++l) {
    const Vectors forces = carried_forces(*laws[l], motion.step());
    EXPECT_LT(resultant(forces).norm(), 1e-12 * largest(forces) * static_cast<double>(forces.size())) << l;
    if (l < passive_laws) {
      EXPECT_LT(largest(carried_forces(*laws[l], rest.step())), 1e-11) << l;
    }
  }
}

// A wall of two cells has one tension, where a period ends as elsewhere.
TEST_P(PeriodicLaws, AWallAcrossTheEndIsOne) {
  const Vectors still(tissue.node_count(), Vec3::Zero());
  const Motion rest{tissue.rest_positions, tissue.rest_positions, still};
  double perimeters = 0;
  for (const Cell& cell : tissue.cells)
    for (std::size_t i = 0; i < cell.sides(); ++i)
      perimeters += (tissue.rest_positions[cell.apical_corners()[(i + 1) % cell.sides()].index()] -
                     tissue.rest_positions[cell.apical_corners()[i].index()])
                        .norm();
  const Cortex walls(tissue, CellSet(tissue.cells.size(), true), {.side = CellSide::lateral, .tension = 1.5});
  EXPECT_NEAR(walls.energy(rest.step()), 1.5 * 0.5 * perimeters * 10, 1e-9 * perimeters);
}

// The area of a flat endless sheet does not change with its nodes: an even tension pulls at none. At a rim it does.
TEST_P(PeriodicLaws, AnEvenTensionPullsAtNoNode) {
  const auto pull = [&](const Tissue& sheet) {
    const Cortex cortex(sheet, CellSet(sheet.cells.size(), true), {.side = CellSide::apical, .tension = 1});
    Vectors forces(sheet.node_count(), Vec3::Zero());
    const Vectors still(sheet.node_count(), Vec3::Zero());
    cortex.add_forces(Motion{sheet.rest_positions, sheet.rest_positions, still}.step(), forces);
    sheet.carry_hanging(forces);
    return largest(forces);
  };
  EXPECT_LT(pull(tissue), 1e-12);
  EXPECT_GT(pull(build_sheet({40, 40}, 20, 1, {10, GetParam(), 1})), 1);
}

}  // namespace
}  // namespace plica
