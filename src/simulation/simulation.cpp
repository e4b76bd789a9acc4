#include "simulation/simulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/clock.hpp"
#include "core/errors.hpp"
#include "core/names.hpp"
#include "measure/cell_columns.hpp"
#include "measure/neighbours.hpp"
#include "measure/walls.hpp"
#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/division.hpp"
#include "mechanics/energy.hpp"
#include "scenario/advice.hpp"
#include "scenario/setup.hpp"

namespace plica {
namespace {

// In a row, since a resumed run repeats them.
constexpr int most_steps_with_factor = 10;

double max_speed(const State& state) {
  double fastest = 0;
  for (const Vec3& velocity : state.velocities) fastest = std::max(fastest, velocity.norm());
  return fastest;
}

bool passes_frame(double from_s, double to_s, double every_s) {
  const auto frames_until = [&](double time_s) { return std::floor((time_s + instant_s) / every_s + 1e-9); };
  return every_s > 0 && frames_until(to_s) > frames_until(from_s);
}

double last_of(const std::vector<double>& times_s) {
  return times_s.empty() ? 0 : *std::max_element(times_s.begin(), times_s.end());
}

// Users identify cells by id, which differs from the index after divisions.
int id_of(const Model& model, CellId cell) { return model.tissue.cells[cell.index()].lineage.id; }

// Whether all nodes of a cell are fixed, so that its volume cannot change.
std::optional<CellId> held_cell_that_grows(const Model& model, const State& state) {
  if (!model.volumes.is_held()) return std::nullopt;
  const std::vector<double> errors = model.volumes.relative_errors(state.positions);
  const auto is_held = [&](NodeId node) { return std::ranges::count(model.held[node.index()], true) == 3; };
  for (std::size_t c = 0; c < errors.size(); ++c)
    if (std::abs(errors[c]) > 1e-9 && std::ranges::all_of(model.tissue.cells[c].corners, is_held)) return CellId(c);
  return std::nullopt;
}

std::string with_remedies(const std::string& text, StepReport::Status status, const State& state,
                          const Scenario* scenario) {
  const std::string remedies = scenario ? remedies_text(remedies_of(*scenario, {status, state.time_s})) : "";
  return remedies.empty() ? text : text + "; " + remedies;
}

std::string failure_text(StepReport report, const Model& model, const State& state, double duration_s,
                         const Scenario* scenario) {
  const std::optional<CellId> held = held_cell_that_grows(model, state);
  if (report.cell) report.cell = CellId(id_of(model, *report.cell));
  std::string text =
      fmt::format("{} at t = {:g} s, with steps down to {:g} s", report.reason(), state.time_s, duration_s);
  if (held)
    return text + fmt::format(
                      "; cell {} must change its volume, but all its corners are fixed: fix fewer nodes, or "
                      "exclude it from division and growth",
                      id_of(model, *held));
  return with_remedies(text, report.status, state, scenario);
}

// Model that divisions made of the initial one; null if there were none.
std::unique_ptr<Model> changed_model(const Model& initial, const RunMemory& memory) try {
  if (!memory.changes) return nullptr;
  return std::make_unique<Model>(restored(initial, *memory.changes, memory.state.positions.size()));
} catch (const std::logic_error&) {
  throw UnfitMemory("its cells do not fit this embryo");
}

}  // namespace

Simulation::Parts parts_of(const Scenario& scenario) {
  Simulation::Parts parts;
  parts.model = make_model(scenario);
  parts.controls = make_controls(scenario);
  parts.measure_plan = make_measure_plan(scenario, *parts.model);
  parts.scenario = std::make_shared<const Scenario>(scenario);
  if (auto side = make_solved_side(scenario, *parts.model))
    parts.full_model.emplace(std::move(*std::exchange(parts.model, std::move(side->model))), std::move(side->mirror));
  return parts;
}

Simulation::Simulation(const Scenario& scenario) : Simulation(parts_of(scenario)) {}

Simulation::Simulation(Parts parts)
    : scenario_(std::move(parts.scenario)),
      model_(std::move(parts.model)),
      full_model_(std::move(parts.full_model)),
      controls_(std::move(parts.controls)),
      step_length_(controls_),
      observer_(model(), std::move(parts.measure_plan)) {
  for (const auto& law : model_->laws) {
    std::ranges::copy(law->program_points_s(), std::back_inserter(controls_.program_points_s));
    std::ranges::copy(law->program_jumps_s(), std::back_inserter(controls_.program_jumps_s));
  }
  now_.state = rest_state(*model_);
  now_.measures = observer_.observe({model(), state()}, nullptr);
  renew_stepper();
}

Simulation::Simulation(const Simulation& other)
    : scenario_(other.scenario_),
      model_(std::make_unique<Model>(*other.model_)),
      grown_(other.grown_),
      full_model_(other.full_model_),
      controls_(other.controls_),
      now_(other.memory()),
      step_length_(other.step_length_),
      observer_(other.observer_),
      has_begun_(other.has_begun_),
      failure_(other.failure_),
      failed_cell_(other.failed_cell_) {
  renew_stepper();
}

Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Simulation& Simulation::operator=(const Simulation& other) {
  if (this != &other) *this = Simulation(other);
  return *this;
}

void Simulation::renew_stepper() {
  stepper_ = make_stepper(*model_, controls_.scheme);
  stepper_->stop_when(stop_requested_);
  steps_with_factor_ = 0;
}

void Simulation::forget_factor() const {
  stepper_->forget_factor();
  steps_with_factor_ = 0;
}

void Simulation::stop_when(std::function<bool()> stop_requested) {
  stop_requested_ = std::move(stop_requested);
  stepper_->stop_when(stop_requested_);
}

RunMemory Simulation::memory() const {
  RunMemory memory = now_;
  memory.wanted_step_s = step_length_.wanted_s();
  memory.careful_steps = step_length_.careful_steps();
  forget_factor();
  if (full_model_) memory.whole_internals = full_model_->state().internals;
  return memory;
}

void Simulation::set_activity(const std::string& label, std::vector<double> activities) {
  const std::size_t place = place_of_law(*model_, label, true);
  const std::size_t cells = model().tissue.cells.size();
  if (!activities.empty() && activities.size() != cells)
    throw UsageError(fmt::format("{}: {} activities for {} cells; give one per cell", label, activities.size(), cells));
  for (std::size_t c = 0; c < activities.size(); ++c)
    if (activities[c] != GivenActivities::as_programmed && !(activities[c] >= 0 && std::isfinite(activities[c])))
      throw UsageError(fmt::format("{}: the activity of cell {} is {}; give a number >= 0", label,
                                   id_of(model(), CellId(c)), activities[c]));
  if (full_model_) activities = full_model_->take_activities(place, activities);
  std::vector<double>& internal = now_.state.internals[place];
  internal = model_->laws[place]->with_activities(internal, activities);
  now_.at_equilibrium = false;
  now_.equilibrium_time_s.reset();
}

void Simulation::set_wall_factors(const std::string& label, std::span<const double> factors) {
  std::vector<double> internal = with_wall_factors(model(), state(), label, factors);
  if (full_model_)
    throw UsageError(label + ": walls of an embryo with mirror planes take no factors; remove embryo.mirror");
  now_.state.internals[place_of_law(*model_, label)] = std::move(internal);
  now_.at_equilibrium = false;
  now_.equilibrium_time_s.reset();
}

void Simulation::set_signal(const std::string& name, CellArray values) {
  const std::vector<std::string> names = names_of(model_->signals.rules());
  const auto place = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  const std::size_t cells = model().tissue.cells.size();
  if (place == names.size())
    throw UsageError(names.empty() ? fmt::format("no signal \"{}\"; add [signal.{}] to the scenario", name, name)
                                   : fmt::format("no signal \"{}\"; signals: {}", name, fmt::join(names, ", ")));
  if (values.size() != cells)
    throw UsageError(
        fmt::format("signal {}: {} concentrations for {} cells; give one per cell", name, values.size(), cells));
  for (std::size_t c = 0; c < cells; ++c)
    if (!std::isfinite(values[c]))
      throw UsageError(fmt::format("signal {}: the concentration of cell {} is {}; give a finite number", name,
                                   id_of(model(), CellId(c)), values[c]));
  if (full_model_) values = full_model_->take_signal(place, values);
  now_.state.signals[place] = std::move(values);
  follow_signals(*model_, now_.state);
  now_.at_equilibrium = false;
  now_.equilibrium_time_s.reset();
}

void Simulation::set_cell_array(const std::string& name, CellArray values) {
  const Tissue& tissue = model().tissue;
  const bool is_taken = is_plicas(name) || tissue.cell_arrays.contains(name) ||
                        std::ranges::count(cell_columns(), name, &CellColumn::name) > 0;
  const bool is_text = std::ranges::none_of(name, [](unsigned char c) { return c < ' '; });
  if (name.empty() || is_taken || !is_text)
    throw UsageError(fmt::format(
        "array \"{}\": {}; choose another name", name,
        is_taken ? "is an output variable or an array of the embryo" : "the name is empty or has control characters"));
  if (values.size() != tissue.cells.size())
    throw UsageError(fmt::format("array \"{}\": {} values for {} cells; give one per cell", name, values.size(),
                                 tissue.cells.size()));
  for (std::size_t c = 0; c < values.size(); ++c)
    if (!std::isfinite(values[c]))
      throw UsageError(fmt::format("array \"{}\": the value of cell {} is {}; give a finite number", name,
                                   id_of(model(), CellId(c)), values[c]));
  now_.outside_arrays[name] = std::move(values);
}

void Simulation::go_on_from(RunMemory memory) {
  if (full_model_ ? memory.changes || why_unfit(memory.whole_internals, full_model_->model())
                  : !memory.whole_internals.empty())
    throw UnfitMemory("its mirror planes do not fit this embryo");
  const std::unique_ptr<Model> changed = changed_model(*model_, memory);
  const Model& present = changed ? *changed : *model_;
  if (const auto why = why_unfit(memory, present)) throw UnfitMemory(*why);
  if (memory.measures.monitors.size() != observer_.monitors().size())
    throw UnfitMemory("its output variables do not fit the monitors");
  const std::size_t cells = (full_model_ ? full_model_->model() : present).tissue.cells.size();
  for (const auto& [name, values] : memory.outside_arrays)
    if (values.size() != cells) throw UnfitMemory("its cell arrays do not fit this embryo");
  if (changed) {
    observer_.follow_division(changed->tissue, change_of(*memory.changes, model_->tissue));
    *model_ = std::move(*changed);
  }
  std::ranges::copy(memory.growth_ends_s, std::back_inserter(controls_.program_points_s));
  now_ = std::move(memory);
  if (full_model_) full_model_->go_to(*model_, now_.state, std::move(now_.whole_internals));
  step_length_ = StepLength(controls_, now_.wanted_step_s, now_.careful_steps);
  grown_ = grown(*model_, *model_, now_.state.internals, now_.state.time_s);
  renew_stepper();
}

// Divide cells and update everything indexed by cells and nodes.
void Simulation::divide(const std::vector<PlannedDivision>& due) {
  const double now_s = now_.state.divided_until_s = now_.state.time_s;
  if (due.empty()) return;
  now_.divisions += static_cast<int>(due.size());
  const TissueChange change = divide_cells(*model_, now_.state, due);
  std::erase_if(now_.growth_ends_s, [&](double end_s) { return has_come(end_s, now_s); });
  for (const PlannedDivision& one : due)
    for (auto* times_s : {&now_.growth_ends_s, &controls_.program_points_s}) times_s->push_back(now_s + one.growth_s);
  step_length_ = StepLength(controls_);
  adopt(change, [due](Model& model, State& state) {
    divide_cells(model, state, due);
    return true;
  });
}

// Turn short walls and take out cells, once after a step. After exchanges, motion and length of steps continue.
void Simulation::exchange() {
  if (!controls_.exchange || status() != RunStatus::under_way) return;
  if (now_.state.exchanges.until_s == now_.state.time_s) return;
  const ExchangeRule& rule = *controls_.exchange;
  if (const auto outcome = make_exchanges(*model_, now_.state, rule, controls_.extrusions))
    adopt(outcome->change, repeated_exchange(*outcome, rule));
  while (const auto outcome = make_parting(*model_, now_.state, rule, controls_.extrusions))
    adopt(outcome->change, repeated_parting(*outcome, rule));
  if (const auto outcome = make_extrusions(*model_, now_.state, controls_.extrusions))
    adopt(outcome->change, repeated_extrusion(*outcome));
}

// Mend cells that leave Newton's method no step: split those with bad elements again, or else undo the exchanges since
// the last step. False: nothing is left to do.
bool Simulation::mend_cells(int& attempts) {
  if (!controls_.exchange) return false;
  const ExchangeRule& rule = *controls_.exchange;
  const auto take = [&](const auto& outcome, const auto& repeated) {
    if (!outcome) return false;
    adopt(outcome->change, repeated(*outcome));
    step_length_ = StepLength(controls_);
    return true;
  };
  const auto again = [&](const ExchangeOutcome& outcome) { return repeated_exchange(outcome, rule); };
  while (attempts < 2)
    if (attempts++ == 0 ? take(make_splits(*model_, now_.state, rule), repeated_split)
                        : take(undo_exchanges(*model_, now_.state, rule), again))
      return true;
  return false;
}

// Follow a change of the model and the state.
void Simulation::adopt(const TissueChange& change, const RepeatedChange& again) {
  now_.equilibrium_time_s.reset();             // it counts only after the last change
  now_.pace = {.since_s = now_.state.time_s};  // steps about changes are short and hard, but the tissue changes
  grown_.reset();
  now_.changes = std::make_shared<const ModelMemory>(
      memory_of(*model_, now_.changes ? inherited(change, now_.changes->origin) : change.origin));
  observer_.follow_division(model_->tissue, change);
  follow(change, now_.outside_arrays);
  const int steps = steps_with_factor_;
  renew_stepper();
  steps_with_factor_ = steps;  // or runs with many events would not become resumable
  for (SimulationListener* listener : listeners_) {
    listener->change_made(again);
    listener->cells_divided(change);
  }
}

// After a jump of forces the earlier motion predicts nothing: no predictor, no error estimate, a short first step.
void Simulation::restart_at_a_jump() {
  const double now_s = now_.state.time_s;
  if (std::ranges::none_of(controls_.program_jumps_s, [&](double jump_s) { return is_same_instant(jump_s, now_s); }))
    return;
  now_.state.trend = {};
  step_length_ = StepLength(controls_);
}

// Add the energy flows of the step and return them. Cells are taken as grown at mid-step, since they do work meanwhile.
EnergyFlow Simulation::account_for_energy(const State& before) {
  const std::optional<Model> midway =
      grown(*model_, solved(), before.internals, 0.5 * (before.time_s + now_.state.time_s));
  std::vector<EnergyFlow> flows = energy_flows(midway ? *midway : solved(), before, now_.state);
  const double copies = full_model_ ? full_model_->copies() : 1;
  for (auto& [active, stored, dissipated] : flows) active *= copies, stored *= copies, dissipated *= copies;
  now_.energies.resize(flows.size());
  EnergyFlow sum;
  for (std::size_t l = 0; l < flows.size(); ++l) sum += now_.energies[l] += flows[l];
  return sum;
}

RunStatus Simulation::status() const {
  if (!failure_.empty()) return RunStatus::failed;
  if (!has_ended(now_, controls_)) return RunStatus::under_way;
  const bool is_enough = controls_.stop_at_equilibrium || criterion_met();
  return now_.at_equilibrium && is_enough ? RunStatus::equilibrium : RunStatus::end_time;
}

const char* word(RunStatus status) {
  constexpr std::array words = {"under_way", "equilibrium", "end_time", "failed"};
  return words[static_cast<std::size_t>(status)];
}

RunStatus Simulation::run_until(double time_s) {
  while (step(time_s)) continue;
  return status();
}

bool Simulation::step(double until_s) {
  if (has_come(until_s, now_.state.time_s)) return false;
  if (!has_begun_) {
    if (now_.state.divided_until_s != now_.state.time_s)  // else done: an exchange may have made more of them due
      divide(due_divisions(solved(), now_.state, controls_.divisions, controls_.extrusions));
    exchange();
  }
  has_begun_ = true;
  if (status() != RunStatus::under_way) return false;

  if (has_stalled()) return false;
  restart_at_a_jump();
  const auto start = std::chrono::steady_clock::now();
  State before;
  const std::optional<StepReport> report = take_step(until_s, before);
  now_.computing_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!report) return false;

  if (controls_.exchange)
    now_.state.exchanges.shear += shear_between(solved().tissue, solved().tissue.regions.at(controls_.exchange->region),
                                                before.positions, now_.state.positions);
  const State& state = now_.state;
  const double speed = max_speed(state);
  const std::vector<PlannedDivision> due = due_divisions(solved(), state, controls_.divisions, controls_.extrusions);
  now_.at_equilibrium = speed < controls_.equilibrium_speed_um_per_s && due.empty() &&
                        are_at_rest(before.signals, state.signals, state.time_s - before.time_s) &&
                        !cells_grow(*model_, state.internals, state.time_s) &&
                        has_come(last_of(controls_.program_points_s), state.time_s) &&
                        has_come(last_of(controls_.program_jumps_s), before.time_s);
  if (now_.at_equilibrium && !now_.equilibrium_time_s) now_.equilibrium_time_s = state.time_s;
  // The snapshot at a division shows the daughters.
  const bool frame_is_due = due.empty() && passes_frame(before.time_s, state.time_s, controls_.frame_every_s);
  const EnergyFlow energy = account_for_energy(before);
  const State whole_before = full_model_ ? full_model_->follow(*model_, state) : State();
  const AcceptedStep step{this->state(),
                          full_model_ ? whole_before : before,
                          state.trend.step_s,
                          *report,
                          speed,
                          frame_is_due,
                          now_.at_equilibrium,
                          energy};
  now_.measures = observer_.observe({model(), step.state, now_.computing_s}, &step);
  if (++steps_with_factor_ >= most_steps_with_factor || !stepper_->keeps_factor() || !due.empty() ||
      has_come(until_s, state.time_s) || has_ended(now_, controls_))
    forget_factor();
  for (SimulationListener* listener : listeners_) listener->step_accepted(step, now_.measures);
  divide(due);
  exchange();
  return true;
}

// Judge the pace of the last steps; if it will do, count again.
bool Simulation::has_stalled() {
  if (!now_.pace.is_known()) return false;
  const auto stalled = standstill(now_.pace, controls_, solved(), now_.state);
  if (!stalled) {
    now_.pace = {.since_s = now_.state.time_s};
    return false;
  }
  failed_cell_ = id_of(*model_, stalled->cell);
  failure_ = with_remedies(fmt::format("{} at t = {:g} s", stalled->reason, now_.state.time_s),
                           StepReport::Status::no_convergence, now_.state, scenario_.get());
  return true;
}

// Advance the signals to the end of a step, on its cells. False: they have none, and the run fails.
bool Simulation::advance_signals(const Model& model, State& next) {
  const auto failure = plica::advance_signals(model, now_.state, next);
  if (!failure) return true;
  failed_cell_ = id_of(model, failure->cell);
  failure_ =
      fmt::format("{} in cell {} at t = {:g} s; {}", failure->problem, *failed_cell_, next.time_s, failure->remedy);
  return false;
}

// Advance the state by one step; `before` receives the old state. Empty on failure or stop: the state is unchanged
// then, except that cells may have been split again and exchanges undone.
std::optional<StepReport> Simulation::take_step(double until_s, State& before) {
  State& next = before;
  int refused = 0, wasted_iterations = 0, wasted_solves = 0, mendings = 0;
  while (true) {
    const double end_s = step_length_.propose_end_s(controls_, now_.state.time_s, until_s);
    const double duration_s = end_s - now_.state.time_s;
    std::optional<Model> later = grown(*model_, solved(), now_.state.internals, end_s);
    const Model& model = later ? *later : solved();
    StepReport report = stepper_->advance(now_.state, duration_s, now_.steps == 0, next, &model);
    if (report.status == StepReport::Status::interrupted) return std::nullopt;
    const bool solved = report.converged();
    if (solved) {
      next.time_s = end_s;  // exact, not a rounded sum
      report.refused = refused;
      report.newton_iterations += std::exchange(wasted_iterations, 0);
      report.linear_solves += std::exchange(wasted_solves, 0);
    }
    if (solved && step_length_.accept(controls_, now_.state, next)) {
      if (!advance_signals(model, next)) return std::nullopt;
      std::swap(now_.state, next);
      if (later) grown_ = std::move(later);
      ++now_.steps;
      ++now_.pace.steps;
      now_.pace.iterations += report.newton_iterations;
      return report;
    }
    ++refused;
    wasted_iterations += report.newton_iterations;
    wasted_solves += report.linear_solves;
    if (solved) continue;
    stepper_->forget_factor();
    if (step_length_.halve(controls_, duration_s) || mend_cells(mendings)) continue;
    if (report.cell) failed_cell_ = id_of(*model_, *report.cell);
    failure_ = failure_text(report, model, now_.state, duration_s, scenario_.get());
    return std::nullopt;
  }
}

}  // namespace plica
