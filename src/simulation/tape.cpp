#include "simulation/tape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/clock.hpp"
#include "core/errors.hpp"
#include "core/parallel.hpp"

namespace plica {
namespace {

/// Scale the strengths of cells in the laws of both models. Returns the laws as they were.
std::map<std::size_t, std::shared_ptr<const Law>> scale_strengths(Simulation::Parts& parts,
                                                                  const StrengthFactors& strengths) {
  std::map<std::size_t, std::shared_ptr<const Law>> unscaled;
  for (const auto& [label, factors] : strengths) {
    const std::size_t law = place_of_law(*parts.model, label);
    const std::size_t cells = (parts.full_model ? parts.full_model->model() : *parts.model).tissue.cells.size();
    if (factors.size() != cells)
      throw UsageError(fmt::format("{}: {} strengths for {} cells; give one per cell", label, factors.size(), cells));
    for (std::size_t c = 0; c < cells; ++c)
      if (!(factors[c] >= 0 && std::isfinite(factors[c])))
        throw UsageError(fmt::format("{}: the strength of cell {} is {}; give a number >= 0", label, c, factors[c]));
    std::unique_ptr<Law>& own = parts.model->laws[law];
    const std::vector<double> of_side = parts.full_model ? parts.full_model->scale_strengths(law, factors) : factors;
    std::unique_ptr<Law> scaled = with_strengths(*own, of_side);
    unscaled[law] = std::exchange(own, std::move(scaled));
  }
  return unscaled;
}

/// Return the parts of a simulation, with the laws of recorded runs (LawDerivatives::smooth).
Simulation::Parts smooth_parts_of(const Scenario& scenario, const PartsAddition& add) {
  Simulation::Parts parts = parts_of(scenario);
  if (add) add(parts);
  require_derivatives(*parts.model);
  for (std::unique_ptr<Law>& law : parts.model->laws)
    if (std::unique_ptr<Law> smooth = law->derivatives().smooth()) law = std::move(smooth);
  return parts;
}

RunMethod method_of(const RunControls& controls) {
  if (controls.scheme.forces != StepScheme::Forces::newton || controls.scheme.projection)
    throw NoGradient(
        "time.scheme: only Newton's steps with exact volumes have gradients; remove time.scheme and "
        "volume.method");
  return {controls.scheme.linear_method, controls.scheme.order};
}

}  // namespace

/// Records steps, and the changes of the tissue between them.
class Tape::Recording final : public SimulationListener {
 public:
  Recording(Tape& tape, const Simulation& simulation)
      : tape_(tape), simulation_(simulation), last_(simulation.solved_state()) {
    begin_part({tape.solved_, {}, {}, 0});
  }

  void step_accepted(const AcceptedStep& /*step*/, const Observation& /*measures*/) override {
    TapedRun& run = tape_.parts_.back().run;
    const State& now = simulation_.solved_state();
    run.rates.push_back(rates_of(last_, now));
    run.states.push_back(TapedState::of(now));
    last_ = now;
    is_changed_ = false;
  }

  void change_made(const RepeatedChange& again) override {
    if (is_changed_) {  // one of several at this time
      TapedChange change = std::move(*tape_.parts_.back().change);
      tape_.parts_.pop_back();
      tape_.measure_plans_.pop_back();
      before_ = std::move(change.before);
      again_ = std::move(change.again);
    } else {
      before_ = last_;
      again_.clear();
    }
    is_changed_ = true;
    again_.push_back(again);
    last_ = simulation_.solved_state();
    begin_part({std::make_shared<const Model>(simulation_.model()),
                {},
                TapedChange{before_, again_},
                tape_.parts_.back().first_state + tape_.parts_.back().run.steps()});
  }

 private:
  void begin_part(TapedPart part) {
    part.run.states.push_back(TapedState::of(last_));
    part.run.earlier = known_earlier_positions(last_);
    tape_.parts_.push_back(std::move(part));
    tape_.measure_plans_.push_back(std::make_shared<const MeasurePlan>(simulation_.observer().plan()));
  }

  Tape& tape_;
  const Simulation& simulation_;
  State last_, before_;
  std::vector<RepeatedChange> again_;
  bool is_changed_ = false;
};

Tape::Tape(const Scenario& scenario, const RecordingInput& input)
    : scenario_(std::make_shared<const Scenario>(scenario)), add_(input.add), strengths_(input.strengths) {
  Simulation::Parts parts = smooth_parts_of(scenario, add_);
  unscaled_ = scale_strengths(parts, strengths_);
  method_ = method_of(parts.controls);
  if (parts.full_model) mirror_ = parts.full_model->mirror();
  Simulation simulation(std::move(parts));
  simulation.stop_when(input.stop_requested);
  whole_ = std::make_shared<const Model>(simulation.model());
  solved_ = mirror_.is_used() ? std::make_shared<const Model>(simulation.solved_model()) : whole_;

  first_internals_ = simulation.state().internals;
  Recording recording(*this, simulation);
  simulation.listen(recording);
  const auto run_to = [&](double time_s) {
    simulation.run_until(time_s);
    if (simulation.status() == RunStatus::failed) throw RecordingFailed(simulation);
    was_stopped_ = input.stop_requested && input.stop_requested();
  };
  for (const double time_s : input.at_s) {
    if (was_stopped_) return;
    run_to(time_s);
    if (!was_stopped_ && !is_same_instant(simulation.time_s(), time_s))
      throw UsageError(fmt::format("the run ends at {:g} min, before {:g} min; set a later end, or an earlier time",
                                   simulation.time_s() / 60, time_s / 60));
  }
  if (!was_stopped_) run_to(input.until_s);
}

Vectors Tape::positions(std::size_t state) const {
  const Vectors& of_side = taped_state(state).positions;
  return mirror_.is_used() ? mirror_.full_vectors(of_side) : of_side;
}

const TapedState& Tape::taped_state(std::size_t state) const {
  const TapedPart& part = part_of(state);
  return part.run.states.at(state - part.first_state);
}

std::vector<double> Tape::times_s() const {
  std::vector<double> times_s;
  for (std::size_t n = 0; n <= steps(); ++n) times_s.push_back(taped_state(n).time_s);
  return times_s;
}

SmoothOutcome Tape::outcome(const std::string& name, std::size_t state) const {
  const std::size_t part = part_with(parts_, state);
  const Model& model = model_at(state);
  if (part > 0 && is_relative_to_rest(name, *measure_plans_[part]))
    throw NoGradient(
        fmt::format("outcome \"{}\": is relative to the reference state, which cells that divide or exchange "
                    "neighbours change; use a monitor of area, volume or position",
                    name));
  const auto& internals = part > 0 ? parts_[part].run.states.front().internals : first_internals_;
  const std::optional<Model> later = grown(model, model, internals, taped_state(state).time_s);
  return smooth_outcome(name, later ? *later : model, *measure_plans_[part], positions(state));
}

std::size_t Tape::state_at(double time_s) const {
  for (std::size_t n = 0; n <= steps(); ++n)
    if (is_same_instant(taped_state(n).time_s, time_s)) return n;
  throw UsageError(fmt::format("no step ends at {:g} min; record the run with this time in at_min", time_s / 60));
}

std::unique_ptr<Model> Tape::solved_model(const Variant& changed) const {
  Simulation::Parts parts = smooth_parts_of(changed.scenario, addition_of(changed));
  scale_strengths(parts, strengths_);
  return std::move(parts.model);
}

std::unique_ptr<Model> Tape::solved_model(const StrengthFactors& change, double times) const {
  auto model = std::make_unique<Model>(*solved_);
  for (const auto& [label, of_cells] : change) {
    const std::size_t law = place_of_law(*solved_, label);
    const auto given = strengths_.find(label);
    std::vector<double> factors;
    for (std::size_t c = 0; c < solved_->tissue.cells.size(); ++c) {
      const std::size_t of_whole = mirror_.is_used() ? mirror_.origins[c].index() : c;
      factors.push_back((given == strengths_.end() ? 1.0 : given->second[of_whole]) + times * of_cells[of_whole]);
    }
    const auto unscaled = unscaled_.find(law);
    model->laws[law] = with_strengths(unscaled == unscaled_.end() ? *model->laws[law] : *unscaled->second, factors);
  }
  return model;
}

ModelPair Tape::parameter(std::string name, const Variant& more, const Variant& less, double difference) const {
  static constexpr std::string_view changes = "which cells divide or exchange neighbours, when and how, are";
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 7> constants{{
      {"division.", changes},
      {"exchange.", changes},
      {"extrusion.", changes},
      {"time.", "steps are"},
      {"output.", "steps are"},
      {"stop.", "steps are"},
      {"self_contact.distance_um", "which surfaces are near each other, and how near, when they first touch, are"},
  }};
  for (const auto& [start, what] : constants)
    if (name.starts_with(start))
      throw NoGradient(
          fmt::format("{}: has no gradient, since {} constants of the recorded run; choose another key", name, what));
  return model_pair(*solved_, std::move(name), solved_model(more), solved_model(less), difference);
}

OutcomeGradient Tape::of_solved_side(const OutcomeGradient& outcome) const {
  if (!mirror_.is_used()) return outcome;
  OutcomeGradient of_side;
  for (const auto& [state, of_whole] : outcome) {
    Vectors& sum = of_side[state] = Vectors(solved_->tissue.node_count(), Vec3::Zero());
    for (std::size_t n = 0; n < of_whole.size(); ++n) {
      const auto [node, signs] = mirror_.image(NodeId(n));
      sum[node.index()] += signs.cwiseProduct(of_whole[n]);
    }
  }
  return of_side;
}

std::optional<RunGradient> Tape::gradient(const OutcomeGradient& outcome, const Wanted& wanted) const {
  GradientInput input{
      .parameters = wanted.parameters, .tolerance = wanted.tolerance, .stop_requested = wanted.stop_requested};
  if (!wanted.law.empty()) {
    input.law = place_of_law(*solved_, wanted.law);
    const auto unscaled = unscaled_.find(*input.law);
    if (unscaled != unscaled_.end()) {
      input.unscaled_law = unscaled->second.get();
      const std::vector<double>& factors = strengths_.at(wanted.law);
      for (std::size_t c = 0; c < solved_->tissue.cells.size(); ++c)
        input.factors.push_back(factors[mirror_.is_used() ? mirror_.origins[c].index() : c]);
    }
  }
  if (!outcome.empty() && part_of(outcome.rbegin()->first).change) return gradient_by_tangents(outcome, wanted);
  std::optional<RunGradient> gradient =
      way_back(*solved_, parts_.front().run, method_.linear_method, of_solved_side(outcome), input);
  if (gradient && input.law && mirror_.is_used()) {
    const std::vector<double> by_side = std::move(gradient->by_strength);
    const double copies = static_cast<double>(mirror_.cells.size()) / static_cast<double>(by_side.size());
    gradient->by_strength.clear();
    for (const CellId cell : mirror_.cells) gradient->by_strength.push_back(by_side[cell.index()] / copies);
  }
  return gradient;
}

std::optional<RunGradient> Tape::gradient_by_tangents(const OutcomeGradient& outcome, const Wanted& wanted) const {
  const std::size_t cells = wanted.law.empty() ? 0 : solved_->tissue.cells.size();
  std::vector<ModelPair> of_cells;
  for (std::size_t c = 0; c < cells; ++c) {
    constexpr double change = 1e-4;
    StrengthFactors of_cell{{wanted.law, std::vector<double>(cells, 0.0)}};
    of_cell[wanted.law][c] = 1;
    of_cells.push_back({wanted.law, solved_model(of_cell, change), solved_model(of_cell, -change), 2 * change});
  }
  TangentInput input{wanted.parameters, wanted.tolerance, wanted.stop_requested};
  for (const ModelPair& pair : of_cells) input.parameters.push_back(&pair);
  const auto rows = jacobian({outcome}, input);
  if (!rows) return std::nullopt;
  const auto first_cell = rows->front().begin() + static_cast<std::ptrdiff_t>(wanted.parameters.size());
  return RunGradient{{rows->front().begin(), first_cell}, {first_cell, rows->front().end()}};
}

std::optional<std::vector<std::vector<double>>> Tape::jacobian(const std::vector<OutcomeGradient>& outcomes,
                                                               const TangentInput& wanted) const {
  std::vector<std::vector<double>> rows(outcomes.size(), std::vector<double>(wanted.parameters.size(), 0.0));
  std::vector<OutcomeGradient> of_side;
  std::size_t last = 0;
  for (const OutcomeGradient& outcome : outcomes) {
    of_side.push_back(of_solved_side(outcome));
    if (!outcome.empty()) last = std::max(last, outcome.rbegin()->first);
  }
  const auto add = [&](std::size_t state, std::span<const Vectors> by_parameter) {
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const auto gradient = of_side[row].find(state);
      if (gradient == of_side[row].end()) continue;
      for (std::size_t p = 0; p < by_parameter.size(); ++p)
        rows[row][p] += parallel_dot(std::span<const Vec3>(gradient->second), std::span<const Vec3>(by_parameter[p]));
    }
  };
  if (!tangents(parts_, method_.linear_method, last, wanted, add)) return std::nullopt;
  return rows;
}

std::optional<std::vector<Vectors>> Tape::tangent(const StrengthFactors& change, std::span<const std::size_t> states,
                                                  const TangentInput& wanted) const {
  double largest = 0;
  for (const auto& [law, of_cells] : change)
    for (const double of_cell : of_cells) largest = std::max(largest, std::abs(of_cell));
  const double size = largest > 0 ? 1e-4 / largest : 1;
  const ModelPair pair{"strengths", solved_model(change, size), solved_model(change, -size), 2 * size};
  TangentInput input = wanted;
  input.parameters = {&pair};
  std::vector<Vectors> found(states.size());
  const auto take = [&](std::size_t state, std::span<const Vectors> by_parameter) {
    for (std::size_t place = 0; place < states.size(); ++place)
      if (states[place] == state)
        found[place] = mirror_.is_used() ? mirror_.full_vectors(by_parameter[0]) : by_parameter[0];
  };
  if (!tangents(parts_, method_.linear_method, *std::ranges::max_element(states), input, take)) return std::nullopt;
  return found;
}

Tape Tape::replayed(const Variant& changed, const StrengthFactors& strengths) const {
  Tape other;
  other.scenario_ = std::make_shared<const Scenario>(changed.scenario);
  other.add_ = addition_of(changed);
  other.strengths_ = strengths;
  Simulation::Parts parts = smooth_parts_of(changed.scenario, other.add_);
  other.unscaled_ = scale_strengths(parts, strengths);
  other.first_internals_ = first_internals_;
  other.mirror_ = mirror_;
  other.measure_plans_ = measure_plans_;
  other.method_ = method_;
  other.solved_ = std::move(parts.model);
  other.whole_ = mirror_.is_used() ? std::make_shared<const Model>(parts.full_model->model()) : other.solved_;
  other.parts_ = plica::replayed(other.solved_, parts_, method_);
  return other;
}

}  // namespace plica
