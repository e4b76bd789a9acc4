// Step control of a run: step lengths, times on which steps end, and end criteria; the length of the next step, limited
// by its local error of positions; and the pace, which ends runs that would take thousands of short, hard steps to fold
// a crushed tissue.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/model.hpp"
#include "scenario/scenario.hpp"
#include "simulation/division_rules.hpp"
#include "simulation/exchange_rules.hpp"
#include "solver/make_stepper.hpp"

namespace plica {

struct RunControls {
  StepScheme scheme;
  std::optional<double> fixed_step_s;   // empty: adaptive
  double first_step_s = 0.05;           // adaptive
  double max_step_s = 30;               // adaptive
  double position_tolerance_um = 0.05;  // adaptive: largest local error at any node
  double end_s = 3600;
  double equilibrium_speed_um_per_s = 0.2 / 60;
  bool stop_at_equilibrium = true;
  double frame_every_s = 15;             // adaptive steps end on snapshots; 0: none in between
  std::vector<double> program_points_s;  // adaptive steps end on them; equilibrium counts only after the last
  std::vector<double> program_jumps_s;   // jumps of forces: fixed steps end on them, too
  std::vector<DivisionRule> divisions;   // their times are program points
  std::optional<ExchangeRule> exchange;
  std::vector<ExtrusionRule> extrusions;
};

/// Controls of a scenario. The simulation adds the points of the activity time courses of its laws.
RunControls make_controls(const Scenario& scenario);

class StepLength {
 public:
  /// Continue with steps of about `wanted_s`, the next `careful_steps` of which lengthen little; 0: start.
  explicit StepLength(const RunControls& controls, double wanted_s = 0, int careful_steps = 0);

  /// End time of a step from `time_s`: `until_s` at most, and exactly on the times that steps must end on.
  [[nodiscard]] double propose_end_s(const RunControls& controls, double time_s,
                                     double until_s = std::numeric_limits<double>::infinity()) const;

  /// Whether to accept the step from `before` to `after`; false if its error (step_error) requires a shorter one.
  [[nodiscard]] bool accept(const RunControls& controls, const State& before, const State& after);

  /// Shorten after an unsolved step; each of the next four lengthens by at most 1.15. Returns false if the next would
  /// be too short.
  [[nodiscard]] bool halve(const RunControls& controls, double failed_s);

  [[nodiscard]] double wanted_s() const { return wanted_s_; }
  /// Return the number of next steps that lengthen only little.
  [[nodiscard]] int careful_steps() const { return careful_steps_; }

 private:
  double wanted_s_;
  int careful_steps_;
};

/// Steps since a time, and their Newton iterations, those of rejected attempts included.
struct Pace {
  double since_s = 0;
  int steps = 0;
  int iterations = 0;

  /// Whether enough work is counted to judge the pace.
  [[nodiscard]] bool is_known() const { return iterations >= 300; }
};

/// Cell that the forces crush, and the reason why the run ends there.
struct Standstill {
  CellId cell;
  std::string reason;
};

/// Returns a reason if a known pace is hopeless: it needs at least 5 iterations per step and 10 000 to the end (with a
/// fixed step, takes steps half as long), and a corner is below a hundredth of its reference Jacobian, kept from
/// inversion by the barrier alone. Built-in scenarios stay above 0.04.
std::optional<Standstill> standstill(const Pace& pace, const RunControls& controls, const Model& model,
                                     const State& state);

}  // namespace plica
