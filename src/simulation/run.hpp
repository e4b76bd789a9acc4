// THE LOOP: from a state to equilibrium or the end of time, a step after another.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/model.hpp"
#include "simulation/division_rules.hpp"
#include "solver/make_stepper.hpp"

namespace plica {

/// When to step how far, and when to stop.
struct RunControls {
  StepScheme scheme;
  std::optional<double> fixed_step_s;   // empty: adaptive
  double first_step_s = 0.05;           // adaptive
  double max_step_s = 30;               // adaptive
  double position_tolerance_um = 0.05;  // adaptive: largest error of a step at any node
  double end_s = 3600;
  double equilibrium_speed_um_per_s = 0.2 / 60;
  bool stop_at_equilibrium = true;
  double frame_every_s = 15;             // adaptive steps end on frames; 0: no frames in between
  std::vector<double> program_points_s;  // adaptive steps end on them, too; equilibrium counts only after the last
  std::vector<DivisionRule> divisions;   // their times are among the program points
};

/// A division that has been made, and what the model's part in it depended on.
struct PastDivision {
  double time_s = 0;
  Vectors positions;  // nodes, before it; um
  std::vector<PlannedDivision> planned;
};

/// Where the loop is, between two steps: with the model of the scenario, in which the past divisions have been made
/// again (`repeat`), enough to go on to the same bits.
struct RunMemory {
  State state;
  int steps = 0;
  int divisions = 0;                         // cells that divided
  std::optional<double> equilibrium_time_s;  // first time that every node was slower than the limit
  bool at_equilibrium = false;               // now
  bool criterion_met = false;                // the observer says that the run is over
  double wanted_step_s = 0;                  // length of the next step; 0: no step yet
  FactorMemory factor;
  std::vector<std::shared_ptr<const PastDivision>> past_divisions;
};

/// Whether nothing is left to do.
bool has_ended(const RunMemory& run, const RunControls& controls);

/// Makes a division of the past once more.
Division repeat(Model& model, const PastDivision& past);

/// What the loop tells about an accepted step.
struct AcceptedStep {
  const State& state;     // at its end
  const State& previous;  // at its beginning
  double duration_s;
  const StepReport& report;  // of the accepted attempt, iterations of rejected ones added
  double max_node_speed_um_per_s;
  bool frame_is_due;
  bool at_equilibrium = false;
  std::function<RunMemory()> memory = {};  // from which to go on after this step
};

/// What the observer answers. From a bool: true goes on, false interrupts the run.
struct StepAnswer {
  bool go_on = true;
  bool criterion_met = false;  // the run is over, as planned

  StepAnswer(bool goes_on, bool met = false) : go_on(goes_on), criterion_met(met) {}  // NOLINT: meant to convert
};

enum class RunStatus { equilibrium, end_time, failed, interrupted };

struct RunResult {
  RunStatus status = RunStatus::end_time;
  State state;  // where it ended; the last good one after a failure
  int steps = 0;
  int divisions = 0;                         // cells that divided
  bool criterion_met = false;                // the observer said so; status is then equilibrium or end_time
  std::optional<double> equilibrium_time_s;  // first time that every node was slower than the limit
  std::string failure;                       // what gave up, where and when
};

/// Called after every accepted step.
using StepObserver = std::function<StepAnswer(const AcceptedStep&)>;

/// Called after cells have divided, with the state from which the run goes on.
using DivisionObserver = std::function<void(const Division&, const State&)>;

/// From `start` on, whose past divisions the model has behind it. Divisions change the model: every reference to it
/// sees the new one. `stop_requested` is asked often, also within a step; once true, the run ends as interrupted with
/// the last good state.
RunResult run(Model& model, RunMemory start, RunControls controls, const StepObserver& observer,
              const std::function<bool()>& stop_requested = {}, const DivisionObserver& division_observer = {});

/// From the beginning.
inline RunResult run(Model& model, State rest, RunControls controls, const StepObserver& observer,
                     const std::function<bool()>& stop_requested = {}, const DivisionObserver& division_observer = {}) {
  RunMemory start;
  start.state = std::move(rest);
  return run(model, std::move(start), std::move(controls), observer, stop_requested, division_observer);
}

}  // namespace plica
