#include "measure/speed_history.hpp"

#include <algorithm>

namespace plica {

std::optional<double> SpeedRow::speed_ratio() const {
  constexpr double rounding = 1e-12;  // relative to the speed of the ends: a slower centre counts as still
  if (!vml_speed_um_per_s || !vce_speed_um_per_s || !(*vml_speed_um_per_s > rounding * *vce_speed_um_per_s))
    return std::nullopt;
  return *vce_speed_um_per_s / *vml_speed_um_per_s;
}

SpeedHistory speed_history(std::span<const SpeedRow> rows) {
  SpeedHistory history;
  double fastest_middle = 0;
  for (const SpeedRow& row : rows) fastest_middle = std::max(fastest_middle, row.vml_speed_um_per_s.value_or(0));
  const auto lead = [](const SpeedRow& row) { return *row.vce_speed_um_per_s - *row.vml_speed_um_per_s; };
  std::optional<std::size_t> peak;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].vml_speed_um_per_s || *rows[i].vml_speed_um_per_s <= 0.01 * fastest_middle) continue;
    if (!peak || lead(rows[i]) > lead(rows[*peak])) peak = i;
  }
  if (!peak) return history;
  history.peak_ratio = rows[*peak].speed_ratio();
  history.peak_ratio_time_s = rows[*peak].time_s;
  if (lead(rows[*peak]) <= 0) return history;  // the ends never lead
  for (std::size_t i = *peak + 1; i < rows.size(); ++i) {
    const double before = lead(rows[i - 1]), after = lead(rows[i]);
    if (after > 0) continue;
    const double part = before > 0 ? before / (before - after) : 0;
    const auto between = [&](double a, double b) { return a + part * (b - a); };
    history.ends_lead_until_s = between(rows[i - 1].time_s, rows[i].time_s);
    history.vml_displacement_at_equal_speed_um =
        between(*rows[i - 1].vml_displacement_um, *rows[i].vml_displacement_um);
    history.vce_displacement_at_equal_speed_um =
        between(*rows[i - 1].vce_displacement_um, *rows[i].vce_displacement_um);
    break;
  }
  return history;
}

}  // namespace plica
