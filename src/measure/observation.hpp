// One row of series.csv, and what the rows of a run add up to.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/furrow.hpp"
#include "measure/stop_rule.hpp"
#include "solver/step/stepper.hpp"

namespace plica {

/// A step that stands, as it is measured.
struct AcceptedStep {
  const State& state;     // at its end
  const State& previous;  // at its beginning
  double duration_s;
  const StepReport& report;  // of the accepted attempt, iterations of rejected ones added
  double max_node_speed_um_per_s;
  bool frame_is_due;
  bool at_equilibrium = false;
};

/// The measures of one accepted step. Empty: has no value.
struct Observation {
  double time_s = 0;
  FurrowShape furrow;
  std::optional<double> vml_speed_um_per_s, vce_speed_um_per_s, speed_ratio;
  std::optional<double> vml_displacement_um, vce_displacement_um;
  std::optional<double> vml_apical_area_ratio, vce_apical_area_ratio;
  double max_node_speed_um_per_s = 0;
  double max_volume_error = 0;  // over cells
  std::optional<double> lumen_volume_ratio;
  double max_shell_penetration_um = 0;
  double min_scaled_jacobian = 1;
  double step_s = 0;
  int newton_iterations = 0;
  int linear_solves = 0;
  int projection_sweeps = 0, cubics = 0, cubics_with_three_roots = 0;
  std::vector<std::optional<double>> monitors;  // in the order of the scenario's
  std::vector<std::string> criteria_met;        // of [stop]
  bool is_over = false;                         // the criteria say so
};

/// What a scenario asks to be watched beside the furrow.
struct Watch {
  std::vector<Monitor> monitors;
  StopRule stop;
};

/// Measures steps of one model.
class Observer {
 public:
  Observer(const Model& model, FurrowSites sites, Watch watch = {});
  /// Measures the same of a copy of the other's model.
  Observer(const Model& model, const Observer& other);
  /// `wall_s`: computing time of all steps so far, for the monitor of that name.
  [[nodiscard]] Observation observe(const AcceptedStep& step, double wall_s = 0) const;
  /// The same of the body at rest, before the first step.
  [[nodiscard]] Observation observe_rest(const State& state) const;
  [[nodiscard]] const FurrowSites& sites() const { return sites_; }
  [[nodiscard]] const std::vector<Monitor>& monitors() const { return watch_.monitors; }

  /// The model's cells have divided.
  void follow_division(const Division& division) { plica::follow_division(sites_, model_.tissue, division); }

 private:
  void observe_state(const State& state, Observation& row) const;
  void observe_monitors(const State& state, double wall_s, bool at_equilibrium, Observation& row) const;

  const Model& model_;
  FurrowSites sites_;
  Watch watch_;
  std::optional<double> rest_lumen_volume_;
};

/// Who leads, the ends or the middle, over a whole run.
struct SpeedHistory {
  std::optional<double> peak_ratio;  // v_c/v_m when v_c - v_m is largest, among steps with v_m over 1 % of its peak
  std::optional<double> peak_ratio_time_s;
  std::optional<double> ends_lead_until_s;  // first time after that when v_c <= v_m; linear between steps
  std::optional<double> vml_displacement_at_equal_speed_um, vce_displacement_at_equal_speed_um;
};

SpeedHistory speed_history(const std::vector<Observation>& rows);

}  // namespace plica
