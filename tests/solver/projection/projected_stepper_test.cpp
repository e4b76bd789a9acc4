// Linearly implicit steps, and those that project volumes afterwards.
#include "solver/projection/projected_stepper.hpp"

#include "core/threads.hpp"
#include "solver/make_stepper.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/law_checks.hpp"
#include "support/models.hpp"

namespace {

using Weights = ProjectionRule::Weights;
using Forces = StepScheme::Forces;

StepScheme scheme(Forces forces, Weights weights = Weights::equal) {
  return {.forces = forces, .linear_tolerance = 1e-10, .projection = ProjectionRule{.weights = weights}};
}

constexpr double slow = 1e-6;  // um/s; what is left of the way then is about 40 s of it

/// Steps until nothing moves any more, at most `most`.
State come_to_rest(Stepper& stepper, State state, double duration_s, int most) {
  State next;
  for (int k = 0; k < most; ++k) {
    const StepReport report = stepper.advance(state, duration_s, k == 0, next);
    EXPECT_TRUE(report.converged()) << report.reason() << " in step " << k;
    if (!report.converged()) break;
    std::swap(state, next);
    if (k > 0 && largest(state.velocities) < slow) return state;
  }
  ADD_FAILURE() << "still moving at " << largest(state.velocities) << " um/s";
  return state;
}

/// The dimpling sheet standing on its four corner nodes: a free one would swim (of weights that are not the drag's the
/// resultant is not zero).
Model sheet(bool volumes_are_held) {
  Model model = dimpling_sheet();
  for (std::size_t n = 0; n < model.held.size(); ++n) {
    const Vec3& x = model.tissue.rest_positions[n];
    if (std::abs(x.x()) > 29 && std::abs(x.y()) > 29 && x.z() < model.tissue.rest_positions[0].z() + 1)
      model.held[n] = {true, true, true};
  }
  model.volumes.hold(volumes_are_held);
  return model;
}

/// Forces of the laws without motion, nN.
Vectors still_forces(const Model& model, const State& state) {
  Vectors forces(state.positions.size(), Vec3::Zero());
  const Step still{state.positions, state.positions, state.velocities, 1, state.time_s};
  for (const auto& law : model.laws) law->add_forces(still, forces);
  return forces;
}

/// Nodes' drag and, where weights are equal, its mean, nN s/um.
Vectors drags(const Model& model) {
  Vectors drag(model.tissue.node_count(), Vec3::Zero());
  const Vectors& x = model.tissue.rest_positions;
  SurfaceDrag(model.tissue, usual_drag).add_tangent_product({x, x, x, 1, 0}, Vectors(drag.size(), Vec3::Ones()), drag);
  return drag;
}

// Where a splitting rests: f(x) + (D + h K) W J^T p = 0 to first order in h, W the projection's weights; and not where
// forces balance, f(x) + J^T p = 0 (docs/developers/paper-algorithm.md).
TEST(ProjectedStepper, RestsWhereTheoryHasIt) {
  const Model model = sheet(false);
  const Vectors drag = drags(model);
  double mean_drag = 0;
  for (const Vec3& d : drag) mean_drag += d.x() / static_cast<double>(drag.size());
  for (const Weights weights : {Weights::equal, Weights::mobility}) {
    double previous = 0;
    for (const double h : {0.4, 0.2}) {
      const auto stepper = make_stepper(model, scheme(Forces::linearly_implicit, weights));
      const State rest = come_to_rest(*stepper, rest_state(model), h, 4000);
      // W J^T p, and with it both balances.
      Vectors pushed(rest.positions.size(), Vec3::Zero()), balance = still_forces(model, rest);
      model.volumes.add_forces(rest.positions, rest.multipliers, pushed);
      const double size = largest(balance);
      Vectors plain = balance;
      for (std::size_t n = 0; n < plain.size(); ++n) plain[n] += pushed[n];
      if (weights == Weights::mobility)
        for (std::size_t n = 0; n < pushed.size(); ++n) pushed[n] /= drag[n].x();
      else
        for (Vec3& push : pushed) push /= mean_drag;
      Step step{rest.positions, rest.positions, rest.velocities, h, rest.time_s};
      step.semidefinite_tangent = true;
      for (std::size_t n = 0; n < pushed.size(); ++n) pushed[n] = model.held[n][0] ? Vec3(Vec3::Zero()) : h * pushed[n];
      for (const auto& law : model.laws) law->add_tangent_product(step, pushed, balance);
      for (std::size_t n = 0; n < balance.size(); ++n)
        if (model.held[n][0]) balance[n] = plain[n] = Vec3::Zero();
      const double of_theory = largest(balance) / size, of_forces = largest(plain) / size;
      std::printf("%s weights, h = %.2f s: %.1e off the predicted balance, %.1e off that of forces\n",
                  weights == Weights::equal ? "equal" : "mobility", h, of_theory, of_forces);
      EXPECT_LE(of_theory, 0.02);
      if (previous > 0) {
        EXPECT_LE(of_theory, 0.7 * previous);
      }
      previous = of_theory;
      EXPECT_GT(of_forces, 3 * of_theory);
    }
  }
}

// With the weights that belong to the drag the splitting comes to the coupled solve as the step gets short; with equal
// ones it goes elsewhere.
TEST(ProjectedStepper, ByMobilityComesToTheCoupledSolve) {
  const Model split = sheet(false), whole = sheet(true);
  StepScheme coupled_scheme;
  const auto coupled = make_stepper(whole, coupled_scheme);
  const State expected = come_to_rest(*coupled, rest_state(whole), 5, 2000);
  const auto off_coupled = [&](const StepScheme& of, double h) {
    State start = expected;  // from nearby: where it rests does not depend on the way
    std::fill(start.velocities.begin(), start.velocities.end(), Vec3::Zero());
    const State rest = come_to_rest(*make_stepper(split, of), start, h, 12000);
    return largest_distance(rest.positions, expected.positions);
  };
  for (const Forces forces : {Forces::newton, Forces::linearly_implicit}) {
    double previous = 0, previous_order = 0.4;
    for (const double h : {0.2, 0.1, 0.05}) {
      const double off = off_coupled(scheme(forces, Weights::mobility), h);
      std::printf("%s, h = %.2f s: rests %.4f um off the coupled solve", forces == Forces::newton ? "Newton" : "linear",
                  h, off);
      if (previous > 0) std::printf(", order %.2f", std::log2(previous / off));
      std::printf("\n");
      // The order comes up to 1 from below: a cell's stiffness over its drag is 10/s, so h = 0.05 s is not yet short.
      if (previous > 0) {
        EXPECT_GT(std::log2(previous / off), previous_order + 0.05);
        previous_order = std::log2(previous / off);
      }
      previous = off;
    }
    const double equal = off_coupled(scheme(forces, Weights::equal), 0.05);
    std::printf("the same with equal weights: %.4f um\n", equal);
    EXPECT_LT(previous, 0.05);
    EXPECT_GT(equal, 4 * previous);
  }
}

TEST(ProjectedStepper, EveryStepKeepsVolumesAndShell) {
  Model model = furrowing_sphere();
  model.volumes.hold(false);
  for (const Forces forces : {Forces::newton, Forces::linearly_implicit}) {
    const auto stepper = make_stepper(model, scheme(forces));
    State state = rest_state(model), next;
    for (int k = 0; k < 4; ++k) {
      const StepReport report = stepper->advance(state, 5, k == 0, next);
      ASSERT_TRUE(report.converged()) << report.reason();
      EXPECT_GT(report.cubics, 0);
      EXPECT_LE(report.constraint_error, 1e-9);
      for (const double error : model.volumes.relative_errors(next.positions)) EXPECT_LE(std::abs(error), 1e-9);
      for (const NodeId node : model.obstacles.front()->nodes())
        EXPECT_GE(model.obstacles.front()->gap(next.positions[node.index()]).value, -1e-6);
      for (std::size_t n = 0; n < next.positions.size(); ++n)
        EXPECT_LE((next.velocities[n] - (next.positions[n] - state.positions[n]) / 5).norm(), 1e-12);
      std::swap(state, next);
    }
  }
}

TEST(ProjectedStepper, OneAndTwoThreadsGiveTheSameBits) {
  Model model = furrowing_sphere();
  model.volumes.hold(false);
  for (const Forces forces : {Forces::newton, Forces::linearly_implicit}) {
    std::vector<State> ends;
    for (const int count : {1, 2}) {
      const ThreadCount scope(count);
      const auto stepper = make_stepper(model, scheme(forces));
      State state = rest_state(model), next;
      for (int k = 0; k < 3; ++k) {
        ASSERT_TRUE(stepper->advance(state, 3, k == 0, next).converged());
        std::swap(state, next);
      }
      ends.push_back(state);
    }
    EXPECT_EQ(ends[0].positions, ends[1].positions);
    EXPECT_EQ(ends[0].multipliers, ends[1].multipliers);
    EXPECT_EQ(ends[0].obstacle_forces, ends[1].obstacle_forces);
  }
}

// What a resumed run rests on: nothing is remembered but the State.
TEST(ProjectedStepper, AStepDoesNotDependOnTheOnesBefore) {
  const Model model = sheet(false);
  const auto used = make_stepper(model, scheme(Forces::linearly_implicit)),
             fresh = make_stepper(model, scheme(Forces::linearly_implicit));
  State state = rest_state(model), next, a, b;
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(used->advance(state, 2, k == 0, next).converged());
    std::swap(state, next);
  }
  ASSERT_TRUE(used->advance(state, 2, false, a).converged());
  ASSERT_TRUE(fresh->advance(state, 2, false, b).converged());
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.multipliers, b.multipliers);
}

TEST(ProjectedStepper, FailuresLeaveTheStateAlone) {
  Model model = sheet(false);
  StepScheme impatient = scheme(Forces::linearly_implicit);
  impatient.projection->most_sweeps = 1;
  State next;
  next.time_s = 77;
  const StepReport report = make_stepper(model, impatient)->advance(rest_state(model), 20, true, next);
  EXPECT_EQ(report.status, StepReport::Status::not_projected);
  EXPECT_TRUE(report.cell);
  const auto interrupted = make_stepper(model, scheme(Forces::newton));
  interrupted->stop_when([] { return true; });
  EXPECT_EQ(interrupted->advance(rest_state(model), 2, true, next).status, StepReport::Status::interrupted);
  EXPECT_EQ(next.time_s, 77);
  EXPECT_TRUE(next.positions.empty());
}

/// Some steps; every one has to converge.
State steps(Stepper& stepper, State state, double duration_s, int count) {
  State next;
  for (int k = 0; k < count; ++k) {
    const StepReport report = stepper.advance(state, duration_s, k == 0, next);
    EXPECT_TRUE(report.converged()) << report.reason() << " in step " << k;
    if (!report.converged()) break;
    std::swap(state, next);
  }
  return state;
}

double distance(const State& a, const State& b) { return largest_distance(a.positions, b.positions); }

/// A sheet without volumes or shell, some of it held; and where it is after a while of contraction.
Model held_sheet() {
  Model model = dimpling_sheet();
  model.volumes.hold(false);
  for (std::size_t n = 0; n < model.held.size(); n += 5) model.held[n] = {true, n % 2 == 0, false};
  return model;
}

// The step is A dx = f: conjugate gradients against a dense factor of the assembled tangents.
TEST(LinearlyImplicit, ConjugateGradientsAgreeWithADirectSolve) {
  const Model model = held_sheet();
  LinearlyImplicit rough(model, 1e-8, 1000);
  const State state = steps(rough, rest_state(model), 5, 3);
  const double duration_s = 7;
  Step step{state.positions, state.positions, state.velocities, duration_s, state.time_s + duration_s};
  step.semidefinite_tangent = true;
  const Eigen::Index size = 3 * static_cast<Eigen::Index>(state.positions.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size);
  Vectors forces(state.positions.size(), Vec3::Zero());
  for (const auto& law : model.laws) {
    A += DenseTangent(*law, step).matrix;
    law->add_forces(step, forces);
  }
  Eigen::VectorXd f = flat(forces);
  for (Eigen::Index i = 0; i < size; ++i)
    if (model.held[i / 3][i % 3]) {
      A.row(i).setZero();
      A.col(i).setZero();
      A(i, i) = 1;
      f[i] = 0;
    }
  ASSERT_EQ(A.llt().info(), Eigen::Success) << "not positive definite";
  const Eigen::VectorXd direct = A.llt().solve(f);
  for (const double tolerance : {1e-4, 1e-8, 1e-12}) {
    State next;
    const StepReport report = LinearlyImplicit(model, tolerance, 1000).advance(state, duration_s, false, next);
    ASSERT_TRUE(report.converged());
    EXPECT_LE(report.residual, tolerance);
    Vectors moved(next.positions.size());
    for (std::size_t n = 0; n < moved.size(); ++n) moved[n] = next.positions[n] - state.positions[n];
    EXPECT_LE((A * flat(moved) - f).norm(), (tolerance + 1e-12) * 1.1 * f.norm());
    const double off = (flat(moved) - direct).norm() / direct.norm();
    std::printf("tolerance %.0e: %d iterations, %.1e off the direct solve\n", tolerance, report.linear_solves, off);
    EXPECT_LE(off, 100 * tolerance + 1e-10);
  }
}

// Both are first-order methods for the same motion: their difference halves with the step.
TEST(LinearlyImplicit, ComesToNewtonsMotionAtFirstOrderInTheStep) {
  const Model model = held_sheet();
  const double time_s = 8;
  NewtonStepper newton(model);
  const State exact = steps(newton, rest_state(model), time_s / 512, 512);
  double previous = 0, previous_difference = 0;
  for (const int count : {16, 32, 64}) {
    LinearlyImplicit linear(model, 1e-10, 1000);
    NewtonStepper nonlinear(model);
    const State end = steps(linear, rest_state(model), time_s / count, count);
    const double error = distance(end, exact),
                 difference = distance(end, steps(nonlinear, rest_state(model), time_s / count, count));
    std::printf("%3d steps: %.4f um off the limit, %.4f um off Newton's steps", count, error, difference);
    if (previous > 0)
      std::printf(", orders %.2f %.2f", std::log2(previous / error), std::log2(previous_difference / difference));
    std::printf("\n");
    if (count == 64) {
      EXPECT_NEAR(std::log2(previous_difference / difference), 1, 0.15);
      EXPECT_NEAR(std::log2(previous / error), 1, 0.3);
    }
    previous = error;
    previous_difference = difference;
  }
}

TEST(LinearlyImplicit, HeldDirectionsStayAndRestStaysAtRest) {
  const Model model = held_sheet();
  LinearlyImplicit stepper(model, 1e-6, 1000);
  const State end = steps(stepper, rest_state(model), 5, 4);
  for (std::size_t n = 0; n < model.held.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (model.held[n][axis]) {
        EXPECT_EQ(end.positions[n][axis], model.tissue.rest_positions[n][axis]);
      }
  Model idle(build_block({.cells = {2, 2, 1}}));
  add_elasticity(idle);
  add_drag(idle);
  LinearlyImplicit on_idle(idle, 1e-6, 1000);
  EXPECT_LE(distance(steps(on_idle, rest_state(idle), 10, 1), rest_state(idle)), 1e-10);
}

// The active force is that of the step's end, as in Newton's step.
TEST(LinearlyImplicit, ContractionIsThatOfTheEndOfTheStep) {
  const double duration_s = 2;
  Vectors ends[2];
  for (const bool ramp : {false, true}) {
    Model model(build_block({.length_um = 40, .width_um = 20, .cell_height_um = 40, .cells = {2, 1, 1}}));
    add_elasticity(model);
    add_contraction(model, {true, false}, {.stiffness = 3}, ramp ? Program({0, duration_s}, {0, 1}) : Program{});
    add_drag(model);
    LinearlyImplicit stepper(model, 1e-10, 1000);
    ends[ramp] = steps(stepper, rest_state(model), duration_s, 1).positions;
    EXPECT_GT((ends[ramp].front() - model.tissue.rest_positions.front()).norm(), 1e-3);
  }
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(LinearlyImplicit, FailuresAreReportedAndLeaveTheStateAlone) {
  const Model model = held_sheet();
  State next;
  next.time_s = 77;
  EXPECT_EQ(LinearlyImplicit(model, 1e-12, 2).advance(rest_state(model), 5, true, next).status,
            StepReport::Status::no_linear_convergence);
  State lost = rest_state(model);
  lost.positions[3].x() = NAN;
  EXPECT_EQ(LinearlyImplicit(model, 1e-6, 100).advance(lost, 5, true, next).status, StepReport::Status::not_finite);
  LinearlyImplicit interrupted(model, 1e-6, 100);
  interrupted.stop_when([] { return true; });
  EXPECT_EQ(interrupted.advance(rest_state(model), 5, true, next).status, StepReport::Status::interrupted);
  EXPECT_EQ(next.time_s, 77);
  EXPECT_TRUE(next.positions.empty());
}

}  // namespace
