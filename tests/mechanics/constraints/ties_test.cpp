#include "mechanics/constraints/ties.hpp"

#include "scenario/load.hpp"
#include "simulation/simulation.hpp"
#include "support/law_checks.hpp"
#include "support/models.hpp"

namespace {

TEST(Ties, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = build_slice({14, 180, 35, {2, 4, 4}, {1, 1, 1}});
  const std::vector<Ties::Tie> ties = ties_along_x(tissue);
  EXPECT_EQ(ties.size(), 2u * 2 * 16);  // of three planes, the second and the third
  check_derivatives(Ties(ties, 3), tissue, 4);
  check_semidefinite_tangent(Ties(ties, 3), tissue, 4, false);
}

// Two nodes, pushed apart by 12 nN: F/k further apart.
TEST(Ties, GiveWayByForceOverStiffness) {
  const Tissue tissue = build_block({.length_um = 20, .width_um = 20, .cell_height_um = 20, .cells = {1, 1, 1}});
  const NodeId a = tissue.elements[0][0], b = tissue.elements[0][6];
  const Ties law({{{a, b}, tissue.rest_positions[b.index()] - tissue.rest_positions[a.index()]}}, 400);
  Motion motion = at_rest(tissue);
  EXPECT_EQ(law.energy(motion.step()), 0);
  motion.positions[b.index()].y() += 12.0 / 400;
  EXPECT_NEAR(forces_of(law, motion.step())[a.index()].y(), 12, 1e-9);
  EXPECT_NEAR(resultant(forces_of(law, motion.step())).norm(), 0, 1e-12);
}

// The planes of a slice move alike, however uneven its cells are.
TEST(Ties, KeepASliceAsIfItWereEndless) {
  Simulation simulation(load_scenario(find_scenario("furrow-slice"), {"cortex.apical.variation.spread=0.3",
                                                                      "time.end_min=18", "output.cells_csv=false"}));
  ASSERT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
  double apart = 0;
  for (const auto& [nodes, rest, share] : ties_along_x(simulation.model().tissue))
    apart = std::max(
        apart, (simulation.state().positions[nodes[1].index()] - simulation.state().positions[nodes[0].index()] - rest)
                   .norm());
  EXPECT_LT(apart, 0.02);
  EXPECT_GT(*simulation.measures()["furrow_depth_um"], 30);
  EXPECT_EQ(*simulation.measures()["self_intersections"], 0);
}

}  // namespace
