#include "record/time_left.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <sstream>

#include "core/clock.hpp"
#include "core/words.hpp"
#include "record/results.hpp"
#include "scenario/builtin.hpp"

namespace plica {
namespace {

// Longest step of a run that is nearly at rest.
double longest_step_s(const RunControls& controls) {
  if (controls.fixed_step_s) return *controls.fixed_step_s;
  return controls.frame_every_s > 0 ? std::min(controls.max_step_s, controls.frame_every_s) : controls.max_step_s;
}

// End of a run as the curve knows it: at its equilibrium, if that is sooner.
double end_s(const RunControls& controls, const WorkCurve& curve) {
  return controls.stop_at_equilibrium ? std::min(curve.times_s.back(), controls.end_s) : controls.end_s;
}

}  // namespace

double work_of_step(std::optional<double> newton_iterations, std::optional<double> linear_iterations) {
  return 1 + newton_iterations.value_or(0) + linear_iterations.value_or(0) / 10;
}

double WorkCurve::at(double time_s) const {
  const double last_s = times_s.back(), before_s = 0.95 * last_s;
  if (time_s > last_s) return work.back() + (work.back() - at(before_s)) * (time_s - last_s) / (last_s - before_s);
  const auto i = static_cast<std::size_t>(std::ranges::lower_bound(times_s, time_s) - times_s.begin());
  return i == 0 ? 0 : std::lerp(work[i - 1], work[i], (time_s - times_s[i - 1]) / (times_s[i] - times_s[i - 1]));
}

std::optional<WorkCurve> curve_in(std::string_view table, const std::string& name) {
  std::istringstream lines{std::string(table)};
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(name + ",")) continue;
    std::ranges::replace(line, ',', ' ');
    std::istringstream row(line.substr(name.size()));
    double total = 0, time_s = 0;
    row >> total;
    WorkCurve curve{{0}, {0}};
    while (row >> time_s) curve.times_s.push_back(time_s);
    const std::size_t parts = curve.times_s.size() - 1;
    for (std::size_t i = 1; i <= parts; ++i)
      curve.work.push_back(total * static_cast<double>(i) / static_cast<double>(parts));
    return curve;
  }
  return {};
}

std::optional<WorkCurve> builtin_curve(const Scenario& scenario) {
  for (const BuiltinFile& file : builtin_experiment_files())
    if (file.path == "work.csv") return curve_in(file.text, scenario.builtin);
  return {};
}

std::optional<WorkCurve> curve_of_run(const std::filesystem::path& directory, const Scenario& scenario) try {
  const nlohmann::ordered_json summary = read_summary(directory);
  const std::string status = summary.at("status");
  if (summary.at("scenario") != scenario.name || (status != "equilibrium" && status != "end_time")) return {};
  const Series series = read_series(directory / "series.csv");
  const std::size_t newton = series.column("newton_iterations").value();
  const std::size_t linear = series.column("linear_iterations").value();
  if (series.rows.size() < 2) return {};
  WorkCurve curve{{0}, {0}};
  for (std::size_t i = 1; i < series.rows.size(); ++i) {
    curve.times_s.push_back(*series.rows[i].front());
    curve.work.push_back(curve.work.back() + work_of_step(series.rows[i][newton], series.rows[i][linear]));
  }
  return curve;
} catch (const std::exception&) {
  return {};  // there is none, or it is damaged
}

std::pair<double, double> expected_work(const RunControls& controls, const std::optional<WorkCurve>& curve) {
  if (curve) {
    const double work = curve->at(end_s(controls, *curve));
    return {work, work};
  }
  // Steps that lengthen by 15 % each until the longest, and quantiles of the work for each in 136 recorded scenarios.
  constexpr double growth = 0.15, least_at_rest = 1.3, least = 4, most = 14;
  const double longest_s = longest_step_s(controls), grown_s = std::min(longest_s / growth, controls.end_s);
  double steps = controls.end_s / longest_s;
  if (!controls.fixed_step_s)
    steps = std::log(std::max(1.0, growth * grown_s / controls.first_step_s)) / std::log1p(growth) +
            (controls.end_s - grown_s) / longest_s;
  return {(controls.stop_at_equilibrium ? least_at_rest : least) * steps, most * steps};
}

std::optional<double> TimeLeft::seconds() const {
  if (!curve_) return by_trend();
  const Sample& now = samples_.back();
  const double by_curve_s = end_s(controls_, *curve_), all = curve_->at(by_curve_s);
  const double done = curve_->at(now.time_s), since = done - curve_->at(samples_.front().time_s);
  // A run with other values may outlast the curve.
  if (done > 0.995 * all) return by_trend();
  if (since < 0.02 * all) return {};
  const double left_s = now.elapsed_s * (all - done) / since;
  // Towards equilibrium, its own decay counts more and more.
  const std::optional<double> decay_s = by_curve_s < controls_.end_s ? to_equilibrium() : std::nullopt;
  return decay_s ? std::pow(left_s, 1 - done / all) * std::pow(*decay_s, done / all) : left_s;
}

std::string TimeLeft::text() const {
  const std::optional<double> left_s = seconds();
  return left_s ? about(*left_s) + " left" : "";
}

// Sample from which this part of the elapsed time has passed, before the last one.
std::size_t TimeLeft::start_of_last(double part) const {
  const double from_s = (1 - part) * samples_.back().elapsed_s;
  const auto from = std::ranges::lower_bound(samples_, from_s, {}, &Sample::elapsed_s);
  return static_cast<std::size_t>(std::min(from, samples_.end() - 2) - samples_.begin());
}

// To the end time, as steps lengthen in proportion to time until the longest, or to equilibrium.
std::optional<double> TimeLeft::by_trend() const {
  constexpr std::size_t least_samples = 6;
  if (samples_.size() < least_samples) return {};
  const std::size_t i = start_of_last(0.3);
  const Sample &from = samples_[i], &now = samples_.back();
  const auto steps = static_cast<double>(samples_.size() - 1 - i);
  const double step_s = (now.time_s - from.time_s) / steps;
  const double longest_s = controls_.fixed_step_s ? step_s : std::max(longest_step_s(controls_), step_s);
  const double next_s = std::min(longest_s, step_s * 2 * now.time_s / (now.time_s + from.time_s));
  const double grown_s = std::min(controls_.end_s, now.time_s * longest_s / next_s);
  const double steps_left =
      now.time_s / next_s * std::log(grown_s / now.time_s) + (controls_.end_s - grown_s) / longest_s;
  const double left_s = steps_left * (now.elapsed_s - from.elapsed_s) / steps;
  return std::min(left_s, to_equilibrium().value_or(left_s));
}

// After the last change of activity, speeds decay exponentially with work.
std::optional<double> TimeLeft::to_equilibrium() const {
  const Sample& now = samples_.back();
  const double goal = controls_.equilibrium_speed_um_per_s;
  if (!controls_.stop_at_equilibrium || goal <= 0) return {};
  std::size_t i = std::max<std::size_t>(1, start_of_last(0.5));  // the first has no speed
  const auto is_ahead = [&](double point_s) { return !has_come(point_s, samples_[i].time_s); };
  while (i + 1 < samples_.size() && std::ranges::any_of(controls_.program_points_s, is_ahead)) ++i;
  const double decay = std::log(samples_[i].fastest_um_per_s / now.fastest_um_per_s);
  if (!(decay > 0)) return {};
  return std::log(std::max(1.0, now.fastest_um_per_s / goal)) * (now.elapsed_s - samples_[i].elapsed_s) / decay;
}

}  // namespace plica
