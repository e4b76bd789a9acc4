// Measurement of accepted steps: rows of series.csv.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "measure/columns.hpp"
#include "measure/stop_rule.hpp"
#include "solver/step/stepper.hpp"
#include "tissue/tissue_change.hpp"

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
  [[nodiscard]] std::optional<double> operator[](const Column& column) const {
    return values[static_cast<std::size_t>(&column - columns().data())];
  }
  std::optional<double>& operator[](const Column& column) {
    return values[static_cast<std::size_t>(&column - columns().data())];
  }
  [[nodiscard]] double time_s() const { return (*this)["time_s"].value_or(0); }
};

/// Sets, monitors and stop criteria of a scenario.
struct MeasurePlan {
  KeptBySet sets;
  std::vector<Monitor> monitors;
  StopRule stop;
};

/// Measures the steps of a run. `model`: the model at the time measured.
class Observer {
 public:
  explicit Observer(const Model& model, MeasurePlan measure_plan = {});
  /// Measure the end of a step; null: the reference state, before the first.
  [[nodiscard]] Observation observe(const Moment& moment, const AcceptedStep* step) const;
  [[nodiscard]] const std::vector<Monitor>& monitors() const { return plan_.monitors; }
  [[nodiscard]] const ColumnList& columns() const { return columns_; }
  /// What a set keeps over the run; null if it is not measured.
  template <class Kept>
  [[nodiscard]] const Kept* kept(std::string_view set) const {
    const auto found = plan_.sets.find(set);
    return found == plan_.sets.end() ? nullptr : std::any_cast<Kept>(&found->second);
  }

  /// Skip these columns from now on.
  void leave_out(const std::function<bool(const Column&)>& which) {
    std::erase_if(columns_, [&](const Column* column) { return which(*column); });
  }

  void follow_division(const Tissue& tissue, const TissueChange& change);
  [[nodiscard]] const MeasurePlan& plan() const { return plan_; }

 private:
  MeasurePlan plan_;
  ColumnList columns_;
};

}  // namespace plica
