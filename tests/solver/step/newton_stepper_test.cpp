#include "solver/step/newton_stepper.hpp"

#include "core/threads.hpp"
#include "mechanics/obstacles/vitelline.hpp"
#include "support/loads.hpp"
#include "support/models.hpp"

namespace {

/// Several steps; every one has to converge.
State steps(NewtonStepper& solver, State state, double duration_s, int count, State* before_last = nullptr) {
  State next;
  for (int k = 0; k < count; ++k) {
    const StepReport report = solver.advance(state, duration_s, k == 0, next);
    EXPECT_TRUE(report.converged()) << report.reason() << " in step " << k;
    if (!report.converged()) break;
    if (before_last != nullptr) *before_last = state;
    std::swap(state, next);
  }
  return state;
}

double worst_volume_error(const Model& model, const State& state) {
  double worst = 0;
  for (const double error : model.volumes.relative_errors(state.positions)) worst = std::max(worst, std::abs(error));
  return worst;
}

TEST(NewtonStepper, AStepBalancesForcesAndKeepsVolumes) {
  for (const std::array<int, 3>& elements : {std::array<int, 3>{1, 1, 1}, {2, 1, 2}}) {
    const Model model = dimpling_sheet(elements);
    NewtonStepper solver(model);
    for (const double duration : {0.05, 2.0, 60.0}) {
      const State before = rest_state(model);
      State after;
      const StepReport report = solver.advance(before, duration, true, after);
      ASSERT_TRUE(report.converged()) << report.reason();
      EXPECT_LE(largest(unbalanced_forces(model, before, after)), 1e-7 * force_size(model, before, after));
      EXPECT_LE(worst_volume_error(model, after), 1e-10);
      EXPECT_LE(report.constraint_error, 1e-10);
      EXPECT_EQ(after.time_s, duration);
      for (std::size_t n = 0; n < after.positions.size(); ++n)
        EXPECT_LE((after.velocities[n] - (after.positions[n] - before.positions[n]) / duration).norm(), 1e-12);
    }
  }
}

TEST(NewtonStepper, WithoutTheConstraintVolumesAreFree) {
  Model model = dimpling_sheet();
  model.volumes.hold(false);
  NewtonStepper solver(model);
  const State before = rest_state(model);
  State after;
  ASSERT_TRUE(solver.advance(before, 2, true, after).converged());
  EXPECT_LE(largest(unbalanced_forces(model, before, after)), 1e-7 * force_size(model, before, after));
  EXPECT_GT(worst_volume_error(model, after), 1e-6);
}

TEST(NewtonStepper, HeldDirectionsDoNotMoveAndOthersBalance) {
  Model model = dimpling_sheet();
  for (std::size_t n = 0; n < model.held.size(); ++n) {
    const Vec3& X = model.tissue.rest_positions[n];
    if (X.x() == -30) model.held[n] = {true, false, X.z() > 0};
    if (X.x() == 30) model.held[n] = {true, true, true};
  }
  NewtonStepper solver(model);
  const State before = rest_state(model);
  State after;
  ASSERT_TRUE(solver.advance(before, 10, true, after).converged());
  const Vectors forces = unbalanced_forces(model, before, after);
  const double size = force_size(model, before, after);
  int held = 0;
  for (std::size_t n = 0; n < forces.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (model.held[n][axis]) {
        EXPECT_EQ(after.positions[n][axis], before.positions[n][axis]);
        ++held;
      } else {
        EXPECT_LE(std::abs(forces[n][axis]), 1e-7 * size);
      }
  EXPECT_EQ(held, 8 * 1 + 4 + 8 * 3);
}

// Hydrostatics: a sphere whose cells keep their volume cannot grow into a rigid shell, so an inner pressure p passes
// through: every cell has pressure p, and the shell carries p times its area.
TEST(NewtonStepper, PressurisedSphereRestsOnItsShell) {
  Model model(build_shell({.length_um = 280, .cells = {9, 9, 8}}));
  add_elasticity(model);
  add_drag(model);
  const double pressure = 0.01;
  model.laws.push_back(std::make_unique<FacePressure>(model.tissue, CellSide::basal,
                                                      CellSet(model.tissue.cells.size(), true), pressure, Program{}));
  model.obstacles.push_back(std::make_unique<Vitelline>(model.tissue, *model.tissue.outer_shape));
  NewtonStepper solver(model);
  State before;
  const State after = steps(solver, rest_state(model), 20, 10, &before);
  EXPECT_LE(largest(unbalanced_forces(model, before, after)), 1e-7 * force_size(model, before, after));
  double total = 0;
  for (std::size_t k = 0; k < after.obstacle_forces.size(); ++k) {
    const std::size_t n = model.obstacles.front()->nodes()[k].index();
    EXPECT_GE(after.obstacle_forces[k], 0);
    EXPECT_GE(model.obstacles.front()->gap(after.positions[n]).value, -1e-8);
    total += after.obstacle_forces[k];
  }
  double area = 0;
  for (const Facet& facet : model.tissue.apical_facets) {
    std::array<Vec3, 4> points;
    for (int i = 0; i < 4; ++i) points[i] = after.positions[facet.nodes[i].index()];
    area += facet_area(points);
  }
  std::printf("pressurised sphere: shell carries %.4f of p A\n", total / (pressure * area));
  EXPECT_NEAR(total / (pressure * area), 1, 0.02);
  for (const double p : after.multipliers) EXPECT_NEAR(p, pressure, 0.05 * pressure);
}

// Complementarity where part of the surface leaves the shell.
TEST(NewtonStepper, NodesAreEitherOnTheShellOrFreeOfIt) {
  const Model model = furrowing_sphere();
  NewtonStepper solver(model);
  State before;
  int on_shell = 0, off_shell = 0;
  State state = rest_state(model);
  for (int k = 0; k < 5; ++k) {
    before = state;
    ASSERT_TRUE(solver.advance(before, 5, k == 0, state).converged());
    EXPECT_LE(largest(unbalanced_forces(model, before, state)), 1e-7 * force_size(model, before, state));
    EXPECT_LE(worst_volume_error(model, state), 1e-10);
    on_shell = off_shell = 0;
    for (std::size_t i = 0; i < state.obstacle_forces.size(); ++i) {
      const double gap =
          model.obstacles.front()->gap(state.positions[model.obstacles.front()->nodes()[i].index()]).value;
      EXPECT_GE(state.obstacle_forces[i], 0);
      EXPECT_GE(gap, -1e-8);
      EXPECT_EQ(state.on_obstacle[i] != 0, gap <= 1e-8 && state.on_obstacle[i] != 0);
      if (state.obstacle_forces[i] > 0) {
        EXPECT_LE(gap, 1e-8) << "a force at a distance";
      }
      (state.on_obstacle[i] ? on_shell : off_shell) += 1;
    }
  }
  std::printf("furrowing sphere: %d nodes on the shell, %d off it\n", on_shell, off_shell);
  EXPECT_GT(on_shell, 50);
  EXPECT_GT(off_shell, 50);
}

// A scenario may hold nodes that also lie on the shell.
TEST(NewtonStepper, HeldNodesOnTheShellStayWhereTheyAre) {
  Model model = furrowing_sphere();
  std::vector<std::size_t> held;
  for (std::size_t c = 0; c < model.tissue.cells.size(); ++c)
    if (model.tissue.cells[c].grid_place->face == GridPlace::Face::anterior)
      for (int corner = 4; corner < 8; ++corner) held.push_back(model.tissue.cells[c].corners[corner].index());
  for (const std::array<bool, 3>& directions :
       {std::array<bool, 3>{true, true, true}, {true, false, false}, {false, true, true}}) {
    for (const std::size_t n : held) model.held[n] = directions;
    NewtonStepper solver(model);
    State after;
    const StepReport report = solver.advance(rest_state(model), 5, true, after);
    EXPECT_TRUE(report.converged()) << report.reason() << " with held directions " << directions[0] << directions[1]
                                    << directions[2];
    if (!report.converged()) continue;
    for (const std::size_t n : held)
      for (int axis = 0; axis < 3; ++axis)
        if (directions[axis]) {
          EXPECT_NEAR(after.positions[n][axis], model.tissue.rest_positions[n][axis], 1e-12);
        }
  }
}

TEST(NewtonStepper, OneAndTwoThreadsGiveTheSameBits) {
  const Model model = furrowing_sphere();
  std::vector<State> ends;
  for (const int count : {1, 2}) {
    const ThreadCount scope(count);
    NewtonStepper solver(model);
    ends.push_back(steps(solver, rest_state(model), 2, 4));
  }
  EXPECT_EQ(ends[0].positions, ends[1].positions);
  EXPECT_EQ(ends[0].multipliers, ends[1].multipliers);
  EXPECT_EQ(ends[0].obstacle_forces, ends[1].obstacle_forces);
}

// What a resumed run rests on.
TEST(NewtonStepper, AfterForgettingItsFactorAStepDoesNotDependOnTheOnesBefore) {
  const Model model = dimpling_sheet();
  NewtonStepper used(model), fresh(model);
  const State state = steps(used, rest_state(model), 2, 3);
  used.forget_factor();
  State a, b;
  ASSERT_TRUE(used.advance(state, 2, false, a).converged());
  ASSERT_TRUE(fresh.advance(state, 2, false, b).converged());
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.multipliers, b.multipliers);
}

// Motion that would go on too far, or nowhere.
TEST(NewtonStepper, APoorForecastIsLeft) {
  const Model model = dimpling_sheet();
  NewtonStepper solver(model);
  State state = steps(solver, rest_state(model), 2, 3);
  const auto end_of_step = [&](bool from_rest) {
    NewtonStepper fresh(model);
    State next;
    const StepReport report = fresh.advance(state, 2, from_rest, next);
    EXPECT_TRUE(report.converged()) << report.reason();
    return next.positions;
  };
  const Vectors from_state = end_of_step(true);
  EXPECT_NE(end_of_step(false), from_state);  // a good one is not
  for (const double rate : {1e6, std::numeric_limits<double>::quiet_NaN()}) {
    std::ranges::fill(state.trend.multiplier_rates, rate);
    EXPECT_EQ(end_of_step(false), from_state);
  }
}

TEST(NewtonStepper, RestStaysAtRest) {
  Model model(build_block({.cells = {2, 2, 1}}));
  add_elasticity(model);
  add_drag(model);
  NewtonStepper solver(model);
  State after;
  const StepReport report = solver.advance(rest_state(model), 10, true, after);
  ASSERT_TRUE(report.converged());
  for (std::size_t n = 0; n < after.positions.size(); ++n)
    EXPECT_LE((after.positions[n] - model.tissue.rest_positions[n]).norm(), 1e-10);
}

TEST(NewtonStepper, AStepThatFailsSaysSoAndLeavesTheStateAlone) {
  Model model = dimpling_sheet();
  Vectors loads(model.tissue.node_count(), Vec3::Zero());
  loads[0].x() = std::numeric_limits<double>::quiet_NaN();
  model.laws.push_back(std::make_unique<NodalForces>(loads));
  NewtonStepper solver(model);
  State next;
  next.time_s = 77;
  const StepReport report = solver.advance(rest_state(model), 1, true, next);
  EXPECT_EQ(report.status, StepReport::Status::not_finite);
  EXPECT_FALSE(report.reason().empty());
  EXPECT_EQ(next.time_s, 77);
  EXPECT_TRUE(next.positions.empty());
}

TEST(NewtonStepper, AStepThatIsNotSolvedInTimeIsNotTaken) {
  const Model model = dimpling_sheet();
  NewtonStepper solver(model, {.max_iterations = 2});
  State next;
  next.time_s = 77;
  const StepReport report = solver.advance(rest_state(model), 60, true, next);
  EXPECT_EQ(report.status, StepReport::Status::no_convergence);
  EXPECT_EQ(report.newton_iterations, 2);
  EXPECT_TRUE(report.cell);
  EXPECT_EQ(next.time_s, 77);
  EXPECT_TRUE(next.positions.empty());
}

/// Springs of all nodes to 1 nm beside their places, of a tangent that is a thousandth of what it should be: every
/// direction overshoots so far that no part of it that is tried helps.
class MisjudgedSprings final : public Law {
 public:
  [[nodiscard]] std::string_view name() const override { return "misjudged springs"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<MisjudgedSprings>(*this); }
  [[nodiscard]] double energy(const Step&) const override { return 0; }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    for (std::size_t n = 0; n < forces.size(); ++n)
      forces[n] += stiffness * (step.previous_positions[n] + Vec3(1e-3, 0, 0) - step.positions[n]);
  }
  void add_tangent_product(const Step&, std::span<const Vec3> direction, std::span<Vec3> product) const override {
    for (std::size_t n = 0; n < product.size(); ++n) product[n] += 1e-3 * stiffness * direction[n];
  }
  void add_tangent(const Step& step, TangentSink& tangent) const override {
    for (std::size_t n = 0; n < step.positions.size(); ++n)
      tangent.add_block(NodeId(n), NodeId(n), 1e-3 * stiffness * Mat3::Identity());
  }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue&, const TissueChange&,
                                                  std::span<const Vec3>) const override {
    return clone();
  }

 private:
  static constexpr double stiffness = 1;  // nN/um
};

TEST(NewtonStepper, GivesUpAfterThreeSearchesThatTakeNextToNothing) {
  Model model(build_block({.cells = {2, 1, 1}}));
  model.volumes.hold(false);
  model.laws.push_back(std::make_unique<MisjudgedSprings>());
  NewtonStepper solver(model);
  State after;
  const StepReport report = solver.advance(rest_state(model), 1, true, after);
  EXPECT_EQ(report.status, StepReport::Status::no_convergence);
  EXPECT_EQ(report.newton_iterations, 3);
}

// Asked before every iteration, of Newton and Krylov; a request that comes in the middle of a step is heard there.
TEST(NewtonStepper, AnInterruptedStepSaysSoAndLeavesTheStateAlone) {
  const Model model = dimpling_sheet();
  NewtonStepper solver(model);
  for (const int answers : {0, 1, 2}) {
    int asked = 0;
    solver.stop_when([&] { return asked++ >= answers; });
    State next;
    next.time_s = 77;
    const StepReport report = solver.advance(rest_state(model), 2, true, next);
    EXPECT_EQ(report.status, StepReport::Status::interrupted);
    EXPECT_FALSE(report.converged());
    EXPECT_FALSE(report.reason().empty());
    EXPECT_LE(report.newton_iterations, answers);
    EXPECT_EQ(next.time_s, 77);
    EXPECT_TRUE(next.positions.empty() && next.velocities.empty() && next.multipliers.empty());
  }
  // Interruption leaves nothing behind: the step solved afterwards is that of a new solver.
  State after, expected;
  solver.stop_when([] { return false; });
  solver.forget_factor();
  ASSERT_TRUE(solver.advance(rest_state(model), 2, true, after).converged());
  ASSERT_TRUE(NewtonStepper(model).advance(rest_state(model), 2, true, expected).converged());
  EXPECT_EQ(after.positions, expected.positions);
}

// The volume of a cell that cannot move needs no pressure: its constraint must not make the system singular.
TEST(NewtonStepper, WholeCellsMayBeHeldWithTheirVolumes) {
  for (const std::array<int, 3>& elements : {std::array<int, 3>{1, 1, 1}, {2, 1, 2}})
    for (const std::vector<int>& held : {std::vector<int>{0}, {4}, {0, 1, 8}, {0, 1, 2, 3, 4, 5, 6, 7, 8}}) {
      Model model = dimpling_sheet(elements);
      for (const int cell : held)
        for (std::size_t e = 0; e < model.tissue.elements.size(); ++e)
          if (model.tissue.element_cell[e] == CellId(cell))
            for (const NodeId node : model.tissue.elements[e]) model.held[node.index()] = {true, true, true};
      NewtonStepper solver(model);
      State before = rest_state(model), after;
      for (int k = 0; k < 3; ++k) {
        const StepReport report = solver.advance(before, 5, k == 0, after);
        ASSERT_TRUE(report.converged()) << report.reason() << " with " << held.size() << " cells held";
        for (std::size_t n = 0; n < after.positions.size(); ++n)
          if (model.held[n][0]) {
            EXPECT_EQ(after.positions[n], model.tissue.rest_positions[n]);
          }
        for (const double pressure : after.multipliers) EXPECT_TRUE(std::isfinite(pressure));
        EXPECT_LE(worst_volume_error(model, after), 1e-10);
        std::swap(before, after);
      }
    }
}

/// One cell, 20 um each way, that nothing but drag resists: 14 nN s/um on each node.
Model dragged_cell() {
  Model model(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 20, .cells = {1, 1, 1}}));
  model.volumes.hold(false);
  add_drag(model);
  return model;
}

/// The same vector on the cell's four upper nodes.
Vectors on_upper_nodes(const Model& model, const Vec3& vector) {
  Vectors vectors(model.tissue.node_count(), Vec3::Zero());
  for (const Facet& facet : model.tissue.apical_facets)
    for (const NodeId node : facet.nodes) vectors[node.index()] = vector;
  return vectors;
}

// Drag alone would let the upper nodes through the lower ones, and the system is linear: its solution is where they
// come to, and may be solved for only as long as it is upright.
TEST(NewtonStepper, NoStepEndsInsideOut) {
  constexpr double duration_s = 10, drag_of_node = usual_drag * 20 * 20 / 4;
  for (const double down_um : {5.0, 15.0, 19.0, 21.0, 25.0, 30.0, 60.0}) {
    Model model = dragged_cell();
    model.laws.push_back(
        std::make_unique<NodalForces>(on_upper_nodes(model, Vec3(0, 0, -drag_of_node * down_um / duration_s))));
    NewtonStepper solver(model);
    State after;
    const StepReport report = solver.advance(rest_state(model), duration_s, true, after);
    EXPECT_EQ(report.converged(), down_um < 20) << down_um << " um: " << report.reason();
    if (report.converged()) {
      EXPECT_FALSE(inverted_cell(model.tissue, after.positions)) << down_um << " um";
      const Vectors down = on_upper_nodes(model, Vec3(0, 0, -down_um));
      for (std::size_t n = 0; n < down.size(); ++n)
        EXPECT_LE((after.positions[n] - model.tissue.rest_positions[n] - down[n]).norm(), 1e-6 * down_um);
    } else {
      EXPECT_TRUE(report.cell) << "says where";
    }
  }
}

/// Pulls nodes back to a height with a force that hardly grows where they are far from it: strength u/sqrt(1 + u^2).
class SoftTether final : public Law {
 public:
  SoftTether(Vectors homes, double strength) : homes_(std::move(homes)), strength_(strength) {}
  [[nodiscard]] std::string_view name() const override { return "soft tether"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<SoftTether>(*this); }
  [[nodiscard]] double energy(const Step& step) const override {
    double sum = 0;
    for (std::size_t n = 0; n < homes_.size(); ++n) sum += strength_ * std::hypot(1, away(step, n));
    return sum;
  }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    for (std::size_t n = 0; n < homes_.size(); ++n)
      forces[n].z() -= strength_ * away(step, n) / std::hypot(1, away(step, n));
  }
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override {
    for (std::size_t n = 0; n < homes_.size(); ++n) product[n].z() += slope(step, n) * direction[n].z();
  }
  void add_tangent(const Step& step, TangentSink& tangent) const override {
    for (std::size_t n = 0; n < homes_.size(); ++n)
      tangent.add_block(NodeId(n), NodeId(n), slope(step, n) * Vec3::UnitZ() * Vec3::UnitZ().transpose());
  }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue&, const TissueChange&,
                                                  std::span<const Vec3>) const override {
    return clone();
  }

 private:
  [[nodiscard]] double away(const Step& step, std::size_t n) const { return step.positions[n].z() - homes_[n].z(); }
  [[nodiscard]] double slope(const Step& step, std::size_t n) const {
    return strength_ / std::pow(std::hypot(1, away(step, n)), 3);
  }
  Vectors homes_;
  double strength_;
};

// Where a force levels off, Newton's full steps go ever farther: from 3 um to -11, then to 2000. With a load of half
// the tether's strength it rests at 1/sqrt(3) um.
TEST(NewtonStepper, GoesOnlyAsFarAsItHelps) {
  Model model = dragged_cell();
  constexpr double strength = 1e6;  // nN: drag is nothing beside it
  for (auto& held : model.held) held = {true, true, false};
  model.laws.push_back(std::make_unique<SoftTether>(model.tissue.rest_positions, strength));
  model.laws.push_back(std::make_unique<NodalForces>(Vectors(model.tissue.node_count(), Vec3(0, 0, 0.5 * strength))));
  State before = rest_state(model), after;
  for (Vec3& x : before.positions) x.z() += 3;
  NewtonStepper solver(model);
  const StepReport report = solver.advance(before, 1000, true, after);
  ASSERT_TRUE(report.converged()) << report.reason();
  for (std::size_t n = 0; n < after.positions.size(); ++n)
    EXPECT_NEAR(after.positions[n].z() - model.tissue.rest_positions[n].z(), 1 / std::sqrt(3), 1e-5);
}

}  // namespace
