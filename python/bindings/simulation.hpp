// A Simulation as Python holds it: with its scenario, its threads, the directory that it records to, and Ctrl-C.
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

/// A scenario that has been checked, and where it came from.
struct CheckedScenario {
  ScenarioSource source;
  Scenario scenario;
};

/// One thread at a time: while a step is solved, Python runs on, and others are refused.
class SimulationOf {
 public:
  /// `threads`: 0 for what suits the tissue.
  SimulationOf(const CheckedScenario& scenario, int threads);
  /// Where save() was called.
  SimulationOf(const CheckedScenario& scenario, int threads, const nb::bytes& saved);
  /// A fork in time; it records nowhere.
  [[nodiscard]] std::unique_ptr<SimulationOf> copy();

  /// False when there is no next step. Raises what a signal handler raised, the state being that before the step; and
  /// GaveUp.
  bool step(double until_s);
  void set_activity(const std::string& law, std::vector<double> activities);
  [[nodiscard]] nb::bytes save();

  /// Returns what is odd about the checkpoint that it goes on from.
  std::vector<std::string> begin_record(const std::string& out, const std::string& start);
  void end_record();
  [[nodiscard]] bool is_recording() const { return record_ != nullptr; }

  /// Calls look(simulation), unless another thread steps.
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
  std::string at_rest_;  // fingerprint of its tissue before the first step
};

void bind_simulation(nb::module_& module);
void bind_study(nb::module_& module);

}  // namespace plica::python
