// Checks of profiles, activation waves and pulses: required and unused keys.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scenario/acting.hpp"
#include "scenario/validate.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

enum class Places { lengths, angles, any };
using enum Places;

/// A profile key used with one shape, and with axes of lengths, angles, or any.
template <class Field>
struct ProfileKey {
  const char* key;
  const char* shape;
  Places places;
  Field ProfileInput::*field;
};

constexpr ProfileKey<std::optional<double>> number_keys[] = {
    {"half_width_um", "linear", lengths, &ProfileInput::half_width_um},
    {"half_width_deg", "linear", angles, &ProfileInput::half_width_deg},
    {"sigma_um", "gaussian", lengths, &ProfileInput::sigma_um},
    {"sigma_um", "gaussian", lengths, &ProfileInput::sigma_cells},  // alternative unit
    {"sigma_deg", "gaussian", angles, &ProfileInput::sigma_deg},
    {"full_cells", "plateau", lengths, &ProfileInput::full_cells},
    {"fade_cells", "plateau", lengths, &ProfileInput::fade_cells},
    {"full_deg", "plateau", angles, &ProfileInput::full_deg},
    {"fade_deg", "plateau", angles, &ProfileInput::fade_deg},
    {"from", "array", any, &ProfileInput::from},
    {"to", "array", any, &ProfileInput::to}};

constexpr ProfileKey<std::vector<double>> list_keys[] = {
    {"at_um", "table", lengths, &ProfileInput::at_um},
    {"at_um", "table", lengths, &ProfileInput::at_cells},  // alternative unit
    {"at_deg", "table", angles, &ProfileInput::at_deg},
    {"factor", "table", any, &ProfileInput::factor}};

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
    for (const auto& one : number_keys) drop_unused(one);
    for (const auto& one : list_keys) drop_unused(one);
    if (profile_.shape != "array")
      drop(path_ + ".array", profile_.array, {}, path_ + ".shape", with_shape(),
           "remove array, or set shape to \"array\"", input_);
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

  /// Checks `middle` and `edge`.
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
    bool some = !profile_.axis.empty() || !profile_.array.empty() || profile_.centre_deg.has_value();
    for (const auto& one : number_keys) some |= (profile_.*one.field).has_value();
    for (const auto& one : list_keys) some |= !(profile_.*one.field).empty();
    if (some)
      report(".shape", "is missing",
             fmt::format("set shape to one of: {}", fmt::join(words_of(words::profile_shapes), " | ")));
  }

  template <class Field>
  void drop_unused(const ProfileKey<Field>& one) {
    const std::string key = path_ + "." + one.key;
    Field& field = profile_.*one.field;
    if (profile_.shape != one.shape)
      drop(key, field, {}, path_ + ".shape", with_shape(), fmt::format("remove it, or set shape to \"{}\"", one.shape),
           input_);
    else if (one.places != any && (one.places == angles) != has_angles())
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

  void need(const std::string& key, bool is_there, const std::string& remedy) {
    if (!is_there) report(key, "is missing", remedy);
  }

  void check_needed() {
    const ProfileInput& p = profile_;
    if (p.shape == "linear" && has_angles())
      need(".half_width_deg", p.half_width_deg.has_value(),
           "set half_width_deg to the angle at which the factor reaches edge, a number > 0");
    else if (p.shape == "linear")
      need(".half_width_um", p.half_width_um.has_value(),
           "set half_width_um to the distance at which the factor reaches edge, a number > 0");
    if (p.shape == "gaussian" && has_angles())
      need(".sigma_deg", p.sigma_deg.has_value(), "set sigma_deg to a number > 0");
    else if (p.shape == "gaussian")
      need(".sigma_um", p.sigma_um || p.sigma_cells, "set sigma_um or sigma_cells to a number > 0");
    if (p.shape == "plateau" && has_angles()) {
      need(".full_deg", p.full_deg.has_value(), "set full_deg to the angular width of the plateau");
      need(".fade_deg", p.fade_deg.has_value(), "set fade_deg to the width of the taper in degrees (0: none)");
    } else if (p.shape == "plateau") {
      need(".full_cells", p.full_cells.has_value(), "set full_cells to the number of cells in the plateau");
      need(".fade_cells", p.fade_cells.has_value(), "set fade_cells to the width of the taper in cells (0: none)");
    }
    if (p.shape == "array") check_array();
    if (p.shape == "table") check_table();
  }

  void check_array() {
    need(".array", !profile_.array.empty(), "set array to a cell array of the embryo");
    need(".from", profile_.from.has_value(), "set `from` to the array value at which the factor is edge (0)");
    need(".to", profile_.to.has_value(), "set `to` to the array value at which the factor is middle (1)");
    if (profile_.from && profile_.from == profile_.to) report(".to", "equals `from`", "set `to` to a different value");
  }

  void check_table() {
    const std::string key = has_angles() ? ".at_deg" : ".at_um";
    const std::vector<double>& at = has_angles()              ? profile_.at_deg
                                    : !profile_.at_um.empty() ? profile_.at_um
                                                              : profile_.at_cells;
    need(key, !at.empty(),
         has_angles() ? "set at_deg to the angles of the points"
                      : "set at_um or at_cells to the positions of the points");
    need(".factor", !profile_.factor.empty(), "set factor to one value per position");
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

}  // namespace

void check_profile(const std::string& table, ProfileInput& profile, Input& input) {
  if (input.sound(table)) ProfileCheck(table + ".profile", profile, input).check();
}

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

}  // namespace plica
