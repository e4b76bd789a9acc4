// Speeds of the furrow ends and its centre over a run.
#pragma once

#include <optional>
#include <span>

namespace plica {

/// Speeds and displacements of VML and VCE in a step; empty if missing, as in the reference state.
struct SpeedRow {
  double time_s = 0;  // at its end
  std::optional<double> vml_speed_um_per_s, vce_speed_um_per_s;
  std::optional<double> vml_displacement_um, vce_displacement_um;

  /// v_c/v_m; empty while the centre does not move.
  [[nodiscard]] std::optional<double> speed_ratio() const;
};

struct SpeedHistory {
  std::optional<double> peak_ratio;  // v_c/v_m when v_c - v_m is largest, among steps with v_m over 1 % of its peak
  std::optional<double> peak_ratio_time_s;
  std::optional<double> ends_lead_until_s;  // first time after that with v_c <= v_m, interpolated
  std::optional<double> vml_displacement_at_equal_speed_um, vce_displacement_at_equal_speed_um;
};

SpeedHistory speed_history(std::span<const SpeedRow> rows);

}  // namespace plica
