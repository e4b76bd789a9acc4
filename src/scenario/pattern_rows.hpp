// Rows of the tables within tables that say how strongly and when each cell of a region acts.
#pragma once

#include "scenario/rows_in.hpp"

namespace plica {

/// A factor for each cell: profile and variation.
template <class Table>
void add_strengths(std::vector<Row>& rows, const RowsIn<Table>& table) {
  const auto profile = [&](std::string_view key, auto field, const Allowed& allowed, std::string_view meaning,
                           const RowOptions& options = {}) {
    rows.push_back(table(key, &Table::profile, field, allowed, meaning, options));
  };
  profile("profile.shape", &ProfileInput::shape, one_of(words::profile_shapes),
          "Factor on its strength by a cell's distance d from the region's middle, from `middle` there to `edge` far "
          "away. Linear: `edge` from `half_width_um` on; gaussian: by exp(−d²/2σ²); plateau: `middle` on `full_cells`, "
          "then a cosine over `fade_cells` on either side; table: points of one's own. Or, with array, by what was "
          "measured in the cell.");
  profile(
      "profile.axis", &ProfileInput::axis, one_of(words::profile_axes),
      "Distance across the axis (the arc about it through the cell's centre; y in a block) or along it (x); without "
      "it across. Or the angle about the axis, in degrees from the belly.");
  profile("profile.about", &ProfileInput::about, anything,
          "Region whose middle that is, and whose cells lengths in cells are measured in; without it the one that "
          "acts.");
  profile("profile.centre_deg", &ProfileInput::centre_deg, between(-180, 180),
          "Axis angle: where the middle is, 0 at the belly, 90 on the right; without it 0.");
  profile("profile.middle", &ProfileInput::middle, not_negative, "Factor in the middle; without it 1.");
  profile("profile.edge", &ProfileInput::edge, not_negative, "Factor far from it; without it 0.");
  profile("profile.half_width_um", &ProfileInput::half_width_um, positive,
          "Linear: distance at which the factor is `edge`, as it is beyond (µm).");
  profile("profile.half_width_deg", &ProfileInput::half_width_deg, positive, "The same with axis angle (degrees).");
  profile("profile.sigma_um", &ProfileInput::sigma_um, positive, "Gaussian: its standard deviation σ (µm).");
  profile("profile.sigma_cells", &ProfileInput::sigma_cells, positive,
          "Gaussian: σ in cells, by the mean width of the region's cells across the axis (along it with axis along).",
          {.instead_of = "profile.sigma_um"});
  profile("profile.sigma_deg", &ProfileInput::sigma_deg, positive, "Gaussian with axis angle: σ (degrees).");
  profile("profile.full_cells", &ProfileInput::full_cells, positive,
          "Plateau: how many cells across (along, with that axis) have the factor of the middle, both sides together.");
  profile("profile.fade_cells", &ProfileInput::fade_cells, not_negative,
          "Plateau: over how many cells it fades from there, on either side; 0: none between.");
  profile("profile.full_deg", &ProfileInput::full_deg, positive,
          "Plateau with axis angle: on how many degrees, both sides together, the factor is that of the middle.");
  profile("profile.fade_deg", &ProfileInput::fade_deg, not_negative,
          "And over how many degrees it fades from there, on either side; 0: none between.");
  profile("profile.at_um", &ProfileInput::at_um, anything,
          "Table: places of its points along the axis (µm from the middle), increasing; beyond the ends as there. "
          "Where none is negative they are distances, on both sides alike; else to the right, or posterior, is "
          "positive.");
  profile("profile.at_cells", &ProfileInput::at_cells, anything, "The same in cells, counted as for `sigma_cells`.",
          {.instead_of = "profile.at_um"});
  profile("profile.at_deg", &ProfileInput::at_deg, between(-180, 180), "The same with axis angle (degrees).");
  profile("profile.factor", &ProfileInput::factor, not_negative, "Table: the factor at each of the places.");
  profile("profile.array", &ProfileInput::array, anything,
          "Array: the one of the tissue's cells that says how strong each is: `edge` up to where it has the value "
          "`from`, `middle` from `to` on, linear between.");
  profile("profile.from", &ProfileInput::from, anything, "Value of the array at which the factor is `edge`.");
  profile("profile.to", &ProfileInput::to, anything,
          "Value at which it is `middle`; below `from` where what was measured weakens.");
  profile("profile.full_length_um", &ProfileInput::full_length_um, positive,
          "Taper along the axis: all of the strength on this length about the region's middle (µm).");
  profile("profile.fade_um", &ProfileInput::fade_um, positive,
          "Taper: from there it falls to `edge` on this length, as a cosine (µm).");
  rows.push_back(table("variation.spread", &Table::variation, &VariationInput::spread, between(0, 100),
                       "Relative standard deviation of a log-normal factor with mean 1 on each cell's strength."));
  rows.push_back(table("variation.seed", &Table::variation, &VariationInput::seed, not_negative,
                       "Another seed gives other factors."));
  rows.push_back(table("variation.by", &Table::variation, &VariationInput::by, one_of(words::variation_bys),
                       "What a cell's factor goes with, beside the seed: its number, or its place at rest (to 0.01 "
                       "µm), so that it does not matter how a mesh numbers its cells; without it the number."));
}

/// And when: a wave and pulses.
template <class Table>
void add_pattern(std::vector<Row>& rows, const RowsIn<Table>& table) {
  add_strengths(rows, table);
  rows.push_back(
      table("delay.speed_um_per_s", &Table::delay, &DelayInput::speed_um_per_s,
            {.low = 0, .low_included = false, .word_for_none = "none"},
            "Speed of a wave (µm/s): a cell's program starts when it arrives, and the cell is slack before."));
  rows.push_back(table("delay.axis", &Table::delay, &DelayInput::axis, one_of(words::delay_axes),
                       "Direction of the wave, as in `profile.axis`; without it along."));
  rows.push_back(
      table("delay.from", &Table::delay, &DelayInput::from, one_of(words::delay_starts),
            "Where the region's wave starts at time 0; without it in the middle. Low is the anterior end, or "
            "the left side."));
  rows.push_back(table("pulse.period_s", &Table::pulse, &PulseInput::period_s, {.low = 1, .word_for_none = "none"},
                       "Activity swells and ebbs as a sine with this period (s): times 1 + `amplitude` "
                       "sin(2π(t/period + phase)). Adaptive steps are a twelfth of it at most, and the run does not "
                       "end at rest."));
  rows.push_back(table("pulse.period_min", &Table::pulse, &PulseInput::period_s, {.low = 0.02, .word_for_none = "none"},
                       "The same in minutes.", {.instead_of = "pulse.period_s", .scale = 60}));
  rows.push_back(table("pulse.amplitude", &Table::pulse, &PulseInput::amplitude, between(0, 1),
                       "How far it goes, over the mean: with 1, from nothing to twice as much."));
  rows.push_back(table("pulse.phase", &Table::pulse, &PulseInput::phase, one_of(words::pulse_phases),
                       "Whether every cell has a phase of its own, drawn by seed and place; without it random."));
  rows.push_back(table("pulse.spread", &Table::pulse, &PulseInput::spread, between(0, 1),
                       "Relative standard deviation of the cells' periods, log-normal."));
  rows.push_back(table("pulse.seed", &Table::pulse, &PulseInput::seed, not_negative,
                       "Another seed gives other phases and periods."));
}

}  // namespace plica
