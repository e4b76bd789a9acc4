#include "paper/measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.hpp"
#include "measure/speed_history.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

constexpr double vml_low_um = 7, vml_high_um = 10, vce_low_um = 13, vce_high_um = 17;  // section 4

void put(Figures& figures, const std::string& name, std::optional<double> value, double factor = 1) {
  if (value && std::isfinite(*value)) figures[name] = *value * factor;
}

std::optional<double> value_at(const Series& series, const std::string& column, double time_s) {
  const auto found = series.column(column);
  // Values of a run that reached equilibrium earlier remain constant.
  return found ? series.at(*found, std::min(time_s, *series.rows.back().front())) : std::nullopt;
}

std::optional<double> in_row(const Series& series, const std::vector<std::optional<double>>& row,
                             const std::string& column) {
  const auto found = series.column(column);
  return found ? row[*found] : std::nullopt;
}

// Rows for speed_history, with the given cell from the end as VCE.
std::vector<SpeedRow> speed_rows(const Series& series, int vce) {
  const std::string monitor = fmt::format("vce_{}", vce);
  std::vector<SpeedRow> rows;
  for (const auto& row : series.rows) {
    SpeedRow speeds;
    speeds.time_s = *row.front();
    speeds.vml_speed_um_per_s = in_row(series, row, "vml_speed_um_per_s");
    speeds.vml_displacement_um = in_row(series, row, "vml_displacement_um");
    if (vce == 2) {
      speeds.vce_speed_um_per_s = in_row(series, row, "vce_speed_um_per_s");
      speeds.vce_displacement_um = in_row(series, row, "vce_displacement_um");
    } else {
      const auto x = in_row(series, row, monitor + "_x.velocity_um_per_s");
      const auto z = in_row(series, row, monitor + "_z.velocity_um_per_s");
      if (!x || !z) return {};
      speeds.vce_speed_um_per_s = std::hypot(*x, *z);  // nothing along y on the midline
      speeds.vce_displacement_um = in_row(series, row, monitor + ".displacement_um");
    }
    if (!speeds.vml_speed_um_per_s || !speeds.vce_speed_um_per_s) continue;  // at rest
    rows.push_back(speeds);
  }
  return rows;
}

void add_speeds(Figures& figures, const Series& series, int vce, const std::string& ending) {
  const std::vector<SpeedRow> rows = speed_rows(series, vce);
  const SpeedHistory history = speed_history(rows);
  put(figures, "peak_ratio" + ending, history.peak_ratio);
  put(figures, "peak_ratio_time_s" + ending, history.peak_ratio_time_s);
  put(figures, "equal_speeds_s" + ending, history.ends_lead_until_s);
  put(figures, "vml_at_equal_um" + ending, history.vml_displacement_at_equal_speed_um);
  put(figures, "vce_at_equal_um" + ending, history.vce_displacement_at_equal_speed_um);
}

// First time at which a column reaches a value, linear between rows.
std::optional<double> time_of(const Series& series, const std::string& column, double value) {
  std::optional<double> before, before_s;
  for (const auto& row : series.rows) {
    const auto now = in_row(series, row, column);
    if (now && *now >= value) {
      if (!before || *now == *before) return row.front();
      return *before_s + (value - *before) / (*now - *before) * (*row.front() - *before_s);
    }
    before = now, before_s = row.front();
  }
  return std::nullopt;
}

// Restrict an interval in [0, 1] between two rows to the part in which a value moving from a to b is in range; empty if
// from > to.
void keep_in_range(std::pair<double, double>& part, double a, double b, double low, double high) {
  if (a == b) {
    if (a < low || a > high) part = {1, 0};
    return;
  }
  const auto [enters, leaves] = std::minmax({(low - a) / (b - a), (high - a) / (b - a)});
  part = {std::max(part.first, enters), std::min(part.second, leaves)};
}

void add_extreme_ratios(Figures& figures, const Series& series) {
  double fastest = 0;
  const std::vector<SpeedRow> rows = speed_rows(series, 2);
  for (const SpeedRow& row : rows) fastest = std::max(fastest, *row.vml_speed_um_per_s);
  std::optional<double> least, most;
  for (const SpeedRow& row : rows) {
    const std::optional<double> ratio = row.speed_ratio();
    if (*row.vml_speed_um_per_s < 0.01 * fastest || !ratio) continue;
    least = std::min(least.value_or(1e300), *ratio), most = std::max(most.value_or(0), *ratio);
  }
  put(figures, "least_ratio", least);
  put(figures, "largest_ratio", most);
}

}  // namespace

Figures printed_times(const Series& series) {
  constexpr double printed_um_per_s = 0.2;  // section 2.7
  Figures figures;
  for (std::size_t k = 1; k < series.rows.size(); ++k) {
    const auto &before = series.rows[k - 1], &now = series.rows[k];
    const double start_s = *before.front(), length_s = *now.front() - start_s;
    const auto ends = [&](const char* column) {
      return std::pair(in_row(series, before, column), in_row(series, now, column));
    };
    const auto [vml, vml_now] = ends("vml_displacement_um");
    const auto [vce, vce_now] = ends("vce_displacement_um");
    if (vml && vce && vml_now && vce_now) {
      std::pair<double, double> part(0, 1);
      keep_in_range(part, *vml, *vml_now, vml_low_um, vml_high_um);
      keep_in_range(part, *vce, *vce_now, vce_low_um, vce_high_um);
      if (part.first <= part.second) {
        figures.try_emplace("both_in_range_from_s", start_s + part.first * length_s);
        figures["both_in_range_until_s"] = start_s + part.second * length_s;
      }
    }
    const auto [speed, speed_now] = ends("max_node_speed_um_per_s");
    if (speed && speed_now && *speed >= printed_um_per_s && *speed_now < printed_um_per_s)
      figures.try_emplace("slower_than_printed_s",
                          start_s + (*speed - printed_um_per_s) / (*speed - *speed_now) * length_s);
  }
  if (const auto then = figures.find("slower_than_printed_s"); then != figures.end())
    put(figures, "depth_then_um", value_at(series, "furrow_depth_um", then->second));
  return figures;
}

void add_prefixed(Figures& figures, const std::string& prefix, const Figures& more) {
  for (const auto& [name, value] : more) figures[prefix + name] = value;
}

void watch_ends(Scenario& scenario, int along) {
  const auto strip = [&](int cells) {
    RegionInput region;
    region.face = "ventral";
    region.cells_along = cells;
    region.cells_across = 1;
    region.x_um = Range{0, 1e4};  // one of two mirror images, whose velocities along x would cancel
    return region;
  };
  for (const int vce : {1, 3}) {
    const std::string name = fmt::format("vce_{}", vce);
    const int outer = along - 2 * (vce - 1);
    if (outer - 2 < 1) continue;
    scenario.regions[name + "_outer"] = strip(outer);
    scenario.regions[name + "_inner"] = strip(outer - 2);
    RegionInput& cell = scenario.regions[name];
    cell.intersect = {name + "_outer"};
    cell.except = {name + "_inner"};
    for (const char* axis : {"x", "z"}) {
      MonitorInput& velocity = scenario.monitors[name + "_" + axis];
      velocity.quantity = "velocity";
      velocity.region = name;
      velocity.axis = axis;
    }
    MonitorInput& displacement = scenario.monitors[name];
    displacement.quantity = "displacement";
    displacement.region = name;
  }
}

Figures figures_of_run(const fs::path& run) {
  const Series series = read_series(run / "series.csv");
  const nlohmann::ordered_json summary = read_summary(run);
  const auto number = [&](const char* key) -> std::optional<double> {
    return summary.contains(key) && summary[key].is_number() ? std::optional(summary[key].get<double>()) : std::nullopt;
  };
  const std::optional<double> rest_s = number("equilibrium_time_s");
  const double end_s = rest_s.value_or(*series.rows.back().front());
  Figures figures;
  put(figures, "rest_min", rest_s, 1 / units::minute);
  put(figures, "depth_um", value_at(series, "furrow_depth_um", end_s));
  put(figures, "depth_below_lips_um", value_at(series, "furrow_depth_below_lips_um", end_s));
  put(figures, "lips_um", value_at(series, "lip_distance_um", end_s));
  for (const char* place : {"vml", "vce"}) {
    const std::string name = place;
    if (const auto ratio = value_at(series, name + "_apical_area_ratio", end_s))
      figures[name + "_area_loss_percent"] = 100 * (1 - *ratio);
    put(figures, name + "_at_15min_um", value_at(series, name + "_displacement_um", 15 * units::minute));
    put(figures, name + "_at_15s_um", value_at(series, name + "_displacement_um", 15));
  }
  const auto vml = value_at(series, "vml_speed_um_per_s", 15 * units::minute),
             vce = value_at(series, "vce_speed_um_per_s", 15 * units::minute);
  if (vml && vce && *vml > 0) figures["ratio_at_15min"] = *vce / *vml;
  add_speeds(figures, series, 2, "");
  for (const int vce_cell : {1, 2, 3}) add_speeds(figures, series, vce_cell, fmt::format("_{}", vce_cell));
  figures.merge(printed_times(series));
  add_extreme_ratios(figures, series);
  if (figures.contains("depth_um"))
    put(figures, "sets_off_s", time_of(series, "furrow_depth_um", figures["depth_um"] / 100));
  put(figures, "volume_error", number("max_volume_error"));
  put(figures, "penetration_um", number("max_shell_penetration_um"));
  put(figures, "nodes", number("nodes"));
  put(figures, "cells", number("cells"));
  return figures;
}

Onsets onsets(const fs::path& early, const fs::path& late, int along) {
  const Series first = read_table(early / "midline.csv"), last = read_table(late / "midline.csv");
  const std::size_t ap = first.column("ap_um").value(), depth = first.column("depth_um").value();
  const double end_s = *last.rows.back().front();
  std::map<double, double> final_depth_um;  // by place
  for (const auto& row : last.rows)
    if (*row.front() == end_s && row[ap] && row[depth]) final_depth_um[*row[ap]] = *row[depth];
  std::vector<double> places;
  places.reserve(final_depth_um.size());
  for (const auto& [place, value] : final_depth_um) places.push_back(place);
  std::ranges::stable_sort(places, {}, [](double place) { return std::abs(place); });
  places.resize(std::min(places.size(), static_cast<std::size_t>(along)));
  std::ranges::sort(places);

  Onsets found;
  for (const double place : places) {
    const double goal = final_depth_um[place] / 10;
    double before_s = 0, before_um = 0;
    for (const auto& row : first.rows) {
      if (*row[ap] != place || !row[depth]) continue;
      if (*row[depth] >= goal && *row[depth] > before_um) {
        found.ap_um.push_back(place);
        found.time_s.push_back(before_s + (goal - before_um) / (*row[depth] - before_um) * (*row.front() - before_s));
        break;
      }
      before_s = *row.front(), before_um = *row[depth];
    }
  }
  return found;
}

Figures figures_of_onsets(const Onsets& onsets) {
  Figures figures;
  const std::size_t count = onsets.time_s.size();
  if (count < 3) return figures;
  const auto [first, last] = std::ranges::minmax(onsets.time_s);
  figures["spread_s"] = last - first;
  figures["ends_s"] = (onsets.time_s.front() + onsets.time_s.back()) / 2;
  figures["middle_s"] = (onsets.time_s[(count - 1) / 2] + onsets.time_s[count / 2]) / 2;

  // Spearman: the correlation of ranks; mirror images share a rank.
  const auto ranks = [&](auto value) {
    std::vector<double> result(count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j) {
        const double difference = value(j) - value(i);
        result[i] += difference < -1e-3 ? 1 : (std::abs(difference) <= 1e-3 ? 0.5 : 0);
      }
    return result;
  };
  const auto distance = ranks([&](std::size_t i) { return std::abs(onsets.ap_um[i]); });
  const auto time = ranks([&](std::size_t i) { return onsets.time_s[i]; });
  const double mean = static_cast<double>(count) / 2;
  double both = 0, of_distance = 0, of_time = 0;
  for (std::size_t i = 0; i < count; ++i) {
    both += (distance[i] - mean) * (time[i] - mean);
    of_distance += (distance[i] - mean) * (distance[i] - mean);
    of_time += (time[i] - mean) * (time[i] - mean);
  }
  if (of_distance > 0 && of_time > 0) figures["rank_correlation"] = both / std::sqrt(of_distance * of_time);
  return figures;
}

}  // namespace plica
