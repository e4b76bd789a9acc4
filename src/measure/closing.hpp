// Closure measures: lip contact, enclosed and perivitelline volume; onset of fast invagination, and speeds of the
// furrow ends and its centre over a run. Definitions: docs/reference/measures.md.
#pragma once

#include <optional>
#include <span>

#include "mechanics/model.hpp"

namespace plica {

/// Self-contact of the surfaces ([self_contact]).
struct ContactState {
  std::size_t pairs = 0;               // contact pairs under pressure
  std::optional<double> least_gap_um;  // between facing places
  double closed_length_ratio = 0;      // fraction of the length along x with contact across the midline
  bool middle_is_closed = false;       // at x = 0
};

/// Measure self-contact; empty without [self_contact].
std::optional<ContactState> contact_state(const Model& model, const State& state);

/// Enclosed fluid of a model, null without, and the multiplier of the constraint that holds it.
struct FluidOfModel {
  const EnclosedFluid* fluid = nullptr;
  std::optional<std::size_t> multiplier;
};

FluidOfModel enclosed_fluid(const Model& model);

struct Enclosed {
  double volume_ratio;  // relative to its target
  double pressure_kPa;
};

std::optional<Enclosed> enclosed(const Model& model, const State& state);

/// Perivitelline volume between a closed sheet and its shell, um^3; empty without a shell.
std::optional<double> fluid_under_shell_um3(const Model& model, std::span<const Vec3> positions);

/// Volume of the lateral ectoderm, um^3: cells at 60 to 120 degrees from the ventral midline on the middle half of the
/// length, weighted by their part of the angle. Empty for a tissue without an outer shape.
std::optional<double> flank_volume(const Tissue& tissue, std::span<const Vec3> positions);

/// Area of the tissue section at x = 0, at 60 to 120 degrees from the ventral midline, um^2. Empty for a tissue without
/// an outer shape.
std::optional<double> flank_section_area(const Tissue& tissue, std::span<const Vec3> positions);

/// Onset of fast invagination: breakpoint of a continuous two-segment fit to `depths_um` over `times_s` (least squares,
/// weighted by time), up to the first depth of 20 um.
struct Knee {
  double time_s, depth_um;
};

/// Fit the onset; empty if 20 um are not reached or by fewer than eight points.
std::optional<Knee> knee(std::span<const double> times_s, std::span<const double> depths_um);

/// First time at which values reach a level, interpolated linearly; empty if never.
std::optional<double> time_of_reaching(std::span<const double> times_s, std::span<const double> values, double level);

/// Speeds and displacements of VML and VCE in a step; empty if missing, as in the reference state.
struct FurrowSpeeds {
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

SpeedHistory speed_history(std::span<const FurrowSpeeds> rows);

}  // namespace plica
