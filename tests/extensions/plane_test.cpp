// A door for new obstacles, tried: a plane, in one file.
#include "extensions/extension_checks.hpp"

namespace plica {
namespace {

using namespace support;

class Plane final : public Obstacle {
 public:
  /// Nodes stay where normal . x >= height.
  Plane(const Tissue& tissue, const Vec3& normal, double height_um) : normal_(normal), height_um_(height_um) {
    for (std::size_t n = 0; n < tissue.free_node_count(); ++n) nodes_.emplace_back(n);
  }
  [[nodiscard]] std::string_view name() const override { return "plane"; }
  [[nodiscard]] std::unique_ptr<Obstacle> clone() const override { return std::make_unique<Plane>(*this); }
  [[nodiscard]] std::span<const NodeId> nodes() const override { return nodes_; }
  [[nodiscard]] Gap gap(const Vec3& x) const override { return {normal_.dot(x) - height_um_, normal_, Mat3::Zero()}; }
  [[nodiscard]] std::unique_ptr<Obstacle> after_division(const Tissue& tissue, const Division&) const override {
    return std::make_unique<Plane>(tissue, normal_, height_um_);
  }

 private:
  Vec3 normal_;
  double height_um_;
  std::vector<NodeId> nodes_;
};

// Across the left flank and the belly, a little inside where the embryo lies: its nodes begin outside.
const Extension slope = [](Model& model) {
  const Vec3 normal = Vec3(0, 1, 0.2).normalized();
  double lowest = 0;
  for (const Vec3& x : model.tissue.rest_positions) lowest = std::min(lowest, normal.dot(x));
  model.obstacles.push_back(std::make_unique<Plane>(model.tissue, normal, lowest + 0.5));
};

TEST(Plane, IsNotPassed) {
  Simulation simulation(extended(slope, {"time.end_s=30"}));
  const Contacts contacts(simulation.model());
  double deepest = 0;
  int on_plane = 0;
  while (simulation.step()) {
    deepest = std::max(deepest, *simulation.measures()["max_shell_penetration_um"]);
    const State& state = simulation.state();
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      EXPECT_GE(state.contact_forces[k], 0);
      on_plane += k >= simulation.model().obstacles.front()->nodes().size() && state.in_contact[k];
    }
  }
  EXPECT_EQ(simulation.status(), RunStatus::end_time) << simulation.failure();
  EXPECT_LE(deepest, 1e-8);
  EXPECT_GT(on_plane, 0);
}

// A brick in a corner of two planes and on the floor: its node there touches three, and pressures balance.
TEST(Plane, ANodeMayTouchSeveral) {
  Model model(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 20, .cells = {1, 1, 1}}));
  add_elasticity(model);
  add_drag(model);
  Vectors push(model.tissue.node_count(), Vec3(-1, -2, -3));
  model.laws.push_back(std::make_unique<NodalForces>(push));
  Vec3 low = Vec3::Constant(1e9);
  for (const Vec3& x : model.tissue.rest_positions) low = low.cwiseMin(x);
  for (int axis = 0; axis < 3; ++axis)
    model.obstacles.push_back(std::make_unique<Plane>(model.tissue, Vec3::Unit(axis), low[axis] - 0.5));
  RunControls controls;
  controls.end_s = 1e5;
  controls.equilibrium_speed_um_per_s = 1e-6;
  const Simulation simulation = ran(std::move(model), controls);
  ASSERT_EQ(simulation.status(), RunStatus::equilibrium) << simulation.failure();
  const Contacts contacts(simulation.model());
  Vec3 borne = Vec3::Zero();
  for (std::size_t k = 0; k < contacts.size(); ++k)
    borne += simulation.state().contact_forces[k] * contacts.gap(k, simulation.state().positions).inward;
  // At rest the planes bear all of it, but for the drag of nodes slower than 1e-6 um/s.
  EXPECT_LE((borne - Vec3(8, 16, 24)).norm(), 1e-3);
}

TEST(Plane, WorksWithEveryLinearSolver) { expect_same_run_with_every_solver(slope); }
TEST(Plane, ResumesToTheSameBitsThroughADivision) { expect_resumable_through_a_division(slope); }
TEST(Plane, WorksWithThePapersAlgorithm) { expect_runs_with_the_papers_algorithm(slope); }

}  // namespace
}  // namespace plica
