#include "solver/sensitivity/way_back.hpp"

#include <algorithm>
#include <utility>

#include "core/parallel.hpp"
#include "solver/sensitivity/step_terms.hpp"

namespace plica {
namespace {

using Internals = LawInternals;

Internals zeros_like(const Internals& internals) {
  Internals zeros;
  for (const auto& internal : internals) zeros.emplace_back(internal.size(), 0.0);
  return zeros;
}

bool is_zero(std::span<const double> numbers) {
  return std::ranges::all_of(numbers, [](double number) { return number == 0; });
}

double product(const Signals::Values& a, const Signals::Values& b) {
  double sum = 0;
  for (std::size_t s = 0; s < a.size(); ++s)
    for (std::size_t c = 0; c < a[s].size(); ++c) sum += a[s][c] * b[s][c];
  return sum;
}

/// Solved adjoint problem of one step.
struct StepAdjoint {
  const TapedRun& run;
  std::size_t number;                    // of the step
  const ExactSolve::Solution& solution;  // mu and nu
  const Vectors& on_obstacles;           // forces that fixed directions bear; empty without contacts
  const Internals& internals;            // gradient by internal states at the end of the step
  const Signals::Values& signals;        // and by signals there
};

/// Return the outcome's dependence on a model, up to a constant: its terms along the adjoint.
double along_adjoint(const Model& model, const StepAdjoint& adjoint) {
  TermsWanted wanted{.signals = !adjoint.signals.empty()};
  for (const auto& internal : adjoint.internals) wanted.internals.push_back(!is_zero(internal));
  const StepTerms terms = step_terms(model, adjoint.run, adjoint.number, wanted);
  double sum = product(adjoint.signals, terms.signals);
  for (std::size_t l = 0; l < terms.internals.size(); ++l)
    for (std::size_t i = 0; i < terms.internals[l].size(); ++i) sum += adjoint.internals[l][i] * terms.internals[l][i];
  for (std::size_t f = 0; f < terms.excess.size(); ++f) sum += adjoint.solution.multipliers[f] * terms.excess[f];
  for (std::size_t n = 0; n < adjoint.on_obstacles.size(); ++n) sum += adjoint.on_obstacles[n].dot(terms.moved[n]);
  return sum + parallel_dot(std::span<const Vec3>(adjoint.solution.positions), std::span<const Vec3>(terms.forces));
}

class WayBack {
 public:
  WayBack(const Model& model, const TapedRun& run, LinearMethod method, const OutcomeGradient& outcome,
          const GradientInput& input)
      : model_(model), run_(run), outcome_(outcome), input_(input), solver_(model, method) {
    gradient_.by_parameter.assign(input.parameters.size(), 0.0);
    if (input.law) gradient_.by_strength.assign(model.tissue.cells.size(), 0.0);
    internals_ = zeros_like(run.states.back().internals);
  }

  std::optional<RunGradient> go() {
    const std::size_t last = outcome_.empty() ? 0 : outcome_.rbegin()->first;
    internals_ = zeros_like(run_.states[last].internals);
    signals_.assign(model_.signals.size(), CellArray(model_.tissue.cells.size(), 0.0));
    for (std::size_t n = last; n-- > 0;) {
      if (input_.stop_requested && input_.stop_requested()) return std::nullopt;
      back_through(n);
    }
    add_beginning();
    gradient_.linear_iterations = solver_.linear_iterations();
    gradient_.factorisations = solver_.factorisations();
    return std::move(gradient_);
  }

 private:
  /// Return the gradient by positions of a state, from the outcome and from later steps.
  Vectors& by_positions(std::size_t state) {
    const auto [place, is_new] = by_positions_.try_emplace(state);
    if (is_new) {
      const auto of_outcome = outcome_.find(state);
      place->second =
          of_outcome == outcome_.end() ? Vectors(model_.tissue.node_count(), Vec3::Zero()) : of_outcome->second;
    }
    return place->second;
  }

  void back_through(std::size_t n) {
    const std::optional<Model> later = run_.grown_in(n, model_);
    Step step = run_.step(n);
    if (later) step.grown = &*later;
    const Iterate at = run_.at_end_of(n);
    Internals before = zeros_like(run_.states[n].internals);
    Vectors& by_end = by_positions(n + 1);
    Vectors& by_previous = by_positions(n);
    Vectors none;
    Vectors& by_earlier = step.ahead > 0 ? by_positions(n - 1) : none;
    const auto for_gradients = [&](const auto& body) {
      std::size_t l = 0;
      for_laws(model_, step, [&](const Law& law, const Step& law_step) {
        body(law.derivatives(), law_step, l, BeginningGradient{step.ahead, by_previous, by_earlier, before[l]});
        ++l;
      });
    };

    // What signals and internal states at the end say about positions there, and about earlier ones.
    Internals internals = internals_;
    for_gradients([&](const LawDerivatives& law, const Step& law_step, std::size_t l, const BeginningGradient& to) {
      if (is_zero(internals[l])) return;
      law.move_to_signals(internals[l], run_.states[n + 1].signals, signals_);
      law.add_internal_gradient(law_step, run_.states[n + 1].internals[l], internals[l], by_end, to);
    });
    const Signals::Values signals = std::exchange(signals_, signals_before(n, step, by_end, by_previous));
    // The forces' part, by the step's own system.
    model_.tissue.carry_hanging(by_end);
    if (parallel_squared_norm(by_end) > 0) {
      const ExactSolve::Solution solution = solver_.solve(step, at, {by_end}, input_.tolerance);
      const Vectors borne = on_obstacles(step, at, by_end);
      const StepAdjoint adjoint{run_, n, solution, borne, internals_, signals};
      add_parameters(adjoint);
      if (strengths_change_cells()) add_strengths(adjoint);
      for_gradients([&](const LawDerivatives& law, const Step& law_step, std::size_t l, const BeginningGradient& to) {
        law.add_force_gradient(law_step, solution.positions, to);
        if (input_.law != l) return;
        const std::unique_ptr<Law> unscaled = later && input_.unscaled_law ? grown_law(step) : nullptr;
        const Law* of_strengths = unscaled ? unscaled.get() : input_.unscaled_law;
        (of_strengths ? of_strengths->derivatives() : law)
            .add_strength_gradient(law_step, solution.positions, gradient_.by_strength);
      });
    }
    internals_ = std::move(before);
    by_positions_.erase(n + 1);
  }

  /// Return the gradient by the signals at the beginning of a step, and add that by positions at both ends.
  [[nodiscard]] Signals::Values signals_before(std::size_t n, const Step& step, Vectors& by_end,
                                               Vectors& by_previous) const {
    if (signals_.empty()) return {};
    const Model& model = at_end(model_, step);
    const TapedState &begin = run_.states[n], &end = run_.states[n + 1];
    const std::vector<double> before = model.volumes.volumes(begin.positions),
                              after = model.volumes.volumes(end.positions);
    Signals::GeometryGradient to{std::vector<double>(before.size(), 0.0), std::vector<double>(before.size(), 0.0),
                                 by_end};
    Signals::Values gradient = model.signals.pull_back(model.tissue, {before, after, end.positions},
                                                       end.time_s - begin.time_s, begin.signals, signals_, to);
    model.volumes.add_forces(begin.positions, to.volumes_before, by_previous);
    model.volumes.add_forces(end.positions, to.volumes, by_end);
    return gradient;
  }
  /// Add what parameters do to the signals before the first step, and to what follows them.
  void add_beginning() {
    if (signals_.empty()) return;
    const TapedState& first = run_.states.front();
    const auto along = [&](const Model& model) {
      double sum = product(signals_, model.signals.initial());
      for (std::size_t l = 0; l < model.laws.size(); ++l) {
        if (is_zero(internals_[l])) continue;
        const std::vector<double> internal = model.laws[l]->with_signals(first.internals[l], first.signals, 0);
        for (std::size_t i = 0; i < internal.size(); ++i) sum += internals_[l][i] * internal[i];
      }
      return sum;
    };
    Internals internals = internals_;
    for (std::size_t l = 0; l < model_.laws.size(); ++l)
      model_.laws[l]->derivatives().move_to_signals(internals[l], first.signals, signals_);
    for (std::size_t p = 0; p < input_.parameters.size(); ++p) {
      const ModelPair& pair = *input_.parameters[p];
      gradient_.by_parameter[p] += (along(*pair.more) - along(*pair.less)) / pair.difference;
    }
  }
  /// Return the law with strengths of factor 1 at the end of a step in which cells grow.
  [[nodiscard]] std::unique_ptr<Law> grown_law(const Step& step) const {
    std::vector<GrowthTensor> tensors;
    for (std::size_t l = 0; l < model_.laws.size(); ++l)
      model_.laws[l]->grow(run_.states.front().internals[l], step.end_time_s, tensors);
    std::vector<ElementId> elements;  // any may have other rest shapes
    for (std::size_t e = 0; e < step.grown->tissue.elements.size(); ++e) elements.emplace_back(e);
    return input_.unscaled_law->grown(step.grown->tissue, elements, tensors);
  }
  [[nodiscard]] Vectors on_obstacles(const Step& step, const Iterate& at, const Vectors& by_end) const {
    if ((input_.parameters.empty() && !strengths_change_cells()) || !touches_obstacles(at)) return {};
    return solver_.unbalanced(step, at, by_end);
  }
  void add_parameters(const StepAdjoint& adjoint) {
    for (std::size_t p = 0; p < input_.parameters.size(); ++p) {
      const ModelPair& pair = *input_.parameters[p];
      gradient_.by_parameter[p] +=
          (along_adjoint(*pair.more, adjoint) - along_adjoint(*pair.less, adjoint)) / pair.difference;
    }
  }

  [[nodiscard]] bool strengths_change_cells() const {
    return input_.law && model_.laws[*input_.law]->derivatives().strengths_change_cells();
  }
  /// Add derivatives by strengths that change rest shapes and targets, by differences cell after cell.
  void add_strengths(const StepAdjoint& adjoint) {
    constexpr double change = 1e-4;
    const Law& unscaled = input_.unscaled_law ? *input_.unscaled_law : *model_.laws[*input_.law];
    std::vector<double> factors = input_.factors;
    factors.resize(gradient_.by_strength.size(), 1.0);
    Model changed = model_;
    const auto along = [&](double& factor, double by) {
      const double before = std::exchange(factor, factor + by);
      changed.laws[*input_.law] = with_strengths(unscaled, factors);
      factor = before;
      return along_adjoint(changed, adjoint);
    };
    for (std::size_t c = 0; c < factors.size(); ++c)
      gradient_.by_strength[c] += (along(factors[c], change) - along(factors[c], -change)) / (2 * change);
  }

  const Model& model_;
  const TapedRun& run_;
  const OutcomeGradient& outcome_;
  const GradientInput& input_;
  ExactSolve solver_;
  RunGradient gradient_;
  std::map<std::size_t, Vectors> by_positions_;  // states
  Internals internals_;                          // gradient by those at the end of the present step
  Signals::Values signals_;                      // and by the signals there
};

}  // namespace

void require_derivatives(const Model& model) {
  for (const auto& law : model.laws) (void)law->derivatives();
}

ModelPair model_pair(const Model& model, std::string name, std::unique_ptr<const Model> more,
                     std::unique_ptr<const Model> less, double difference) {
  for (const Model* side : {more.get(), less.get()}) {
    bool same = side->tissue.rest_positions == model.tissue.rest_positions &&
                side->tissue.elements == model.tissue.elements && side->held == model.held &&
                side->laws.size() == model.laws.size() && side->multiplier_count() == model.multiplier_count() &&
                ObstacleContacts(*side).size() == ObstacleContacts(model).size();
    for (std::size_t l = 0; same && l < model.laws.size(); ++l)
      same = side->laws[l]->label() == model.laws[l]->label() &&
             side->laws[l]->first_internal(side->tissue) == model.laws[l]->first_internal(model.tissue);
    if (!same)
      throw NoGradient(name +
                       ": has no gradient, since it changes the tissue, which laws act, or the state before the "
                       "first step; choose another key");
  }
  return {std::move(name), std::move(more), std::move(less), difference};
}

std::optional<RunGradient> way_back(const Model& model, const TapedRun& run, LinearMethod method,
                                    const OutcomeGradient& outcome, const GradientInput& input) {
  require_derivatives(model);
  if (input.law) (void)with_strengths(*model.laws[*input.law], std::vector<double>(model.tissue.cells.size(), 1.0));
  return WayBack(model, run, method, outcome, input).go();
}

}  // namespace plica
