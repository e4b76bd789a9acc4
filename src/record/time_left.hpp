// Remaining wall time of a run: by the work that an earlier run of the scenario, or the built-in scenario it is based
// on, took over simulated time; else by the trend of its own steps. docs/decisions/0015-speed.md has
// measured errors.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/scenario.hpp"
#include "simulation/controls.hpp"

namespace plica {

/// Work of a step, the same on any machine: in Newton iterations, to which ten linear ones or the fixed costs of a
/// step are about equal. tools/work_curves.py counts alike.
double work_of_step(std::optional<double> newton_iterations, std::optional<double> linear_iterations);

/// Work of a finished run up to a simulated time; both increase from 0.
struct WorkCurve {
  std::vector<double> times_s, work;

  /// Interpolated; beyond the end as fast as over its last twentieth.
  [[nodiscard]] double at(double time_s) const;
};

/// Curve of a name in scenarios/work.csv (`table`); empty if it has none.
std::optional<WorkCurve> curve_in(std::string_view table, const std::string& name);
/// Curve of the built-in scenario that this is, or is based on.
std::optional<WorkCurve> builtin_curve(const Scenario& scenario);
/// Curve of a finished run of a scenario of this name in a directory; empty if there is none.
std::optional<WorkCurve> curve_of_run(const std::filesystem::path& directory, const Scenario& scenario);

/// Least and most work of a run that has not begun. They are equal by a curve; else about half of all runs lie between.
std::pair<double, double> expected_work(const RunControls& controls, const std::optional<WorkCurve>& curve);

/// Remaining wall time of a run under way.
class TimeLeft {
 public:
  /// `from_s`: simulated time at which this process begins or resumes the run.
  TimeLeft(RunControls controls, std::optional<WorkCurve> curve, double from_s = 0)
      : controls_(std::move(controls)), curve_(std::move(curve)), samples_{{0, from_s, 0}} {}

  /// Add an accepted step and the wall time since the beginning.
  void add(double elapsed_s, double time_s, double fastest_um_per_s) {
    samples_.push_back({elapsed_s, time_s, fastest_um_per_s});
  }
  /// Wall time, s; empty if it is too early to tell.
  [[nodiscard]] std::optional<double> seconds() const;
  /// In words: "about 2 min left"; empty likewise.
  [[nodiscard]] std::string text() const;

 private:
  struct Sample {
    double elapsed_s, time_s, fastest_um_per_s;
  };
  [[nodiscard]] std::size_t start_of_last(double part) const;
  [[nodiscard]] std::optional<double> to_equilibrium() const;
  [[nodiscard]] std::optional<double> by_trend() const;

  RunControls controls_;
  std::optional<WorkCurve> curve_;
  std::vector<Sample> samples_;
};

}  // namespace plica
