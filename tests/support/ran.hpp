// Simulations that have been run, for tests that look at every step.
#pragma once

#include "simulation/simulation.hpp"
#include "support/testing.hpp"

namespace plica::support {

/// Sees each accepted step, and the model as it is then.
using StepWatcher = std::function<void(const AcceptedStep&, const Model&)>;

/// The model, run from rest to its end.
inline Simulation ran(Model model, RunControls controls, const StepWatcher& watch = {}, MeasurePlan criteria = {}) {
  struct Listener final : SimulationListener {
    void step_accepted(const AcceptedStep& step, const Observation& /*measures*/) override { watch(step, run.model()); }
    Listener(const StepWatcher& watcher, const Simulation& of) : watch(watcher), run(of) {}
    const StepWatcher& watch;
    const Simulation& run;
  };
  Simulation simulation({std::make_unique<Model>(std::move(model)), std::move(controls), std::move(criteria)});
  Listener listener(watch, simulation);
  if (watch) simulation.listen(listener);
  simulation.run();
  simulation.stop_listening(listener);
  return simulation;
}

}  // namespace plica::support
