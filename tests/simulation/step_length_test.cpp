#include "simulation/controls.hpp"
#include "support/testing.hpp"

namespace {

/// States of one node at the ends of steps along x.
class Path {
 public:
  explicit Path(TimeOrder order = TimeOrder::first) : order_(order) {
    state_.positions = {Vec3::Zero()};
    state_.velocities = {Vec3::Zero()};
  }
  [[nodiscard]] const State& here() const { return state_; }
  [[nodiscard]] State after(double step_s, double x_um) const {
    State next;
    next.time_s = state_.time_s + step_s;
    next.positions = {Vec3(x_um, 0, 0)};
    record_motion(state_, step_s, std::min(order_, possible_order(state_, step_s)), next);
    return next;
  }
  void go_to(State next) { state_ = std::move(next); }

 private:
  TimeOrder order_;
  State state_;
};

double proposed(const StepLength& length, const RunControls& controls, double time_s) {
  return length.propose_end_s(controls, time_s) - time_s;
}

TEST(StepLength, FixedStepsStayOnTheirGridAndEndOnTime) {
  RunControls controls{.fixed_step_s = 0.3, .end_s = 1};
  const StepLength length(controls);
  EXPECT_DOUBLE_EQ(proposed(length, controls, 0), 0.3);
  EXPECT_NEAR(proposed(length, controls, 0.6), 0.3, 1e-12);
  EXPECT_NEAR(proposed(length, controls, 0.9), 0.1, 1e-12);
  EXPECT_NEAR(proposed(length, controls, 0.45), 0.15, 1e-12);  // back to the grid after a halved step
}

TEST(StepLength, AFailedStepIsHalvedUntilItIsNotWorthIt) {
  RunControls controls{.fixed_step_s = 1};
  StepLength length(controls);
  double tried = proposed(length, controls, 0);
  int halvings = 0;
  while (length.halve(controls, tried)) {
    const double next = proposed(length, controls, 0);
    EXPECT_NEAR(next, tried / 2, 1e-12);
    tried = next;
    ASSERT_LT(++halvings, 100);
  }
  EXPECT_GT(halvings, 10);
}

// Ten sums of 0.3 make 2.9999999999999996; the clock shows the grid's 3.
TEST(StepLength, TheClockOfFixedStepsDoesNotDrift) {
  RunControls controls{.fixed_step_s = 0.3};
  const StepLength length(controls);
  double time_s = 0;
  int steps = 0;
  for (; time_s < 300 - 1e-3; ++steps) {
    time_s = length.propose_end_s(controls, time_s);
    ASSERT_EQ(time_s, (steps + 1) * 0.3);
  }
  EXPECT_EQ(steps, 1000);
}

// A frame at 59.9999999 s, the end at 60 s: one stop, the later.
TEST(StepLength, StopsOfOneInstantAreOne) {
  RunControls controls{.end_s = 60, .frame_every_s = 59.9999999, .program_points_s = {10, 10 + 3e-7, 10 + 1e-3}};
  const StepLength length(controls, 1000);
  std::vector<double> ends;
  for (double time_s = 0; time_s < 60; ends.push_back(time_s)) {
    const double end_s = length.propose_end_s(controls, time_s);
    ASSERT_GT(end_s, time_s + 1e-4) << "no crumbs";
    time_s = end_s;
  }
  EXPECT_EQ(ends, (std::vector<double>{10 + 3e-7, 10 + 1e-3, 60}));
}

// Half h^2 x'' with x'' from the change of velocity between the middles of two steps: for a constant acceleration a and
// equal steps the error is h^2 a / 2.
TEST(StepLength, RejectsAStepWhoseErrorIsFarTooLarge) {
  RunControls controls{.first_step_s = 1, .position_tolerance_um = 0.01, .frame_every_s = 0};
  StepLength length(controls);
  Path path;
  const State first = path.after(1, 1);
  EXPECT_TRUE(length.accept(controls, path.here(), first)) << "nothing is known on the first step";
  path.go_to(first);
  EXPECT_FALSE(length.accept(controls, path.here(), path.after(1, 3)));
  EXPECT_LT(proposed(length, controls, 1), 0.5);
}

TEST(StepLength, GrowsWhileStepsAreAccurateUpToItsLimit) {
  RunControls controls{.first_step_s = 1, .max_step_s = 5, .frame_every_s = 0};
  StepLength length(controls);
  Path steady;
  double step = proposed(length, controls, 0);
  for (int k = 0; k < 10; ++k) {
    const State next = steady.after(step, steady.here().time_s + step);
    EXPECT_TRUE(length.accept(controls, steady.here(), next));
    steady.go_to(next);
    const double longer = proposed(length, controls, next.time_s);
    EXPECT_GE(longer, step * (1 - 1e-12));
    EXPECT_LE(longer, 5);
    step = longer;
  }
  EXPECT_DOUBLE_EQ(step, 5);
}

TEST(StepLength, GrowsLittleInTheFourStepsAfterAnUnsolvedOne) {
  const RunControls controls{.first_step_s = 1, .frame_every_s = 0};
  StepLength length(controls);
  Path steady;
  const auto growth = [&](StepLength& of) {
    const double step_s = of.wanted_s();
    const State next = steady.after(step_s, steady.here().time_s + step_s);
    EXPECT_TRUE(of.accept(controls, steady.here(), next));
    steady.go_to(next);
    return of.wanted_s() / step_s;
  };
  growth(length);
  EXPECT_DOUBLE_EQ(growth(length), 2);
  EXPECT_TRUE(length.halve(controls, length.wanted_s()));
  EXPECT_EQ(length.careful_steps(), 4);
  EXPECT_DOUBLE_EQ(growth(length), 1.15);
  EXPECT_DOUBLE_EQ(growth(length), 1.15);
  StepLength resumed(controls, length.wanted_s(), length.careful_steps());
  EXPECT_DOUBLE_EQ(growth(resumed), 1.15);
  EXPECT_DOUBLE_EQ(growth(resumed), 1.15);
  EXPECT_DOUBLE_EQ(growth(resumed), 2);
}

// An error that asks for less is obeyed, and a step that it rejects counts as none.
TEST(StepLength, ErrorsRuleInCarefulSteps) {
  const RunControls controls{.first_step_s = 1, .position_tolerance_um = 0.01, .frame_every_s = 0};
  StepLength length(controls, 2, 4);
  Path path;
  path.go_to(path.after(1, 1));
  EXPECT_FALSE(length.accept(controls, path.here(), path.after(1, 3)));
  EXPECT_EQ(length.careful_steps(), 4);
  EXPECT_TRUE(length.accept(controls, path.here(), path.after(1, 2 + 0.02 / (0.8 * 0.8))));
  EXPECT_NEAR(length.wanted_s(), 0.9 * 0.8, 1e-9);
  EXPECT_EQ(length.careful_steps(), 3);
}

// Errors grow with the square of a step to first order and its cube to second, so the next length goes by the root of
// what is allowed over what was: 0.9 of it, to be on the safe side.
TEST(StepLength, TheNextOneIsByTheRootOfTheErrorThatIsAllowed) {
  RunControls controls{.first_step_s = 1, .position_tolerance_um = 0.01, .frame_every_s = 0};
  for (const TimeOrder order : {TimeOrder::first, TimeOrder::second}) {
    controls.scheme.order = order;
    for (const double part : {0.5, 0.6, 0.8, 1.0, 1.5, 2.0}) {  // the next length over 0.9 of this one
      Path path(order);
      StepLength length(controls);
      for (const double x_um : {1.0, 2.0}) path.go_to(path.after(1, x_um));
      // Off the straight way by d: the error is d/2 to first order, 2 d/9 to second.
      const bool is_first = order == TimeOrder::first;
      const double d = 0.01 * (is_first ? 2 / (part * part) : 4.5 / (part * part * part));
      EXPECT_EQ(length.accept(controls, path.here(), path.after(1, 3 + d)), 0.9 * part >= 0.6) << part;
      EXPECT_NEAR(length.wanted_s(), 0.9 * part, 1e-9);
    }
  }
}

TEST(StepLength, OfSecondOrderStepsGrowByNoMoreThanThatOrderAllows) {
  RunControls controls{.scheme = {.order = TimeOrder::second}, .first_step_s = 0.05, .frame_every_s = 7};
  StepLength length(controls);
  Path steady(TimeOrder::second);
  for (int k = 0; k < 40; ++k) {
    const double step = proposed(length, controls, steady.here().time_s);
    EXPECT_EQ(possible_order(steady.here(), step), k == 0 ? TimeOrder::first : TimeOrder::second) << "step " << k;
    const State next = steady.after(step, steady.here().time_s + step);
    EXPECT_TRUE(length.accept(controls, steady.here(), next));
    steady.go_to(next);
  }
}

}  // namespace
