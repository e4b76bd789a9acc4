// Rows of the inner tables for the activation of each cell: profile, variation, delay, pulse.
#pragma once

#include "scenario/rows_in.hpp"

namespace plica {

/// Adds the keys of amplitude factors: profile and variation.
template <class Table>
void add_strengths(std::vector<Row>& rows, const RowsIn<Table>& table) {
  const auto profile = [&](std::string_view key, auto field, const Allowed& allowed, std::string_view meaning,
                           const RowOptions& options = {}) {
    rows.push_back(table(key, &Table::profile, field, allowed, meaning, options));
  };
  profile("profile.shape", &ProfileInput::shape, one_of(words::profile_shapes),
          "`constant`; `linear`: `edge` from `half_width_um` on; `gaussian`: exp(−d²/2σ²); `plateau`: `middle` on "
          "`full_cells`, then a cosine taper over `fade_cells` on either side; `table`: given points; `array`: by a "
          "cell array.");
  profile(
      "profile.axis", &ProfileInput::axis, one_of(words::profile_axes),
      "Axis of d: across (arc about the embryo axis; y in an open tissue), along (x), or the angle from ventral (°); "
      "default across.");
  profile("profile.about", &ProfileInput::about, anything,
          "Region that sets the centre and the cell size; default the table's own region.");
  profile("profile.centre_deg", &ProfileInput::centre_deg, between(-180, 180),
          "Angle of the centre; 0: ventral (default), 90: right.");
  profile("profile.middle", &ProfileInput::middle, not_negative, "Factor at the centre; default 1.");
  profile("profile.edge", &ProfileInput::edge, not_negative, "Factor far away; default 0.");
  profile("profile.half_width_um", &ProfileInput::half_width_um, positive,
          "`linear`: distance at which the factor reaches `edge` (µm).");
  profile("profile.half_width_deg", &ProfileInput::half_width_deg, positive, "Likewise in degrees.");
  profile("profile.sigma_um", &ProfileInput::sigma_um, positive, "`gaussian`: standard deviation σ (µm).");
  profile("profile.sigma_cells", &ProfileInput::sigma_cells, positive,
          "σ in cells: mean cell width of the region along the axis of d.", {.instead_of = "profile.sigma_um"});
  profile("profile.sigma_deg", &ProfileInput::sigma_deg, positive, "σ in degrees.");
  profile("profile.full_cells", &ProfileInput::full_cells, positive,
          "`plateau`: full width with factor `middle` (cells).");
  profile("profile.fade_cells", &ProfileInput::fade_cells, not_negative,
          "`plateau`: width of the taper on either side (cells); 0: none.");
  profile("profile.full_deg", &ProfileInput::full_deg, positive, "`plateau`: full width (degrees).");
  profile("profile.fade_deg", &ProfileInput::fade_deg, not_negative,
          "`plateau`: width of the taper (degrees); 0: none.");
  profile("profile.at_um", &ProfileInput::at_um, anything,
          "`table`: positions from the centre (µm), increasing; the factor is constant beyond the ends. Without "
          "negative values: distances on both sides. Otherwise positive is right or posterior.");
  profile("profile.at_cells", &ProfileInput::at_cells, anything, "The positions in cells, as for `sigma_cells`.",
          {.instead_of = "profile.at_um"});
  profile("profile.at_deg", &ProfileInput::at_deg, between(-180, 180), "The positions in degrees.");
  profile("profile.factor", &ProfileInput::factor, not_negative, "`table`: factor at each position.");
  profile("profile.array", &ProfileInput::array, anything,
          "`array`: cell array that sets the factor, linear between `from` and `to`.");
  profile("profile.from", &ProfileInput::from, anything,
          "Array value at which, and before which, the factor is `edge`.");
  profile("profile.to", &ProfileInput::to, anything,
          "Array value at which, and beyond which, it is `middle`; below `from` for a decreasing factor.");
  profile("profile.full_length_um", &ProfileInput::full_length_um, positive,
          "Taper along x: full factor on this length about the centre (µm).");
  profile("profile.fade_um", &ProfileInput::fade_um, positive,
          "Taper along x: cosine decrease to `edge` on this length (µm).");
  rows.push_back(table("variation.spread", &Table::variation, &VariationInput::spread, between(0, 100),
                       "Relative standard deviation of the factor."));
  rows.push_back(table("variation.seed", &Table::variation, &VariationInput::seed, not_negative, "Random seed."));
  rows.push_back(table("variation.by", &Table::variation, &VariationInput::by, one_of(words::variation_bys),
                       "Random numbers depend on the cell number, or on its reference position (to 0.01 µm), which is "
                       "independent of mesh numbering; default number."));
}

/// Adds the keys of amplitude factors, activation wave and pulses.
template <class Table>
void add_pattern(std::vector<Row>& rows, const RowsIn<Table>& table) {
  add_strengths(rows, table);
  rows.push_back(table("delay.speed_um_per_s", &Table::delay, &DelayInput::speed_um_per_s,
                       {.low = 0, .low_included = false, .word_for_none = "none"},
                       "Wave speed (µm/s). Before the wave arrives, a cell is slack."));
  rows.push_back(table("delay.axis", &Table::delay, &DelayInput::axis, one_of(words::delay_axes),
                       "Direction of the wave, as in `profile.axis`; default along."));
  rows.push_back(table("delay.from", &Table::delay, &DelayInput::from, one_of(words::delay_starts),
                       "Origin of the wave in the region at time 0; low: anterior or left end. Default middle."));
  rows.push_back(
      table("pulse.period_s", &Table::pulse, &PulseInput::period_s, {.low = 1, .word_for_none = "none"},
            "Period (s). Adaptive steps are at most a twelfth of it, and the run does not stop at equilibrium."));
  rows.push_back(table("pulse.period_min", &Table::pulse, &PulseInput::period_s, {.low = 0.02, .word_for_none = "none"},
                       "`period_s` in minutes.", {.instead_of = "pulse.period_s", .scale = 60}));
  rows.push_back(table("pulse.amplitude", &Table::pulse, &PulseInput::amplitude, between(0, 1),
                       "Relative amplitude; 1: from 0 to twice the mean."));
  rows.push_back(table("pulse.phase", &Table::pulse, &PulseInput::phase, one_of(words::pulse_phases),
                       "Own phase per cell, drawn by seed and position, or one for all; default random."));
  rows.push_back(table("pulse.spread", &Table::pulse, &PulseInput::spread, between(0, 1),
                       "Relative standard deviation of the log-normal periods of cells."));
  rows.push_back(
      table("pulse.seed", &Table::pulse, &PulseInput::seed, not_negative, "Random seed of phases and periods."));
}

}  // namespace plica
