// Doors for new parts, tried: a constraint with a dense row, an obstacle, a law whose pattern changes, one that bounds
// steps.
#include "extensions/extension_checks.hpp"
#include "mechanics/constraints/enclosed_volume.hpp"
#include "support/ran.hpp"

namespace {

const Extension yolk = [](Model& model) {
  model.constraints.push_back(std::make_unique<EnclosedVolume>(model.tissue));
};

TEST(EnclosedVolume, IsHeldAsCellsAreAndThePressureIsNotNothing) {
  const auto at_end = [](const Extension& extension) {
    Simulation simulation(extended(extension, {"time.end_s=20"}));
    EXPECT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
    return simulation;
  };
  const Simulation held = at_end(yolk), free = at_end({});
  const auto ratio = [](const Simulation& simulation) { return simulation.measures()["lumen_volume_ratio"].value(); };
  EXPECT_NEAR(ratio(held), 1, 1e-9);
  EXPECT_GT(std::abs(ratio(free) - 1), 1e-3);
  EXPECT_GT(std::abs(held.state().multipliers.back()), 1e-6);
  EXPECT_LE(*held.measures()["max_volume_error"], 1e-9);
}

// What a dense row costs: one more solve each time, and no blocks. The shell is a little away, since with the lumen
// held in a sheet that lies on it nothing can move at first, and the constraints are nearly one.
TEST(EnclosedVolume, CostsFewIterationsMore) {
  for (const char* method : {"cholesky", "multigrid"}) {
    const auto iterations_a_direction = [&](const Extension& extension) {
      Simulation simulation(
          extended(extension, {"time.end_s=10", "vitelline.gap_um=0.5", std::string("time.linear_solver=") + method}));
      double linear = 0, newton = 0;
      while (simulation.step()) {
        linear += *simulation.measures()["linear_iterations"];
        newton += *simulation.measures()["newton_iterations"];
      }
      std::printf("%s: %d steps, %.0f Newton and %.0f linear iterations\n", method, simulation.steps(), newton, linear);
      return linear / newton;
    };
    EXPECT_LE(iterations_a_direction(yolk), 1.1 * iterations_a_direction({}));
  }
}

TEST(EnclosedVolume, WorksWithEveryLinearSolver) { expect_same_run_with_every_solver(yolk); }
TEST(EnclosedVolume, ResumesToTheSameBitsThroughADivision) {
  expect_resumable_through_a_division(yolk, "division.floor.daughter_volume_ratio=0.5");  // there is no room to grow
}
TEST(EnclosedVolume, IsRefusedByThePapersAlgorithm) {
  EXPECT_THROW(expect_runs_with_the_papers_algorithm(yolk), std::logic_error);
}

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
  [[nodiscard]] std::unique_ptr<Obstacle> after_change(const Tissue& tissue, const TissueChange&) const override {
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
  const ObstacleContacts contacts(simulation.model());
  double deepest = 0;
  int on_plane = 0;
  while (simulation.step()) {
    deepest = std::max(deepest, *simulation.measures()["max_shell_penetration_um"]);
    const State& state = simulation.state();
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      EXPECT_GE(state.obstacle_forces[k], 0);
      on_plane += k >= simulation.model().obstacles.front()->nodes().size() && state.on_obstacle[k];
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
  RunControls controls{.end_s = 1e5, .equilibrium_speed_um_per_s = 1e-6};
  const Simulation simulation = ran(std::move(model), controls);
  ASSERT_EQ(simulation.status(), RunStatus::equilibrium) << simulation.failure();
  const ObstacleContacts contacts(simulation.model());
  Vec3 borne = Vec3::Zero();
  for (std::size_t k = 0; k < contacts.size(); ++k)
    borne += simulation.state().obstacle_forces[k] * contacts.gap(k, simulation.state().positions).inward;
  // At rest the planes bear all of it, but for the drag of nodes slower than 1e-6 um/s.
  EXPECT_LE((borne - Vec3(8, 16, 24)).norm(), 1e-3);
}

TEST(Plane, WorksWithEveryLinearSolver) { expect_same_run_with_every_solver(slope); }
TEST(Plane, ResumesToTheSameBitsThroughADivision) { expect_resumable_through_a_division(slope); }
TEST(Plane, WorksWithThePapersAlgorithm) { expect_runs_with_the_papers_algorithm(slope); }

/// A spring between two nodes at opposite ends of the embryo, which takes hold of others after every few steps. Its
/// internal state: how many steps there have been.
class WanderingSpring final : public Law {
 public:
  [[nodiscard]] std::string_view name() const override { return "wandering spring"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<WanderingSpring>(*this); }
  [[nodiscard]] double energy(const Step& step) const override { return 0.5 * stiffness * stretch(step).squaredNorm(); }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    const auto [a, b] = nodes(step.internal);
    forces[a.index()] += stiffness * stretch(step);
    forces[b.index()] -= stiffness * stretch(step);
  }
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override {
    const auto [a, b] = nodes(step.internal);
    const Vec3 change = stiffness * (direction[b.index()] - direction[a.index()]);
    product[a.index()] -= change;
    product[b.index()] += change;
  }
  void add_tangent(const Step& step, TangentSink& tangent) const override {
    const auto [a, b] = nodes(step.internal);
    const Mat3 block = stiffness * Mat3::Identity();
    tangent.add_block(a, a, block);
    tangent.add_block(b, b, block);
    tangent.add_block(b, a, -block);
  }
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override {
    NodeGroups groups;
    groups.add(nodes(internal));
    return groups;
  }
  [[nodiscard]] int groups_revision(std::span<const double> internal) const override {
    return static_cast<int>(internal[0]) / 4;
  }
  [[nodiscard]] std::vector<double> first_internal(const Tissue&) const override { return {0}; }
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override { return {step.internal[0] + 1}; }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue&, const TissueChange&,
                                                  std::span<const Vec3>) const override {
    return clone();
  }

 private:
  static constexpr double stiffness = 0.04;  // nN/um
  [[nodiscard]] std::array<NodeId, 2> nodes(std::span<const double> internal) const {
    const auto n = static_cast<std::size_t>(7 * groups_revision(internal));
    return {NodeId(n), NodeId(800 + n)};
  }
  [[nodiscard]] Vec3 stretch(const Step& step) const {
    const auto [a, b] = nodes(step.internal);
    return step.positions[b.index()] - step.positions[a.index()];
  }
};

const Extension wandering = [](Model& model) { model.laws.push_back(std::make_unique<WanderingSpring>()); };

TEST(ChangingPattern, WorksWithEveryLinearSolver) { expect_same_run_with_every_solver(wandering); }
TEST(ChangingPattern, ResumesToTheSameBitsThroughADivision) { expect_resumable_through_a_division(wandering); }

/// Lets nodes move a half of what Newton's method wants, and counts how often it was asked.
class Hesitant final : public Law {
 public:
  explicit Hesitant(int& asked) : asked_(asked) {}
  [[nodiscard]] std::string_view name() const override { return "hesitant"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Hesitant>(*this); }
  [[nodiscard]] double energy(const Step&) const override { return 0; }
  void add_forces(const Step&, std::span<Vec3>) const override {}
  void add_tangent_product(const Step&, std::span<const Vec3>, std::span<Vec3>) const override {}
  void add_tangent(const Step&, TangentSink&) const override {}
  [[nodiscard]] double max_fraction(const Step&, std::span<const Vec3>) const override {
    ++asked_;
    return 0.5;
  }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue&, const TissueChange&,
                                                  std::span<const Vec3>) const override {
    return clone();
  }

 private:
  int& asked_;
};

TEST(MaxFraction, BoundsEveryDirectionBeforeItIsTried) {
  const auto newton_iterations = [](const Extension& extension) {
    Simulation simulation(extended(extension, {"time.step_s=2", "time.end_s=4", "output.frame_every_s=0"}));
    double sum = 0;
    while (simulation.step()) sum += *simulation.measures()["newton_iterations"];
    EXPECT_EQ(simulation.status(), RunStatus::end_time) << simulation.failure();
    return sum;
  };
  int asked = 0;
  const double free = newton_iterations({});
  const double bound =
      newton_iterations([&](Model& model) { model.laws.push_back(std::make_unique<Hesitant>(asked)); });
  EXPECT_EQ(asked, bound);
  EXPECT_GT(bound, 3 * free) << "by halves it takes more";
}

}  // namespace
