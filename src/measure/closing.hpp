// A furrow that closes: where its lips touch, what is inside the sheet and under its shell, and when it turned. What
// every word means stands in docs/reference/measures.md.
#pragma once

#include <optional>
#include <span>

#include "mechanics/model.hpp"

namespace plica {

/// What surfaces that must not pass through themselves ([self_contact]) do to each other.
struct Touching {
  std::size_t pairs = 0;               // of places that press
  std::optional<double> least_gap_um;  // between places that look at each other
  double closed_length_ratio = 0;      // the part of the length along x on which two sides of the midline touch
  bool middle_is_closed = false;       // at x = 0
};

/// Empty without self-contact.
std::optional<Touching> touching(const Model& model, const State& state);

/// The volume inside the sheet, where [enclosed] says something of it.
struct Enclosed {
  double volume_ratio;  // over that which it is kept at
  double pressure_kPa;
};

std::optional<Enclosed> enclosed(const Model& model, const State& state);

/// What is left between a closed sheet and its shell, um^3; empty where there is no such shell.
std::optional<double> fluid_under_shell_um3(const Model& model, std::span<const Vec3> positions);

/// The volume of cells at 60 to 120 degrees from the belly, on the middle half of the length, um^3: a cell counts by
/// the part of its angle that lies there. Empty for a tissue without an outer shape.
std::optional<double> flank_volume(const Tissue& tissue, std::span<const Vec3> positions);

/// The area of the tissue at x = 0, between its basal and its apical surface, at 60 to 120 degrees from the belly,
/// um^2. Empty for a tissue without an outer shape.
std::optional<double> flank_section_area(const Tissue& tissue, std::span<const Vec3> positions);

/// Where slow turns into fast: the break of the line of two straight pieces that is nearest to `depths_um` over
/// `times_s` (least squares, each point by the time that it stands for), up to the first depth of 20 um.
struct Knee {
  double time_s, depth_um;
};

/// Empty where 20 um are never reached, or by fewer than eight points.
std::optional<Knee> knee(std::span<const double> times_s, std::span<const double> depths_um);

/// When values first reach a level, linear between them; empty where they never do.
std::optional<double> time_of_reaching(std::span<const double> times_s, std::span<const double> values, double level);

}  // namespace plica
