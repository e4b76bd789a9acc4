// Simulation of one run: model, state, and the time-stepping loop (THE LOOP).
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "measure/observation.hpp"
#include "mechanics/model.hpp"
#include "scenario/scenario.hpp"
#include "simulation/controls.hpp"
#include "simulation/full_model.hpp"
#include "simulation/run_memory.hpp"

namespace plica {

enum class RunStatus { under_way, equilibrium, end_time, failed };

/// Word of a status in results and interfaces.
const char* word(RunStatus status);

/// Observer of simulation events. Must outlive the simulation or unregister.
class SimulationListener {
 public:
  virtual ~SimulationListener() = default;

  /// Called after an accepted step, before the divisions and exchanges due at its end.
  virtual void step_accepted(const AcceptedStep& /*step*/, const Observation& /*measures*/) {}

  /// Called after divisions or exchanges, which change model and state of the simulation.
  virtual void cells_divided(const TissueChange& /*change*/) {}
  /// Called before that, with what makes the same change again.
  virtual void change_made(const RepeatedChange& /*again*/) {}
};

/// Simulation advanced by its owner. Instances are independent; a copy branches the run and continues bitwise
/// identically. Prints nothing, writes no files and handles no signals.
///
///   Simulation simulation(load_scenario(find_scenario("drosophila")));
///   while (simulation.step()) fmt::print("{}\n", *simulation.measures()["furrow_depth_um"]);
class Simulation {
 public:
  /// Starts in the reference state. Throws ScenarioError for errors that only the tissue reveals, FileError for files
  /// of the scenario.
  explicit Simulation(const Scenario& scenario);

  /// Components. `full_model`: set if `model` is one side of it.
  struct Parts {
    std::unique_ptr<Model> model;
    RunControls controls;
    MeasurePlan measure_plan = {};  // what is measured
    std::optional<FullModel> full_model = {};
    std::shared_ptr<const Scenario> scenario = {};  // names remedies of a failure; null: none
  };
  explicit Simulation(Parts parts);

  /// Listeners and stop_when are not copied. `other` forgets a reused factorization, which the copy does not have.
  Simulation(const Simulation& other);
  Simulation& operator=(const Simulation& other);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Take the next step, shortened until it is accepted, to `until_s` at most; then make the divisions and
  /// exchanges due. Returns false if the run has ended, the step failed or was stopped, or the time is `until_s`
  /// already.
  bool step(double until_s = std::numeric_limits<double>::infinity());

  /// Take steps to exactly `time_s`, or until the run ends, fails or is stopped.
  RunStatus run_until(double time_s);
  RunStatus run() { return run_until(std::numeric_limits<double>::infinity()); }

  [[nodiscard]] RunStatus status() const;
  /// Cause, place and time of a solver failure; empty unless the run failed. The state is the last accepted one.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  /// Id of the cell at which the solver failed, if it is one cell.
  [[nodiscard]] const std::optional<int>& failed_cell() const { return failed_cell_; }

  /// Model and state of the whole embryo, also if one side is solved. The model is that of this time: a step in which
  /// cells grow makes another.
  [[nodiscard]] const Model& model() const { return full_model_ ? full_model_->model() : solved(); }
  [[nodiscard]] const State& state() const { return full_model_ ? full_model_->state() : now_.state; }
  /// Model and state that are solved: of one side if mirror planes leave one, else of the whole embryo.
  [[nodiscard]] const Model& solved_model() const { return solved(); }
  [[nodiscard]] const State& solved_state() const { return now_.state; }
  [[nodiscard]] double time_s() const { return now_.state.time_s; }
  [[nodiscard]] int steps() const { return now_.steps; }
  [[nodiscard]] int divisions() const { return now_.divisions; }
  [[nodiscard]] bool criterion_met() const { return now_.measures.is_over; }
  [[nodiscard]] const std::optional<double>& equilibrium_time_s() const { return now_.equilibrium_time_s; }
  /// Wall time of all steps, including those before a checkpoint, s.
  [[nodiscard]] double computing_s() const { return now_.computing_s; }
  [[nodiscard]] const RunControls& controls() const { return controls_; }

  /// Energy flows summed over all steps, in the order of energy_flows; empty before the first.
  [[nodiscard]] const std::vector<EnergyFlow>& energies() const { return now_.energies; }

  /// Skip these columns from the next step on.
  void leave_out(const std::function<bool(const Column&)>& which) { observer_.leave_out(which); }
  /// Measures of the last accepted step, or of the reference state.
  [[nodiscard]] const Observation& measures() const { return now_.measures; }
  [[nodiscard]] const Observer& observer() const { return observer_; }

  /// Checkpoint: everything the next step depends on besides the scenario. A reused factorization is forgotten.
  [[nodiscard]] RunMemory memory() const;
  /// Whether none is in use, so that memory() changes nothing: at the latest after every tenth step, at the time that a
  /// step was asked for, before a division and at the end.
  [[nodiscard]] bool is_resumable() const { return steps_with_factor_ == 0; }

  /// Continue from a checkpoint of the same scenario; call in the reference state only. Throws UnfitMemory if it does
  /// not fit this model. Listeners are not notified of past divisions.
  void go_on_from(RunMemory memory);

  /// Override the activity time course of a law (identifier: contraction.apical) with factors on the scenario's values;
  /// cells, >= 0 or GivenActivities::as_programmed; empty: restore the time courses. A run at equilibrium continues.
  /// Throws UsageError for an unknown identifier, a wrong size or value, and asymmetric factors if one side is solved.
  void set_activity(const std::string& label, std::vector<double> activities);

  /// Set factors on the tension of single walls in a lateral cortex; in the order of measured_walls, >= 0; empty: none.
  /// They stay with their two cells, which daughters replace; cells that meet have 1. Throws UsageError as set_activity
  /// does, and with mirror planes.
  void set_wall_factors(const std::string& label, std::span<const double> factors);

  /// Replace the concentrations of a signal; cells. Throws UsageError as set_activity does.
  void set_signal(const std::string& name, CellArray values);

  /// Keep values of cells that snapshots and checkpoints carry along and no law reads, such as the state of a coupled
  /// model; daughters inherit them. Throws UsageError for the name of another array, a wrong size, or a value that is
  /// not finite.
  void set_cell_array(const std::string& name, CellArray values);
  [[nodiscard]] const std::map<std::string, CellArray>& outside_arrays() const { return now_.outside_arrays; }

  void listen(SimulationListener& listener) { listeners_.push_back(&listener); }
  void stop_listening(SimulationListener& listener) { std::erase(listeners_, &listener); }

  /// `stop_requested` is polled often within a step; once true, the step is abandoned and the last accepted state is
  /// kept.
  void stop_when(std::function<bool()> stop_requested);

 private:
  [[nodiscard]] const Model& solved() const { return grown_ ? *grown_ : *model_; }
  bool has_stalled();
  std::optional<StepReport> take_step(double until_s, State& before);
  bool advance_signals(const Model& model, State& next);
  void divide(const std::vector<PlannedDivision>& due);
  void exchange();
  bool mend_cells(int& attempts);
  void adopt(const TissueChange& change, const RepeatedChange& again);
  void restart_at_a_jump();
  EnergyFlow account_for_energy(const State& before);
  void renew_stepper();
  void forget_factor() const;

  std::shared_ptr<const Scenario> scenario_;
  std::unique_ptr<Model> model_;         // the solved model, as it is after the last division
  std::optional<Model> grown_;           // the same at the time of `now_`, its state, if cells have grown
  std::optional<FullModel> full_model_;  // of which `model_` is one side, if any
  RunControls controls_;
  RunMemory now_;
  std::unique_ptr<Stepper> stepper_;
  mutable int steps_with_factor_ = 0;  // taken since the stepper had none to reuse
  StepLength step_length_;
  Observer observer_;
  bool has_begun_ = false;  // since construction or resumption: divisions due then are done
  std::string failure_;
  std::optional<int> failed_cell_;
  std::vector<SimulationListener*> listeners_;
  std::function<bool()> stop_requested_;
};

/// Components of a scenario's simulation, for callers that add to them. Throws as Simulation does.
Simulation::Parts parts_of(const Scenario& scenario);

}  // namespace plica
