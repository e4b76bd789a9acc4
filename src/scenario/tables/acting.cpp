// Keys and rules that all tables that act have: program, profile, variation, delay, pulse.
#include <fmt/ranges.h>

#include <algorithm>
#include <variant>

#include "core/clock.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace {

enum class Places { lengths, angles, any };
using enum Places;

/// A profile key used with one shape, and with axes of lengths, angles, or any.
struct ProfileKey {
  std::string_view key;
  const char* shape;
  Places places;
  std::variant<std::optional<double> ProfileInput::*, std::vector<double> ProfileInput::*, std::string ProfileInput::*>
      field;
  Allowed allowed;
  std::string_view meaning;
  const char* remedy;                // if it lacks; null: it is in an alternative unit
  std::string_view instead_of = "";  // the key whose unit it has not

  /// Its place below the profile, such as ".sigma_um".
  [[nodiscard]] std::string below_profile() const {
    return std::string((instead_of.empty() ? key : instead_of).substr(std::string_view("profile").size()));
  }
};

const std::vector<ProfileKey>& profile_keys() {
  using P = ProfileInput;
  static const std::vector<ProfileKey> keys = {
      {"profile.half_width_um", "linear", lengths, &P::half_width_um, positive,
       "`linear`: distance at which the factor reaches `edge` (µm).",
       "set half_width_um to the distance at which the factor reaches edge, a number > 0"},
      {"profile.half_width_deg", "linear", angles, &P::half_width_deg, positive, "Likewise in degrees.",
       "set half_width_deg to the angle at which the factor reaches edge, a number > 0"},
      {"profile.sigma_um", "gaussian", lengths, &P::sigma_um, positive, "`gaussian`: standard deviation σ (µm).",
       "set sigma_um or sigma_cells to a number > 0"},
      {"profile.sigma_cells", "gaussian", lengths, &P::sigma_cells, positive,
       "σ in cells: mean cell width of the region along the axis of d.", nullptr, "profile.sigma_um"},
      {"profile.sigma_deg", "gaussian", angles, &P::sigma_deg, positive, "σ in degrees.",
       "set sigma_deg to a number > 0"},
      {"profile.full_cells", "plateau", lengths, &P::full_cells, positive,
       "`plateau`: full width with factor `middle` (cells).", "set full_cells to the number of cells in the plateau"},
      {"profile.fade_cells", "plateau", lengths, &P::fade_cells, not_negative,
       "`plateau`: width of the taper on either side (cells); 0: none.",
       "set fade_cells to the width of the taper in cells (0: none)"},
      {"profile.full_deg", "plateau", angles, &P::full_deg, positive, "`plateau`: full width (degrees).",
       "set full_deg to the angular width of the plateau"},
      {"profile.fade_deg", "plateau", angles, &P::fade_deg, not_negative,
       "`plateau`: width of the taper (degrees); 0: none.",
       "set fade_deg to the width of the taper in degrees (0: none)"},
      {"profile.at_um", "table", lengths, &P::at_um, anything,
       "`table`: positions from the centre (µm), increasing; the factor is constant beyond the ends. Without "
       "negative values: distances on both sides. Otherwise positive is right or posterior.",
       "set at_um or at_cells to the positions of the points"},
      {"profile.at_cells", "table", lengths, &P::at_cells, anything, "The positions in cells, as for `sigma_cells`.",
       nullptr, "profile.at_um"},
      {"profile.at_deg", "table", angles, &P::at_deg, between(-180, 180), "The positions in degrees.",
       "set at_deg to the angles of the points"},
      {"profile.factor", "table", any, &P::factor, not_negative, "`table`: factor at each position.",
       "set factor to one value per position"},
      {"profile.array", "array", any, &P::array, anything,
       "`array`: cell array that sets the factor, linear between `from` and `to`.",
       "set array to a cell array of the embryo"},
      {"profile.from", "array", any, &P::from, anything,
       "Array value at which, and before which, the factor is `edge`.",
       "set `from` to the array value at which the factor is edge (0)"},
      {"profile.to", "array", any, &P::to, anything,
       "Array value at which, and beyond which, it is `middle`; below `from` for a decreasing factor.",
       "set `to` to the array value at which the factor is middle (1)"}};
  return keys;
}

class ProfileCheck {
 public:
  ProfileCheck(std::string path, ProfileInput& profile, Input& input)
      : path_(std::move(path)), profile_(profile), input_(input) {}

  void check() {
    check_taper();
    if (!input_.sound(path_) || !input_.sound(path_ + ".shape")) return;
    check_ends();
    if (profile_.shape.empty()) return check_no_shape();
    if (profile_.shape == "array")
      drop(path_ + ".axis", profile_.axis, {}, path_ + ".shape", with_shape(), "remove axis", input_);
    else if (profile_.axis.empty())
      profile_.axis = "across";
    for (const ProfileKey& one : profile_keys())
      std::visit([&](auto field) { drop_unused(one, profile_.*field); }, one.field);
    if (profile_.axis != "angle")
      drop(path_ + ".centre_deg", profile_.centre_deg, {}, path_ + ".axis", "requires axis \"angle\"",
           "remove centre_deg, or set axis to \"angle\"", input_);
    check_about();
    check_needed();
  }

 private:
  [[nodiscard]] std::string with_shape() const { return fmt::format("is not used with shape \"{}\"", profile_.shape); }
  [[nodiscard]] bool has_angles() const { return profile_.axis == "angle"; }
  [[nodiscard]] bool has_taper() const { return profile_.full_length_um.has_value(); }

  void report(const std::string& key, const std::string& problem, const std::string& remedy) {
    if (input_.sound(path_ + key)) input_.report(path_ + key, problem, remedy);
  }

  void check_taper() {
    if (!input_.sound(path_) || profile_.full_length_um.has_value() == profile_.fade_um.has_value()) return;
    report(profile_.full_length_um ? ".fade_um" : ".full_length_um", "is missing",
           "set both full_length_um and fade_um");
  }

  void check_ends() {
    const std::string chooser = path_ + ".shape";
    const bool is_flat = (profile_.shape.empty() || profile_.shape == "constant") && !has_taper();
    if (!is_flat && profile_.shape != "table") return;
    for (const auto& [key, value] : {std::pair(".middle", &profile_.middle), {".edge", &profile_.edge}})
      drop(path_ + key, *value, {}, input_.place(chooser) == nullptr ? path_ + key : chooser,
           is_flat ? "is not used with a constant profile" : "is not used with shape \"table\"",
           is_flat ? "remove it, or set another shape or a taper" : "remove it", input_);
  }

  void check_no_shape() {
    if (!profile_.axis.empty() || profile_.centre_deg ||
        std::ranges::any_of(profile_keys(), [&](const ProfileKey& one) { return is_set(one); }))
      report(".shape", "is missing",
             fmt::format("set shape to one of: {}", fmt::join(words_of(words::profile_shapes), " | ")));
  }

  [[nodiscard]] bool is_set(const ProfileKey& one) const {
    const auto is_set = [&]<class Field>(Field ProfileInput::*field) { return profile_.*field != Field(); };
    return std::visit(is_set, one.field);
  }
  [[nodiscard]] bool fits_axis(const ProfileKey& one) const {
    return one.places == any || (one.places == angles) == has_angles();
  }

  template <class Field>
  void drop_unused(const ProfileKey& one, Field& field) {
    const std::string key = path_ + one.below_profile();
    if (profile_.shape != one.shape)
      drop(key, field, {}, path_ + ".shape", with_shape(), fmt::format("remove it, or set shape to \"{}\"", one.shape),
           input_);
    else if (!fits_axis(one))
      drop(key, field, {}, path_ + ".axis", fmt::format("is not used with axis \"{}\"", profile_.axis),
           has_angles() ? "use the key in degrees, or set another axis" : "use a length, or set axis to \"angle\"",
           input_);
  }

  /// Checks `about`, which sets the centre and the cell size.
  void check_about() {
    if (profile_.about.empty() || has_taper() || (!has_angles() && profile_.shape != "array")) return;
    report(".about", has_angles() ? "is not used with axis \"angle\"" : with_shape(),
           has_angles() ? "remove about; centre_deg sets the centre" : "remove about");
  }

  void check_needed() {
    const ProfileInput& p = profile_;
    for (const ProfileKey& one : profile_keys()) {
      const std::string key = one.below_profile();
      const auto sets_it = [&](const ProfileKey& other) { return other.below_profile() == key && is_set(other); };
      if (p.shape == one.shape && fits_axis(one) && one.remedy != nullptr &&
          std::ranges::none_of(profile_keys(), sets_it))
        report(key, "is missing", one.remedy);
    }
    if (p.shape == "array" && p.from && p.from == p.to) report(".to", "equals `from`", "set `to` to a different value");
    if (p.shape == "table") check_table();
  }

  void check_table() {
    const std::string key = has_angles() ? ".at_deg" : ".at_um";
    const std::vector<double>& at = has_angles()              ? profile_.at_deg
                                    : !profile_.at_um.empty() ? profile_.at_um
                                                              : profile_.at_cells;
    if (at.empty() || profile_.factor.empty() || !input_.sound(path_ + key)) return;
    if (at.size() != profile_.factor.size())
      report(".factor", fmt::format("has length {} for {} positions", profile_.factor.size(), at.size()),
             "set factor to as many values as positions");
    if (std::ranges::adjacent_find(at, std::ranges::greater_equal()) != at.end())
      report(key, "the positions do not increase", "list positions in increasing order");
  }

  std::string path_;
  ProfileInput& profile_;
  Input& input_;
};

void check_delay(const std::string& table, DelayInput& delay, Input& input) {
  const std::string path = table + ".delay", chooser = path + ".speed_um_per_s";
  if (!input.sound(table) || !input.sound(path) || !input.sound(chooser)) return;
  if (delay.speed_um_per_s) {
    if (delay.axis.empty()) delay.axis = "along";
    if (delay.from.empty()) delay.from = "middle";
  } else if (input.place(chooser) == nullptr && (!delay.axis.empty() || !delay.from.empty())) {
    input.report(chooser, "is missing", "set speed_um_per_s to a number > 0 or \"none\"");
  } else {
    const std::string problem = "is not used with speed \"none\"", remedy = "remove it, or set speed_um_per_s";
    drop(path + ".axis", delay.axis, {}, chooser, problem, remedy, input);
    drop(path + ".from", delay.from, {}, chooser, problem, remedy, input);
  }
}

void check_pulse(const std::string& table, PulseInput& pulse, const TimeInput& time, Input& input) {
  const std::string path = table + ".pulse", period = path + ".period_s";
  if (!input.sound(table) || !input.sound(path) || !input.sound(period)) return;
  if (!pulse.period_s) {
    const bool is_given = std::ranges::any_of(std::to_array({".amplitude", ".phase", ".spread", ".seed"}),
                                              [&](const char* key) { return input.place(path + key) != nullptr; });
    if (is_given && input.place(period) == nullptr)
      input.report(period, "is missing", "set period_s to a number >= 1 or \"none\"");
    pulse = {};
    return;
  }
  if (pulse.phase.empty()) pulse.phase = "random";
  const double longest_s = longest_step_of_pulses_s(pulse);
  if (time.step_s && *time.step_s > longest_s && input.sound("time.step_s"))
    input.report(period,
                 fmt::format("time steps of {} s do not resolve a period of {} s", *time.step_s, *pulse.period_s),
                 fmt::format("set time.step_s to at most {:.3g} or \"adaptive\"", longest_s));
}

}  // namespace

void add_strengths(std::vector<KeyRow>& rows, const KeyRows<ActingInput>& table) {
  using A = ActingInput;
  const auto profile = [&](std::string_view key, auto field, const Allowed& allowed, std::string_view meaning,
                           const KeyOptions& options = {}) {
    rows.push_back(table(key, &A::profile, field, allowed, meaning, options));
  };
  profile("profile.shape", &ProfileInput::shape, one_of(words::profile_shapes),
          "`constant`; `linear`: `edge` from `half_width_um` on; `gaussian`: exp(−d²/2σ²); `plateau`: `middle` on "
          "`full_cells`, then a cosine taper over `fade_cells` on either side; `table`: given points; `array`: by a "
          "cell array.");
  profile("profile.axis", &ProfileInput::axis, one_of(words::profile_axes),
          "Axis of d: across (arc about the embryo axis; y in an open tissue), along (x), or the angle from ventral "
          "(°); default across.");
  profile("profile.about", &ProfileInput::about, anything,
          "Region that sets the centre and the cell size; default the table's own region.");
  profile("profile.centre_deg", &ProfileInput::centre_deg, between(-180, 180),
          "Angle of the centre; 0: ventral (default), 90: right.");
  profile("profile.middle", &ProfileInput::middle, not_negative, "Factor at the centre; default 1.");
  profile("profile.edge", &ProfileInput::edge, not_negative, "Factor far away; default 0.");
  for (const ProfileKey& one : profile_keys())
    std::visit([&](auto field) { profile(one.key, field, one.allowed, one.meaning, {.instead_of = one.instead_of}); },
               one.field);
  profile("profile.full_length_um", &ProfileInput::full_length_um, positive,
          "Taper along x: full factor on this length about the centre (µm).");
  profile("profile.fade_um", &ProfileInput::fade_um, positive,
          "Taper along x: cosine decrease to `edge` on this length (µm).");
  rows.push_back(table("variation.spread", &A::variation, &VariationInput::spread, between(0, 100),
                       "Relative standard deviation of the factor."));
  rows.push_back(table("variation.seed", &A::variation, &VariationInput::seed, not_negative, "Random seed."));
  rows.push_back(table("variation.by", &A::variation, &VariationInput::by, one_of(words::variation_bys),
                       "Random numbers depend on the cell number, or on its reference position (to 0.01 µm), which is "
                       "independent of mesh numbering; default number."));
}

void add_pattern(std::vector<KeyRow>& rows, const KeyRows<ActingInput>& table) {
  using A = ActingInput;
  add_strengths(rows, table);
  rows.push_back(table("delay.speed_um_per_s", &A::delay, &DelayInput::speed_um_per_s, positive_or_none,
                       "Wave speed (µm/s). Before the wave arrives, a cell is slack."));
  rows.push_back(table("delay.axis", &A::delay, &DelayInput::axis, one_of(words::delay_axes),
                       "Direction of the wave, as in `profile.axis`; default along."));
  rows.push_back(table("delay.from", &A::delay, &DelayInput::from, one_of(words::delay_starts),
                       "Origin of the wave in the region at time 0; low: anterior or left end. Default middle."));
  rows.push_back(
      table("pulse.period_s", &A::pulse, &PulseInput::period_s, {.low = 1, .word_for_none = "none"},
            "Period (s). Adaptive steps are at most a twelfth of it, and the run does not stop at equilibrium."));
  rows.push_back(table("pulse.period_min", &A::pulse, &PulseInput::period_s, {.low = 0.02, .word_for_none = "none"},
                       "`period_s` in minutes.", {.instead_of = "pulse.period_s", .scale = 60}));
  rows.push_back(table("pulse.amplitude", &A::pulse, &PulseInput::amplitude, between(0, 1),
                       "Relative amplitude; 1: from 0 to twice the mean."));
  rows.push_back(table("pulse.phase", &A::pulse, &PulseInput::phase, one_of(words::pulse_phases),
                       "Own phase per cell, drawn by seed and position, or one for all; default random."));
  rows.push_back(table("pulse.spread", &A::pulse, &PulseInput::spread, between(0, 1),
                       "Relative standard deviation of the log-normal periods of cells."));
  rows.push_back(table("pulse.seed", &A::pulse, &PulseInput::seed, not_negative, "Random seed of phases and periods."));
}

void check_program(const std::string& table, const ProgramInput& program, Input& input, const std::string& name) {
  const std::string time = fmt::format("{}.{}.time_s", table, name);
  const std::string activity = fmt::format("{}.{}.activity", table, name);
  if (!input.sound(table) || !input.sound(time) || !input.sound(activity)) return;
  if (program.time_s.empty() && program.activity.empty()) return;
  if (program.time_s.empty()) return input.report(time, "is missing", "set time_s or time_min along with activity");
  if (program.activity.empty()) return input.report(activity, "is missing", "set activity to as many values as times");
  if (program.time_s.size() != program.activity.size())
    input.report(activity, fmt::format("has length {} for {} times", program.activity.size(), program.time_s.size()),
                 "set activity to as many values as times");
  const auto& times = program.time_s;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] < times[i - 1])
      return input.report(time, "the times do not increase",
                          "list times in increasing order; repeat a time once to mark a jump");
    if (i > 1 && times[i] == times[i - 2])
      return input.report(time, fmt::format("{} occurs three times", times[i]), "repeat a time once to mark a jump");
    if (times[i] != times[i - 1] && has_come(times[i], times[i - 1]))
      return input.report(time, fmt::format("{} and {} are closer than {} s", times[i - 1], times[i], instant_s),
                          "repeat a time once to mark a jump");
  }
}

void check_acting(const std::string& table, ActingInput& acting, const TimeInput& time, Input& input) {
  check_program(table, acting.program, input);
  if (input.sound(table)) ProfileCheck(table + ".profile", acting.profile, input).check();
  check_delay(table, acting.delay, input);
  check_pulse(table, acting.pulse, time, input);
}

}  // namespace plica
