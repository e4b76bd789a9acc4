// One row of series.csv: an accepted step as it is measured.
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

/// A step that stands, as it is measured.
struct AcceptedStep {
  const State& state;     // at its end
  const State& previous;  // at its beginning
  double duration_s;
  const StepReport& report;  // of the accepted attempt, iterations of rejected ones added
  double max_node_speed_um_per_s;
  bool frame_is_due;
  bool at_equilibrium = false;
  EnergyFlow energy = {};  // of all steps so far, this one included
};

/// The measures of one accepted step. Empty: has no value.
struct Observation {
  std::vector<std::optional<double>> values = std::vector<std::optional<double>>(columns().size());  // by column
  std::vector<std::optional<double>> monitors;  // in the order of the scenario's
  std::vector<std::string> criteria_met;        // of [stop]
  bool is_over = false;                         // the criteria say so

  /// By the column's name, as in row["furrow_depth_um"]. std::logic_error when there is none.
  [[nodiscard]] std::optional<double> operator[](std::string_view column) const { return values[column_index(column)]; }
  [[nodiscard]] double time_s() const { return (*this)["time_s"].value_or(0); }
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

  /// From now on these have no value, and cost nothing.
  void leave_out(const std::function<bool(const Column&)>& which);

  /// The model's cells have divided.
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
