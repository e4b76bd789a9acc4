// Who leads, the ends of the furrow or its middle, over a whole run.
#pragma once

#include <optional>
#include <span>

namespace plica {

/// What VML and VCE do in a step. Empty: has no value, as at rest.
struct SpeedRow {
  double time_s = 0;  // at its end
  std::optional<double> vml_speed_um_per_s, vce_speed_um_per_s;
  std::optional<double> vml_displacement_um, vce_displacement_um;

  /// v_c/v_m; none while the middle stands still.
  [[nodiscard]] std::optional<double> speed_ratio() const;
};

struct SpeedHistory {
  std::optional<double> peak_ratio;  // v_c/v_m when v_c - v_m is largest, among steps with v_m over 1 % of its peak
  std::optional<double> peak_ratio_time_s;
  std::optional<double> ends_lead_until_s;  // first time after that when v_c <= v_m; linear between steps
  std::optional<double> vml_displacement_at_equal_speed_um, vce_displacement_at_equal_speed_um;
};

SpeedHistory speed_history(std::span<const SpeedRow> rows);

}  // namespace plica
