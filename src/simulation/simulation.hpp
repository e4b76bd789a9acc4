// One run: a model, where it is now, and the way on, a step after another (THE LOOP).
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
#include "simulation/run_memory.hpp"
#include "simulation/step_length.hpp"
#include "simulation/whole.hpp"

namespace plica {

enum class RunStatus { under_way, equilibrium, end_time, failed };

/// What other programs call it.
const char* word(RunStatus status);

/// Hears of what happens in a simulation. Outlives it, or stops listening.
class SimulationListener {
 public:
  virtual ~SimulationListener() = default;

  /// A step has been accepted; what is due to divide has not divided yet.
  virtual void step_accepted(const AcceptedStep& /*step*/, const Observation& /*measures*/) {}

  /// Cells have divided: the simulation's model and state are new.
  virtual void cells_divided(const Division& /*division*/) {}
};

/// A run that whoever holds it takes forward. Two do not disturb each other; a copy is a fork in time, which goes on to
/// the same bits. It prints nothing, writes no file and knows no signals.
///
///   Simulation simulation(load_scenario(find_scenario("drosophila")));
///   while (simulation.step()) fmt::print("{}\n", *simulation.measures()["furrow_depth_um"]);
class Simulation {
 public:
  /// At rest. Throws ScenarioError for what only the tissue shows to be wrong, FileError for files that it names.
  explicit Simulation(const Scenario& scenario);

  /// What it is made of. `sites` and `watch`: what is measured beside the sheet as a whole. `whole`: that of which the
  /// model is one side; else it is a whole by itself.
  struct Parts {
    std::unique_ptr<Model> model;
    RunControls controls;
    FurrowSites sites = {};
    Watch watch = {};
    std::optional<Whole> whole = {};
  };
  explicit Simulation(Parts parts);

  /// Neither listeners nor stop_when are copied. The copy makes a factor that is kept between steps anew.
  Simulation(const Simulation& other);
  Simulation& operator=(const Simulation& other);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Takes the next step, shorter ones until one is accepted, which ends at `until_s` at the latest; then cells divide
  /// that are due. False when there is no next step, when it failed or was stopped, or when that time has come.
  bool step(double until_s = std::numeric_limits<double>::infinity());

  /// Steps until `time_s`, on which a step ends, or until the run ends, fails or is stopped.
  RunStatus run_until(double time_s);
  RunStatus run() { return run_until(std::numeric_limits<double>::infinity()); }

  [[nodiscard]] RunStatus status() const;
  /// What gave up, where and when; empty unless the run failed. The state is the last good one.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  /// The id of the cell that it gave up at, where it was one.
  [[nodiscard]] const std::optional<int>& failed_cell() const { return failed_cell_; }

  /// Of the whole embryo, also where one side of it is solved.
  [[nodiscard]] const Model& model() const { return whole_ ? whole_->model() : *model_; }
  [[nodiscard]] const State& state() const { return whole_ ? whole_->state() : now_.state; }
  [[nodiscard]] double time_s() const { return now_.state.time_s; }
  [[nodiscard]] int steps() const { return now_.steps; }
  [[nodiscard]] int divisions() const { return now_.divisions; }
  [[nodiscard]] bool criterion_met() const { return now_.criterion_met; }
  [[nodiscard]] const std::optional<double>& equilibrium_time_s() const { return now_.equilibrium_time_s; }
  /// Wall time that its steps have taken, those before a checkpoint too.
  [[nodiscard]] double computing_s() const { return now_.computing_s; }
  [[nodiscard]] const RunControls& controls() const { return controls_; }

  /// Where energy has gone in all steps so far, as energy_flows lists it; empty before the first.
  [[nodiscard]] const std::vector<EnergyFlow>& energies() const { return now_.energies; }

  /// From the next step on, measures leave these out.
  void leave_out(const std::function<bool(const Column&)>& which) { observer_->leave_out(which); }
  /// Measures of the last accepted step, or of the body at rest.
  [[nodiscard]] const Observation& measures() const { return measures_; }
  [[nodiscard]] const Observer& observer() const { return *observer_; }

  /// A checkpoint: all that the next step depends on beside the scenario.
  [[nodiscard]] RunMemory memory() const;

  /// Goes on from a memory of the same scenario; from rest only. `measures`: those of the memory's last step.
  /// UnfitMemory when it cannot be one of this model. Listeners do not hear of past divisions.
  void go_on_from(RunMemory memory, Observation measures);

  /// From now on, cells act by the law of this label (contraction.apical) as they are told, not by their programs:
  /// factors on what the scenario says, one a cell, >= 0 or GivenActivities::as_programmed; none: programs again. What
  /// had come to rest goes on. UsageError for another label, number of cells, or number, and for what is not symmetric
  /// where one side is solved.
  void set_activity(const std::string& label, std::vector<double> activities);

  void listen(SimulationListener& listener) { listeners_.push_back(&listener); }
  void stop_listening(SimulationListener& listener) { std::erase(listeners_, &listener); }

  /// `stop_requested` is asked often within a step; once true, the step is given up and the last good state stays.
  void stop_when(std::function<bool()> stop_requested);

 private:
  std::optional<StepReport> take_step(double until_s, State& before);
  void divide(const std::vector<PlannedDivision>& due);
  Division make_division(State& state, const std::vector<PlannedDivision>& planned);
  void begin_anew_at_a_jump();
  EnergyFlow account_for_energy(const State& before);
  void renew_stepper();
  void recall_factor();

  std::unique_ptr<Model> model_;  // what is solved, and `now_` of it
  std::optional<Whole> whole_;    // of which that is one side
  RunControls controls_;
  RunMemory now_;
  std::unique_ptr<Stepper> stepper_;
  StepLength step_length_;
  std::unique_ptr<Observer> observer_;
  Observation measures_;
  bool has_begun_ = false;  // since it was made, or went on: whoever was due then has divided
  std::string failure_;
  std::optional<int> failed_cell_;
  std::vector<SimulationListener*> listeners_;
  std::function<bool()> stop_requested_;
};

/// What a scenario's simulation is made of: for whoever adds something to it. Throws as Simulation does.
Simulation::Parts parts_of(const Scenario& scenario);

}  // namespace plica
