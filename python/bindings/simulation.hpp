// Simulation object of Python: with scenario, threads, results directory, and handling of Ctrl-C.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "scenario/load.hpp"
#include "show/recorded_run.hpp"
#include "signals.hpp"
#include "simulation/simulation.hpp"

namespace plica::python {

namespace nb = nanobind;

/// Checked scenario and its origin.
struct CheckedScenario {
  ScenarioSource source;
  Scenario scenario;
};

/// Simulation for use by one thread at a time: other Python threads run during a step, but calls from them are
/// rejected.
class SimulationOf {
 public:
  /// Make a simulation; `threads`: 0 for the default of the tissue; `energies`: as add_energies has them.
  SimulationOf(const CheckedScenario& scenario, int threads, const nb::list& energies);
  /// Restore the state at which save() was called.
  SimulationOf(const CheckedScenario& scenario, int threads, const nb::bytes& saved, const nb::list& energies);
  /// Return an independent copy, which does not record.
  [[nodiscard]] std::unique_ptr<SimulationOf> copy();

  /// Take a step; false if there is none. Raise the exception of a signal handler, with the state before the step, or
  /// GaveUp.
  bool step(double until_s);
  void set_activity(const std::string& law, std::vector<double> activities);
  void set_wall_factors(const std::string& law, const std::vector<double>& factors);
  void set_cell_array(const std::string& name, std::vector<double> values);
  void set_signal(const std::string& name, std::vector<double> values);
  [[nodiscard]] nb::bytes save();

  /// Begin recording; return notes on the checkpoint from which it continues.
  std::vector<std::string> begin_record(const std::string& out, const std::string& start);
  void end_record();
  [[nodiscard]] bool is_recording() const { return record_ != nullptr; }

  /// Call look(simulation), unless another thread is taking a step.
  template <class Look>
  auto with(const Look& look) {
    const Turn turn(*this);
    return look(std::as_const(*simulation_));
  }
  [[nodiscard]] const Scenario& scenario() const { return scenario_->scenario; }
  [[nodiscard]] int threads() const { return threads_; }

 private:
  class Turn {
   public:
    explicit Turn(SimulationOf& owner);
    ~Turn() { owner_.is_busy_ = false; }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    SimulationOf& owner_;
  };

  SimulationOf(const CheckedScenario& scenario, int threads, std::unique_ptr<Simulation> simulation,
               std::string at_rest);

  std::unique_ptr<CheckedScenario> scenario_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<RecordedRun> record_;
  int threads_;
  std::atomic<bool> is_busy_ = false;
  Signals signals_;
  std::string at_rest_;  // fingerprint of the tissue before the first step
};

void bind_simulation(nb::module_& module);
void bind_study(nb::module_& module);
void bind_tapes(nb::module_& module);

}  // namespace plica::python
