#include "solver/sensitivity/taped_run.hpp"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <utility>

#include "mechanics/derivatives.hpp"

namespace plica {

TapedState TapedState::of(const State& state) {
  return {state.time_s,      state.positions, state.multipliers, state.obstacle_forces,
          state.on_obstacle, state.internals, state.signals};
}

Step TapedRun::step(std::size_t n) const {
  const TapedState &begin = states[n], &end = states[n + 1];
  const Vectors& before = n > 0 ? states[n - 1].positions : earlier;
  return {.positions = end.positions,
          .previous_positions = begin.positions,
          .previous_velocities = {},
          .rate_s = rates[n].rate_s,
          .end_time_s = end.time_s,
          .earlier_positions = rates[n].ahead > 0 ? std::span<const Vec3>(before) : std::span<const Vec3>(),
          .ahead = rates[n].ahead,
          .internals = begin.internals};
}

Iterate TapedRun::at_end_of(std::size_t n) const {
  const TapedState& end = states[n + 1];
  return {end.positions, end.multipliers, end.obstacle_forces, end.on_obstacle};
}

void TapedChange::make(Model& model, State& state) const {
  for (const RepeatedChange& one : again)
    if (!one(model, state))
      throw NoGradient(
          fmt::format("at t = {:g} s an exchange of neighbours or extrusion hangs on a cell whose elements a small "
                      "change spoils; end the run before",
                      before.time_s));
}

std::size_t part_with(std::span<const TapedPart> parts, std::size_t state) {
  std::size_t part = 0;
  while (part + 1 < parts.size() && parts[part + 1].first_state <= state) ++part;
  return part;
}

Vectors known_earlier_positions(const State& state) {
  return state.trend.step_s > 0 ? earlier_positions(state) : Vectors();
}

void require_same_change(const Model& model, const State& state, const TapedPart& like) {
  const TapedState& first = like.run.states.front();
  bool same = model.tissue.elements == like.model->tissue.elements && model.held == like.model->held &&
              state.internals.size() == first.internals.size();
  for (std::size_t l = 0; same && l < first.internals.size(); ++l)
    same = state.internals[l].size() == first.internals[l].size();
  if (!same)
    throw NoGradient(
        fmt::format("at t = {:g} s a small change makes cells divide or exchange neighbours with another mesh or other "
                    "contacts; end the run before",
                    first.time_s));
}

namespace {

/// Repeats steps with one model, as accurately as rounding allows.
class Replay {
 public:
  Replay(const Model& model, const RunMethod& method, State start, bool is_start)
      : model_(model), now_(std::move(start)), is_start_(is_start) {
    // Where contacts change, rounding may stop Newton's method before the first of these.
    for (const double force : {1e-12, 1e-10, 1e-8})
      steppers_.push_back(std::make_unique<NewtonStepper>(
          model, StepTolerances{.force = force, .constraint = 0.1 * force, .gap_um = 1e-11, .max_iterations = 60},
          method.linear_method, method.order));
    run_.states.push_back(TapedState::of(now_));
    run_.earlier = known_earlier_positions(now_);
  }

  /// Step to a time, in halves if need be.
  void go_to(double end_s, bool is_first_order, int halvings = 0) {
    constexpr int most_halvings = 6;
    if (is_first_order) now_.trend = {};
    State next;
    StepReport report;
    const std::optional<Model> later = grown(model_, model_, run_.states.front().internals, end_s);
    for (const auto& stepper : steppers_) {
      report =
          stepper->advance(now_, end_s - now_.time_s, is_start_ && run_.steps() == 0, next, later ? &*later : nullptr);
      if (report.converged()) return accept(end_s, std::move(next), later ? *later : model_);
      stepper->forget_factor();
    }
    if (halvings == most_halvings)
      throw std::runtime_error(
          fmt::format("the step to t = {:g} s, repeated for a gradient, failed: {}", end_s, report.reason()));
    go_to(0.5 * (now_.time_s + end_s), is_first_order, halvings + 1);
    go_to(end_s, false, halvings + 1);
  }
  [[nodiscard]] const State& now() const { return now_; }
  TapedRun run() && { return std::move(run_); }

 private:
  void accept(double end_s, State next, const Model& model) {
    next.time_s = end_s;
    if (const auto failure = advance_signals(model, now_, next)) throw std::runtime_error(failure->problem);
    run_.rates.push_back(rates_of(now_, next));
    run_.states.push_back(TapedState::of(next));
    now_ = std::move(next);
  }

  const Model& model_;
  std::vector<std::unique_ptr<NewtonStepper>> steppers_;
  State now_;
  bool is_start_;
  TapedRun run_;
};

}  // namespace

std::vector<TapedPart> replayed(std::shared_ptr<const Model> model, std::span<const TapedPart> like,
                                const RunMethod& method) {
  std::vector<TapedPart> parts;
  State now = rest_state(*model);
  for (const TapedPart& part : like) {
    TapedPart& own = parts.emplace_back();
    if (part.change) {
      own.change = TapedChange{now, part.change->again};
      auto changed = std::make_shared<Model>(*model);
      own.change->make(*changed, now);
      require_same_change(*changed, now, part);
      model = std::move(changed);
    }
    own.model = model;
    Replay replay(*model, method, now, parts.size() == 1);
    for (std::size_t n = 0; n < part.run.steps(); ++n)
      replay.go_to(part.run.states[n + 1].time_s, part.run.rates[n].ahead == 0);  // after a jump, or of too long a step
    now = replay.now();
    own.run = std::move(replay).run();
    if (parts.size() > 1) own.first_state = parts.end()[-2].first_state + parts.end()[-2].run.steps();
  }
  return parts;
}

}  // namespace plica
