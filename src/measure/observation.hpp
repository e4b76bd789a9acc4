// Measurement of accepted steps: rows of series.csv.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "measure/columns.hpp"
#include "measure/furrow.hpp"
#include "measure/stop_rule.hpp"
#include "solver/step/stepper.hpp"

namespace plica {

/// Accepted step, input of its measurement.
struct AcceptedStep {
  const State& state;     // at its end
  const State& previous;  // at its start
  double duration_s;
  const StepReport& report;  // of the accepted attempt, with iterations of rejected ones
  double max_node_speed_um_per_s;
  bool frame_is_due;
  bool at_equilibrium = false;
  EnergyFlow energy = {};  // summed over all steps including this one
};

/// Output variables of one accepted step; missing values are empty.
struct Observation {
  std::vector<std::optional<double>> values = std::vector<std::optional<double>>(columns().size());  // by column
  std::vector<std::optional<double>> monitors;  // in the order of the scenario
  std::vector<std::string> criteria_met;        // of [stop]
  bool is_over = false;                         // the criteria end the run

  /// Value by column name, as in row["furrow_depth_um"]. Throws std::logic_error for an unknown name.
  [[nodiscard]] std::optional<double> operator[](std::string_view column) const { return values[column_index(column)]; }
  [[nodiscard]] double time_s() const { return (*this)["time_s"].value_or(0); }
};

/// Monitors and stop criteria of a scenario.
struct Watch {
  std::vector<Monitor> monitors;
  StopRule stop;
};

/// Measures the steps of one model.
class Observer {
 public:
  Observer(const Model& model, FurrowSites sites, Watch watch = {});
  /// Copy that measures a copy of the other's model.
  Observer(const Model& model, const Observer& other);
  /// Measure a step. `wall_s`: computing time of all steps so far, for the monitor of that name.
  [[nodiscard]] Observation observe(const AcceptedStep& step, double wall_s = 0) const;
  /// Measure the reference state, before the first step.
  [[nodiscard]] Observation observe_rest(const State& state) const;
  [[nodiscard]] const FurrowSites& sites() const { return sites_; }
  [[nodiscard]] const std::vector<Monitor>& monitors() const { return watch_.monitors; }

  /// Skip these columns from now on; they have no value then.
  void leave_out(const std::function<bool(const Column&)>& which);

  /// Update after divisions of the model.
  void follow_division(const Division& division) { plica::follow_division(sites_, model_.tissue, division); }

 private:
  [[nodiscard]] Observation row_of(const State& state, const AcceptedStep* step, double wall_s) const;

  const Model& model_;
  FurrowSites sites_;
  Watch watch_;
  RestMeasures rest_;
  std::vector<char> is_left_out_ = std::vector<char>(columns().size(), 0);  // by column
};

}  // namespace plica
