// Differences in time of first and second order, and contacts that come and go within a step.
#include "solver/step/backward_difference.hpp"

#include "solver/step/newton_stepper.hpp"
#include "support/models.hpp"
#include "tissue/division.hpp"

namespace {

using Way = std::function<Vec3(double)>;

/// States of one node on its way at the ends of steps of these lengths.
std::vector<State> states_of(const Way& at, const std::vector<double>& steps_s, TimeOrder order) {
  State state;
  state.positions = {at(0)};
  state.velocities = {Vec3::Zero()};
  std::vector<State> states = {state};
  for (const double step_s : steps_s) {
    State next = states.back();
    next.time_s += step_s;
    next.positions = {at(next.time_s)};
    record_motion(states.back(), step_s, std::min(order, possible_order(states.back(), step_s)), next);
    states.push_back(next);
  }
  return states;
}

Vec3 quadratic(double t) { return {3 - 2 * t, 1 + t * t, t - 0.5 * t * t}; }
Vec3 rate_of_quadratic(double t) { return {-2, 2 * t, 1 - t}; }

TEST(BackwardDifference, VelocitiesOfSecondOrderAreExactForConstantAccelerations) {
  const std::vector<double> steps_s = {0.5, 0.5, 1, 0.1, 0.24, 0.3};
  const auto states = states_of(quadratic, steps_s, TimeOrder::second);
  for (std::size_t k = 2; k < states.size(); ++k) {
    const double time_s = states[k].time_s, step_s = steps_s[k - 1];
    EXPECT_NEAR((states[k].velocities[0] - rate_of_quadratic(time_s)).norm(), 0, 1e-12) << "step " << k;
    EXPECT_NEAR((mean_velocities(states[k])[0] - rate_of_quadratic(time_s - step_s / 2)).norm(), 0, 1e-12);
    EXPECT_NEAR((states[k].trend.accelerations[0] - Vec3(0, 2, -1)).norm(), 0, 1e-12);
  }
}

TEST(BackwardDifference, OfFirstOrderVelocitiesAreMeans) {
  const auto states = states_of(quadratic, {0.5, 1.5}, TimeOrder::first);
  EXPECT_NEAR((states[2].velocities[0] - rate_of_quadratic(1.25)).norm(), 0, 1e-12);
  EXPECT_EQ(mean_velocities(states[2]), states[2].velocities);
}

/// What rates at the end of the step to `after` are reckoned from.
Vec3 before_of(const State& before, const State& earlier, const BackwardDifference& rates) {
  Step step;
  step.previous_positions = before.positions;
  step.earlier_positions = earlier.positions;
  step.ahead = rates.ahead;
  return step.before([](std::span<const Vec3> x) { return x[0]; });
}

// The velocity that laws see in a step is the one that the state has after it.
TEST(BackwardDifference, LawsSeeTheVelocityAtTheEnd) {
  const auto states = states_of([](double t) { return Vec3(std::exp(-t), std::sin(t), t * t * t); },
                                {0.4, 0.7, 0.2, 0.4}, TimeOrder::second);
  for (std::size_t k = 1; k < states.size(); ++k) {
    const State &before = states[k - 1], &after = states[k];
    const BackwardDifference rates = k > 1 ? backward_difference(after.trend.step_s, before.trend.step_s)
                                           : BackwardDifference{after.trend.step_s, 0};
    const Vec3 seen = (after.positions[0] - before_of(before, states[k > 1 ? k - 2 : 0], rates)) / rates.rate_s;
    EXPECT_NEAR((seen - after.velocities[0]).norm(), 0, 1e-12) << "step " << k;
  }
  const BackwardDifference even = backward_difference(3, 3);
  EXPECT_DOUBLE_EQ(even.rate_s, 2);  // 2/3 h, and 4/3 x_n - 1/3 x_(n-1): the constants of every textbook
  EXPECT_DOUBLE_EQ(even.ahead, 1.0 / 3);
}

// One step of x' = g(t), begun from exact values, is off by the estimate: exactly where the third derivative is
// constant (for first order the second).
TEST(BackwardDifference, TheErrorOfAStepIsThatOfTheEquationItSolves) {
  const std::vector<double> steps_s = {0.3, 0.5, 0.4, 0.8};
  const auto error_of_last = [&](const Way& at, const Way& rate, TimeOrder order) {
    const auto states = states_of(at, steps_s, order);
    const State &before = states[states.size() - 2], &after = states.back();
    const BackwardDifference rates = order == TimeOrder::second
                                         ? backward_difference(after.trend.step_s, before.trend.step_s)
                                         : BackwardDifference{after.trend.step_s, 0};
    const Vec3 solved = before_of(before, states[states.size() - 3], rates) + rates.rate_s * rate(after.time_s);
    const StepError estimate = step_error(before, after).value();
    EXPECT_EQ(estimate.order, order);
    EXPECT_NEAR(estimate.um, (solved - after.positions[0]).norm(), 1e-12);
    return estimate.um;
  };
  const double first = error_of_last(quadratic, rate_of_quadratic, TimeOrder::first);
  EXPECT_NEAR(first, 0.5 * 0.8 * 0.8 * std::sqrt(5.0), 1e-12);
  const double second = error_of_last([](double t) { return Vec3(t * t * t, 0, 2 * t); },
                                      [](double t) { return Vec3(3 * t * t, 0, 2); }, TimeOrder::second);
  EXPECT_GT(second, 0);
  EXPECT_NEAR(error_of_last(quadratic, rate_of_quadratic, TimeOrder::second), 0, 1e-12);
}

TEST(BackwardDifference, NothingIsKnownOfTheErrorOfAFirstStepAndTooMuchIsSaidOfTheSecond) {
  const auto states = states_of(quadratic, {0.5, 0.5}, TimeOrder::second);
  EXPECT_FALSE(step_error(states[0], states[1]).has_value());
  const StepError second = step_error(states[1], states[2]).value();
  EXPECT_NEAR(second.um, 0.5 * 0.25 * std::sqrt(5.0), 1e-12);
  EXPECT_EQ(second.order, TimeOrder::first);
}

TEST(BackwardDifference, StepsThatGrowTooMuchAreOfFirstOrder) {
  const auto states = states_of(quadratic, {0.5, 0.5}, TimeOrder::second);
  EXPECT_EQ(possible_order(states[0], 0.5), TimeOrder::first) << "nothing is known at the start";
  EXPECT_EQ(possible_order(states[2], 1.2), TimeOrder::second);
  EXPECT_EQ(possible_order(states[2], 0.5 * (1 + std::sqrt(2.0))), TimeOrder::first);
}

// Three nodes joined by linear springs, of which each moves along z: forces load - stiffness z.
const Mat3 stiffness = (Mat3() << 46, -21, 48, -21, 36, -41, 48, -41, 66).finished();  // nN/um, positive definite
const Vec3 load(-2, 8, -8);                                                            // nN

class Coupling final : public Law {
 public:
  explicit Coupling(std::array<NodeId, 3> nodes, Vectors rest) : nodes_(nodes), rest_(std::move(rest)) {}
  [[nodiscard]] std::string_view name() const override { return "coupling"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Coupling>(*this); }
  [[nodiscard]] double energy(const Step& step) const override {
    const Vec3 z = heights(step.positions);
    return 0.5 * z.dot(stiffness * z) - load.dot(z);
  }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    const Vec3 f = load - stiffness * heights(step.positions);
    for (int k = 0; k < 3; ++k) forces[nodes_[k].index()].z() += f[k];
  }
  void add_tangent_product(const Step&, std::span<const Vec3> direction, std::span<Vec3> product) const override {
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) product[nodes_[k].index()].z() += stiffness(k, l) * direction[nodes_[l].index()].z();
  }
  void add_tangent(const Step&, TangentSink& tangent) const override {
    for (int k = 0; k < 3; ++k)
      for (int l = k; l < 3; ++l)
        tangent.add_block(nodes_[k], nodes_[l], Vec3(0, 0, stiffness(k, l)).asDiagonal().toDenseMatrix());
  }
  [[nodiscard]] NodeGroups node_groups(std::span<const double>) const override {
    NodeGroups groups;
    groups.add(nodes_);
    return groups;
  }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue&, const TissueChange&,
                                                  std::span<const Vec3>) const override {
    return clone();
  }

 private:
  [[nodiscard]] Vec3 heights(std::span<const Vec3> x) const {
    Vec3 z;
    for (int k = 0; k < 3; ++k) z[k] = x[nodes_[k].index()].z() - rest_[nodes_[k].index()].z();
    return z;
  }
  std::array<NodeId, 3> nodes_;
  Vectors rest_;
};

/// The three nodes stay above where they lie at rest.
class Floor final : public Obstacle {
 public:
  Floor(std::array<NodeId, 3> nodes, double height) : nodes_(nodes), height_(height) {}
  [[nodiscard]] std::string_view name() const override { return "floor"; }
  [[nodiscard]] std::unique_ptr<Obstacle> clone() const override { return std::make_unique<Floor>(*this); }
  [[nodiscard]] std::span<const NodeId> nodes() const override { return nodes_; }
  [[nodiscard]] Gap gap(const Vec3& x) const override { return {x.z() - height_, Vec3::UnitZ(), Mat3::Zero()}; }
  [[nodiscard]] std::unique_ptr<Obstacle> after_change(const Tissue&, const TissueChange&) const override {
    return clone();
  }

 private:
  std::array<NodeId, 3> nodes_;
  double height_;
};

// Changing every contact at once, this goes (none) -> ... -> the same again, in a step of any length that matters.
TEST(ContactCycle, Ends) {
  Model model(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 20, .cells = {1, 1, 1}}));
  model.volumes.hold(false);
  std::vector<NodeId> low;
  double floor = 1e9;
  for (const Vec3& x : model.tissue.rest_positions) floor = std::min(floor, x.z());
  for (std::size_t n = 0; n < model.tissue.node_count(); ++n)
    if (model.tissue.rest_positions[n].z() < floor + 1e-9) low.emplace_back(n);
  const std::array<NodeId, 3> nodes = {low[0], low[1], low[2]};
  for (auto& held : model.held) held = {true, true, true};
  for (const NodeId node : nodes) model.held[node.index()] = {true, true, false};
  model.laws.push_back(std::make_unique<Coupling>(nodes, model.tissue.rest_positions));
  model.obstacles.push_back(std::make_unique<Floor>(nodes, floor));

  NewtonStepper stepper(model);
  State end;
  const StepReport report = stepper.advance(rest_state(model), 1, true, end);
  ASSERT_TRUE(report.converged()) << report.reason();
  Vec3 z, force;
  for (int k = 0; k < 3; ++k) z[k] = end.positions[nodes[k].index()].z() - floor, force[k] = end.obstacle_forces[k];
  EXPECT_LE((stiffness * z - load - force).norm(), 1e-7);
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(z[k], -1e-8);
    EXPECT_GE(force[k], 0);
    EXPECT_LE(z[k] * force[k], 1e-7);
  }
}

}  // namespace
