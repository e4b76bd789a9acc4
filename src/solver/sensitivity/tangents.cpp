#include "solver/sensitivity/tangents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

#include "mechanics/contact/self_contact.hpp"
#include "mechanics/internal_change.hpp"
#include "solver/sensitivity/step_terms.hpp"

namespace plica {
namespace {

/// Derivatives by one parameter, of what the next step begins with.
struct Tangent {
  Vectors positions, earlier;  // nodes
  LawInternals internals;
  Signals::Values signals;
};

/// Return the largest number of a tangent.
double largest_of(const Tangent& tangent, bool with_earlier) {
  double largest = 0;
  for (const Vec3& motion : tangent.positions) largest = std::max(largest, motion.lpNorm<Eigen::Infinity>());
  for (const Vec3& motion : tangent.earlier)
    if (with_earlier) largest = std::max(largest, motion.lpNorm<Eigen::Infinity>());
  for (const auto& internal : tangent.internals)
    for (const double change : internal) largest = std::max(largest, std::abs(change));
  for (const auto& signal : tangent.signals)
    for (const double change : signal) largest = std::max(largest, std::abs(change));
  return largest;
}

/// Return the factor on a tangent for central differences: changes of 3e-5 (um, relative rest areas or lengths) leave
/// errors of third derivatives and of rounding below 1e-9.
double difference_size(double largest) { return largest > 0 ? 3e-5 / largest : 0; }

Signals::Values changed_by(Signals::Values signals, double size, const Signals::Values& change) {
  for (std::size_t s = 0; s < signals.size(); ++s)
    for (std::size_t c = 0; c < signals[s].size(); ++c) signals[s][c] += size * change[s][c];
  return signals;
}

Vectors moved_by(std::span<const Vec3> positions, double size, const Vectors& motion) {
  Vectors moved(positions.begin(), positions.end());
  for (std::size_t n = 0; n < moved.size(); ++n) moved[n] += size * motion[n];
  return moved;
}

/// What a step begins with, and positions at its end, changed along a tangent.
class ChangedStep {
 public:
  ChangedStep(const Step& step, double size, const Tangent& tangent, const Vectors* end)
      : previous_(moved_by(step.previous_positions, size, tangent.positions)),
        internals_(step.internals.begin(), step.internals.end()),
        step_(step) {
    for (std::size_t l = 0; l < internals_.size(); ++l)
      for (std::size_t i = 0; i < internals_[l].size(); ++i) internals_[l][i] += size * tangent.internals[l][i];
    step_.previous_positions = previous_;
    step_.internals = internals_;
    if (step.ahead > 0) step_.earlier_positions = earlier_ = moved_by(step.earlier_positions, size, tangent.earlier);
    if (end != nullptr) step_.positions = positions_ = moved_by(step.positions, size, *end);
  }
  ChangedStep(const ChangedStep&) = delete;
  ChangedStep& operator=(const ChangedStep&) = delete;
  [[nodiscard]] const Step& step() const { return step_; }

 private:
  Vectors positions_, previous_, earlier_;
  LawInternals internals_;
  Step step_;
};

/// Difference quotients; 0 between equal numbers, which may be infinite (times of what never happened).
template <class Numbers>
Numbers slopes(const Numbers& more, const Numbers& less, double difference) {
  Numbers result = more;
  for (std::size_t i = 0; i < result.size(); ++i) {
    if constexpr (std::is_same_v<std::decay_t<decltype(result[i])>, double>)
      result[i] = more[i] == less[i] ? 0 : (more[i] - less[i]) / difference;
    else
      result[i] = slopes(more[i], less[i], difference);
  }
  return result;
}

/// Pass through the steps of one part of a run.
class ForwardPass {
 public:
  /// `pairs`: models of the parameters in this part.
  ForwardPass(const TapedPart& part, LinearMethod method, const TangentInput& input,
              std::span<const ModelPair* const> pairs)
      : model_(*part.model), run_(part.run), input_(input), pairs_(pairs), solver_(model_, method) {}

  /// Start with what parameters do before the first step.
  void begin() {
    const Vectors still(model_.tissue.node_count(), Vec3::Zero());
    LawInternals unchanged;
    for (const auto& internal : run_.states.front().internals) unchanged.emplace_back(internal.size(), 0.0);
    tangents_.assign(pairs_.size(), {still, still, unchanged, {}});
    if (!model_.signals.empty())
      for (std::size_t p = 0; p < tangents_.size(); ++p) begin_signals(*pairs_[p], tangents_[p]);
  }
  /// Start with these derivatives.
  void begin(std::vector<Tangent> tangents) { tangents_ = std::move(tangents); }
  std::vector<Tangent> end() && { return std::move(tangents_); }

  /// `steps`: their number; states are numbered from `first_state`.
  bool go(std::size_t steps, std::size_t first_state, const TakeTangents& take) {
    by_parameter_.clear();
    for (const Tangent& tangent : tangents_) by_parameter_.push_back(tangent.positions);
    take(first_state, by_parameter_);
    for (std::size_t n = 0; n < steps; ++n) {
      if (input_.stop_requested && input_.stop_requested()) return false;
      constexpr std::size_t enough_for_a_factor = 3;
      if (tangents_.size() >= enough_for_a_factor) solver_.renew();
      const std::optional<Model> later = run_.grown_in(n, model_);
      Step step = run_.step(n);
      if (later) step.grown = &*later;
      for (std::size_t p = 0; p < tangents_.size(); ++p) pass(n, p, step);
      take(first_state + n + 1, by_parameter_);
    }
    return true;
  }

 private:
  /// Start with what a parameter does to the signals before the first step, and to what follows them.
  void begin_signals(const ModelPair& pair, Tangent& tangent) const {
    const TapedState& first = run_.states.front();
    tangent.signals = slopes(pair.more->signals.initial(), pair.less->signals.initial(), pair.difference);
    const double size = difference_size(largest_of(tangent, false));
    const Signals::Values more = changed_by(first.signals, size, tangent.signals),
                          less = changed_by(first.signals, -size, tangent.signals);
    for (std::size_t l = 0; l < model_.laws.size(); ++l) {
      const auto after = [&](const Model& model, const Signals::Values& signals) {
        return model.laws[l]->with_signals(first.internals[l], signals, first.time_s);
      };
      add(slopes(after(*pair.more, first.signals), after(*pair.less, first.signals), pair.difference),
          tangent.internals[l]);
      if (size > 0) add(slopes(after(model_, more), after(model_, less), 2 * size), tangent.internals[l]);
    }
  }

  /// Pass a step with one parameter.
  void pass(std::size_t n, std::size_t p, const Step& step) {
    const Iterate at = run_.at_end_of(n);
    Tangent& tangent = tangents_[p];
    const ModelPair& pair = *pairs_[p];
    const TermsWanted wanted{std::vector<bool>(model_.laws.size(), true), !model_.signals.empty()};
    StepTerms by_parameter = step_terms(*pair.more, run_, n, wanted);
    subtract(step_terms(*pair.less, run_, n, wanted), pair.difference, by_parameter);

    const double size = difference_size(largest_of(tangent, step.ahead > 0));
    if (size > 0) add_forces_of_beginning(step, size, tangent, by_parameter.forces);
    model_.tissue.carry_hanging(by_parameter.forces);
    if (!by_parameter.moved.empty()) model_.tissue.place_hanging(by_parameter.moved);
    for (double& rate : by_parameter.excess) rate = -rate;
    by_parameter_[p] =
        solver_.solve(step, at, {by_parameter.forces, by_parameter.excess, by_parameter.moved}, input_.tolerance)
            .positions;
    finish(n, step, by_parameter_[p], std::move(by_parameter), tangent);
  }

  /// Take the derivatives at the end of a step. `sum`: of internal states and signals by the parameter itself.
  void finish(std::size_t n, const Step& step, const Vectors& end, StepTerms sum, Tangent& tangent) const {
    const LawInternals& internals = run_.states[n + 1].internals;
    for (std::size_t l = 0; l < internals.size(); ++l) sum.internals[l].resize(internals[l].size(), 0.0);
    Tangent at_end = tangent;
    at_end.positions = end;
    const double largest = std::max(largest_of(tangent, step.ahead > 0), largest_of(at_end, false));
    if (largest > 0) {
      if (!model_.signals.empty()) add_signal_change(n, step, difference_size(largest), tangent, end, sum.signals);
      at_end.signals = sum.signals;
      const double with_signals = std::max(largest, largest_of(at_end, false));
      add_internal_change(n, step, difference_size(with_signals), tangent, at_end, sum.internals);
    }
    tangent.earlier = std::exchange(tangent.positions, end);
    tangent.internals = std::move(sum.internals);
    tangent.signals = std::move(sum.signals);
  }

  void add_signal_change(std::size_t n, const Step& step, double size, const Tangent& tangent, const Vectors& end,
                         Signals::Values& sum) const {
    const TapedState &first = run_.states[n], &last = run_.states[n + 1];
    const auto after = [&](double signed_size) {
      return signals_after(
          plica::at_end(model_, step), run_, n,
          {moved_by(first.positions, signed_size, tangent.positions), moved_by(last.positions, signed_size, end),
           changed_by(first.signals, signed_size, tangent.signals)});
    };
    sum = changed_by(std::move(sum), 1, slopes(after(size), after(-size), 2 * size));
  }

  /// Add the derivatives of internal states by what a step begins and ends with.
  void add_internal_change(std::size_t n, const Step& step, double size, const Tangent& tangent, const Tangent& end,
                           LawInternals& sum) const {
    const TapedState& last = run_.states[n + 1];
    const ChangedStep more(step, size, tangent, &end.positions), less(step, -size, tangent, &end.positions);
    const Signals::Values of_more = changed_by(last.signals, size, end.signals),
                          of_less = changed_by(last.signals, -size, end.signals);
    std::size_t l = 0;
    for_laws(model_, step, [&](const Law& law, const Step& law_step) {
      const std::size_t place = l++;
      const std::vector<double>& next = last.internals[place];
      if (next.empty() || is_static(law)) return;
      const StepChange change{end.positions, tangent.positions, tangent.earlier, tangent.internals[place]};
      if (const auto* own = dynamic_cast<const InternalChange*>(&law))
        return own->add_internal_change(law_step, next, change, sum[place]);
      const auto after = [&](const ChangedStep& changed, const Signals::Values& signals) {
        Step as_seen = changed.step();
        as_seen.internal = as_seen.internals[place];
        return law.with_signals(law.derivatives().next_internal_like(law, as_seen, next), signals, step.end_time_s);
      };
      add(slopes(after(more, of_more), after(less, of_less), 2 * size), sum[place]);
    });
  }

  static void add(const std::vector<double>& more, std::vector<double>& sum) {
    for (std::size_t i = 0; i < more.size(); ++i) sum[i] += more[i];
  }

  static void subtract(const StepTerms& less, double difference, StepTerms& more) {
    for (std::size_t n = 0; n < more.forces.size(); ++n)
      more.forces[n] = (more.forces[n] - less.forces[n]) / difference;
    for (std::size_t n = 0; n < more.moved.size(); ++n) more.moved[n] = (more.moved[n] - less.moved[n]) / difference;
    more.excess = slopes(more.excess, less.excess, difference);
    for (std::size_t l = 0; l < more.internals.size(); ++l)
      more.internals[l] = slopes(more.internals[l], less.internals[l], difference);
    more.signals = slopes(more.signals, less.signals, difference);
  }

  [[nodiscard]] static bool is_static(const Law& law) { return &law.derivatives() == &static_derivatives(); }

  void add_forces_of_beginning(const Step& step, double size, const Tangent& tangent, Vectors& forces) const {
    const auto forces_at = [&](double signed_size) {
      const ChangedStep changed(step, signed_size, tangent, nullptr);
      Vectors sum(forces.size(), Vec3::Zero());
      for_laws(model_, changed.step(), [&](const Law& law, const Step& law_step) {
        if (!is_static(law)) law.add_forces(law_step, sum);
      });
      return sum;
    };
    const Vectors more = forces_at(size), less = forces_at(-size);
    for (std::size_t n = 0; n < forces.size(); ++n) forces[n] += (more[n] - less[n]) / (2 * size);
  }

  const Model& model_;
  const TapedRun& run_;
  const TangentInput& input_;
  std::span<const ModelPair* const> pairs_;
  ExactSolve solver_;
  std::vector<Tangent> tangents_;      // parameters
  std::vector<Vectors> by_parameter_;  // parameters: of positions at the end of the present step
};

/// State before a change, moved along a tangent.
State moved_along(const State& before, double size, const Tangent& tangent) {
  State state = before;
  state.positions = moved_by(before.positions, size, tangent.positions);
  for (std::size_t l = 0; l < state.internals.size(); ++l)
    for (std::size_t i = 0; i < state.internals[l].size(); ++i) state.internals[l][i] += size * tangent.internals[l][i];
  if (!tangent.signals.empty()) state.signals = changed_by(before.signals, size, tangent.signals);
  if (state.trend.step_s == 0) return state;
  Vectors& velocities = state.trend.mean_velocities.empty() ? state.velocities : state.trend.mean_velocities;
  for (std::size_t n = 0; n < velocities.size(); ++n)
    velocities[n] += size / state.trend.step_s * (tangent.positions[n] - tangent.earlier[n]);
  return state;
}

/// Throw NoGradient if contacts, which a change rebuilds, act in this part.
void require_no_contact(const TapedPart& part) {
  for (std::size_t l = 0; l < part.model->laws.size(); ++l) {
    const SelfContact* contact = part.model->laws[l]->self_contact();
    for (const TapedState& state : part.run.states)
      if (contact != nullptr && !SelfContact::pairs_of(state.internals[l]).empty())
        throw NoGradient(fmt::format(
            "{}: at t = {:g} s, after cells have divided or exchanged neighbours, surfaces are near each other; "
            "contacts are then rebuilt without a derivative, so end the run before",
            part.model->laws[l]->label(), state.time_s));
  }
}

/// Take both models of a parameter, and its tangent, through the change with which a part begins.
ModelPair through_change(const TapedPart& part, const ModelPair& pair, Tangent& tangent) {
  const TapedChange& change = *part.change;
  const auto changed = [&](const Model& before, double size) {
    auto model = std::make_unique<Model>(before);
    State state = moved_along(change.before, size, tangent);
    change.make(*model, state);
    require_same_change(*model, state, part);
    return std::pair(std::move(model), std::move(state));
  };
  auto [more, at_more] = changed(*pair.more, 0.5 * pair.difference);
  auto [less, at_less] = changed(*pair.less, -0.5 * pair.difference);
  const auto slopes_of = [&](const auto& of) { return slopes(of(at_more), of(at_less), pair.difference); };
  const auto vector_slopes = [&](const Vectors& of_more, const Vectors& of_less) {
    Vectors slope;
    for (std::size_t n = 0; n < of_more.size(); ++n) slope.push_back((of_more[n] - of_less[n]) / pair.difference);
    return slope;
  };
  tangent.positions = vector_slopes(at_more.positions, at_less.positions);
  tangent.earlier = vector_slopes(known_earlier_positions(at_more), known_earlier_positions(at_less));
  tangent.internals = slopes_of([](const State& state) { return state.internals; });
  tangent.signals = slopes_of([](const State& state) { return state.signals; });
  return {pair.name, std::move(more), std::move(less), pair.difference};
}

}  // namespace

bool tangents(std::span<const TapedPart> parts, LinearMethod method, std::size_t last_state, const TangentInput& input,
              const TakeTangents& take) {
  require_derivatives(*parts.front().model);
  std::vector<ModelPair> owned;
  std::vector<const ModelPair*> pairs = input.parameters;
  std::vector<Tangent> at_change;
  for (const TapedPart& part : parts.first(1 + part_with(parts, last_state))) {
    if (part.change) {
      require_no_contact(part);
      std::vector<ModelPair> changed;
      for (std::size_t p = 0; p < pairs.size(); ++p) changed.push_back(through_change(part, *pairs[p], at_change[p]));
      owned = std::move(changed);
      pairs.clear();
      for (const ModelPair& pair : owned) pairs.push_back(&pair);
    }
    ForwardPass pass(part, method, input, pairs);
    if (part.change)
      pass.begin(std::move(at_change));
    else
      pass.begin();
    const std::size_t steps = std::min(part.run.steps(), last_state - part.first_state);
    const auto take_own = [&](std::size_t state, std::span<const Vectors> by_parameter) {
      if (&parts[part_with(parts, state)] == &part) take(state, by_parameter);  // else it is that before a change
    };
    if (!pass.go(steps, part.first_state, take_own)) return false;
    at_change = std::move(pass).end();
  }
  return true;
}

}  // namespace plica
