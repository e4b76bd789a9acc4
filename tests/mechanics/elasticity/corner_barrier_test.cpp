#include "mechanics/elasticity/corner_barrier.hpp"

#include "solver/step/newton_stepper.hpp"
#include "support/law_checks.hpp"
#include "support/loads.hpp"
#include "support/models.hpp"
#include "tissue/mesh_quality.hpp"

namespace {

// A threshold above all that these motions do, so that every corner is pushed; nothing is inside out yet.
TEST(CornerBarrier, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block({.length_um = 40, .width_um = 40, .cells = {2, 2, 1}}, 2, 3);
  const CornerBarrier law(tissue, 0.4, 3);
  check_derivatives(law, tissue, 2);
  check_semidefinite_tangent(law, tissue, 2, true);
}

TEST(CornerBarrier, IsNothingAboveItsThresholdAndInfiniteAtZero) {
  const Tissue tissue = build_block({.length_um = 20, .width_um = 20, .cell_height_um = 20, .cells = {1, 1, 1}});
  const CornerBarrier law(tissue, 0.01);
  const auto energy = [&](double height_ratio) {
    Motion motion = at_rest(tissue);
    for (Vec3& x : motion.positions) x.z() *= height_ratio;
    EXPECT_NEAR(least_corner_ratio(tissue, motion.positions).ratio, height_ratio, 1e-12);
    return law.energy(motion.step());
  };
  EXPECT_EQ(energy(1), 0);
  EXPECT_EQ(energy(0.15), 0);
  const double r = 0.5;
  EXPECT_NEAR(energy(r * 0.15), -0.01 * 8000 * (r - 1) * (r - 1) * std::log(r), 1e-9);
  EXPECT_GT(energy(1e-9), 10 * energy(r * 0.15));
}

// One corner of a soft cell is pushed in towards the opposite one: it stops before it is inverted.
TEST(CornerBarrier, HoldsACornerUpright) {
  for (const bool with_barrier : {false, true}) {
    Model model(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 20, .cells = {1, 1, 1}}));
    add_elasticity(model, 0);
    model.volumes.hold(false);
    const Vectors& rest = model.tissue.rest_positions;
    const NodeId pushed = model.tissue.elements[0][6], opposite = model.tissue.elements[0][0];
    for (const NodeId node : model.tissue.elements[0])
      model.held[node.index()] = {node != pushed, node != pushed, node != pushed};
    Vectors load(model.tissue.node_count(), Vec3::Zero());
    load[pushed.index()] = 300 * (rest[opposite.index()] - rest[pushed.index()]).normalized();
    model.laws.push_back(std::make_unique<NodalForces>(load));
    if (with_barrier) model.laws.push_back(std::make_unique<CornerBarrier>(model.tissue, 1));
    NewtonStepper stepper(model);
    State end;
    const StepReport report = stepper.advance(rest_state(model), 1, true, end);
    EXPECT_EQ(report.converged(), with_barrier) << report.reason();
    if (!with_barrier) continue;
    const double ratio = least_corner_ratio(model.tissue, end.positions).ratio;
    EXPECT_GT(ratio, 0);
    EXPECT_LT(ratio, 0.15);
  }
}

}  // namespace
