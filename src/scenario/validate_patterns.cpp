// Profiles, waves and pulses: what their shape needs, and what has no meaning with it.
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

/// A key of a profile that belongs to one shape, and to axes of lengths, of angles, or to any.
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
    {"sigma_um", "gaussian", lengths, &ProfileInput::sigma_cells},  // stands in for it
    {"sigma_deg", "gaussian", angles, &ProfileInput::sigma_deg},
    {"full_cells", "plateau", lengths, &ProfileInput::full_cells},
    {"fade_cells", "plateau", lengths, &ProfileInput::fade_cells},
    {"full_deg", "plateau", angles, &ProfileInput::full_deg},
    {"fade_deg", "plateau", angles, &ProfileInput::fade_deg},
    {"from", "array", any, &ProfileInput::from},
    {"to", "array", any, &ProfileInput::to}};

constexpr ProfileKey<std::vector<double>> list_keys[] = {
    {"at_um", "table", lengths, &ProfileInput::at_um},
    {"at_um", "table", lengths, &ProfileInput::at_cells},  // stands in for it
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
      drop(path_ + ".axis", profile_.axis, {}, path_ + ".shape", with_shape(), "remove it", input_);
    else if (profile_.axis.empty())
      profile_.axis = "across";
    for (const auto& one : number_keys) drop_unused(one);
    for (const auto& one : list_keys) drop_unused(one);
    if (profile_.shape != "array")
      drop(path_ + ".array", profile_.array, {}, path_ + ".shape", with_shape(), "remove it, or choose shape \"array\"",
           input_);
    if (profile_.axis != "angle")
      drop(path_ + ".centre_deg", profile_.centre_deg, {}, path_ + ".axis", "goes with axis \"angle\"",
           "remove it, or choose that axis", input_);
    check_about();
    check_needed();
  }

 private:
  [[nodiscard]] std::string with_shape() const {
    return fmt::format("has no meaning with shape \"{}\"", profile_.shape);
  }
  [[nodiscard]] bool has_angles() const { return profile_.axis == "angle"; }
  [[nodiscard]] bool has_taper() const { return profile_.full_length_um.has_value(); }

  void report(const std::string& key, const std::string& problem, const std::string& remedy) {
    if (input_.sound(path_ + key)) input_.report(path_ + key, problem, remedy);
  }

  void check_taper() {
    if (!input_.sound(path_) || profile_.full_length_um.has_value() == profile_.fade_um.has_value()) return;
    report(profile_.full_length_um ? ".fade_um" : ".full_length_um", "is missing",
           "a taper along the axis has both lengths");
  }

  /// Values in the middle and at the edge.
  void check_ends() {
    const std::string chooser = path_ + ".shape";
    const bool is_flat = (profile_.shape.empty() || profile_.shape == "constant") && !has_taper();
    if (!is_flat && profile_.shape != "table") return;
    for (const auto& [key, value] : {std::pair(".middle", &profile_.middle), {".edge", &profile_.edge}})
      drop(path_ + key, *value, {}, input_.place(chooser) == nullptr ? path_ + key : chooser,
           is_flat ? "has no meaning where nothing fades" : "has no meaning beside the factors of a table",
           is_flat ? "remove it, or choose another shape, or a taper" : "remove it", input_);
  }

  void check_no_shape() {
    bool some = !profile_.axis.empty() || !profile_.array.empty() || profile_.centre_deg.has_value();
    for (const auto& one : number_keys) some |= (profile_.*one.field).has_value();
    for (const auto& one : list_keys) some |= !(profile_.*one.field).empty();
    if (some)
      report(".shape", "is missing", fmt::format("give one of: {}", fmt::join(words_of(words::profile_shapes), " | ")));
  }

  template <class Field>
  void drop_unused(const ProfileKey<Field>& one) {
    const std::string key = path_ + "." + one.key;
    Field& field = profile_.*one.field;
    if (profile_.shape != one.shape)
      drop(key, field, {}, path_ + ".shape", with_shape(), fmt::format("remove it, or choose shape \"{}\"", one.shape),
           input_);
    else if (one.places != any && (one.places == angles) != has_angles())
      drop(key, field, {}, path_ + ".axis", fmt::format("has no meaning with axis \"{}\"", profile_.axis),
           has_angles() ? "give degrees, or another axis" : "give lengths, or axis \"angle\"", input_);
  }

  /// The middle and the cells that lengths are counted in.
  void check_about() {
    if (profile_.about.empty() || has_taper() || (!has_angles() && profile_.shape != "array")) return;
    report(".about", has_angles() ? "has no meaning with axis \"angle\"" : with_shape(),
           has_angles() ? "remove it; centre_deg says where the middle is" : "remove it");
  }

  void need(const std::string& key, bool is_there, const std::string& remedy) {
    if (!is_there) report(key, "is missing", remedy);
  }

  void check_needed() {
    const ProfileInput& p = profile_;
    if (p.shape == "linear" && has_angles())
      need(".half_width_deg", p.half_width_deg.has_value(), "give the angle at which the factor is edge, a number > 0");
    else if (p.shape == "linear")
      need(".half_width_um", p.half_width_um.has_value(),
           "give the distance at which the factor is edge, a number > 0");
    if (p.shape == "gaussian" && has_angles())
      need(".sigma_deg", p.sigma_deg.has_value(), "give the width of the gaussian in degrees, a number > 0");
    else if (p.shape == "gaussian")
      need(".sigma_um", p.sigma_um || p.sigma_cells, "give the width of the gaussian, a number > 0, or sigma_cells");
    if (p.shape == "plateau" && has_angles()) {
      need(".full_deg", p.full_deg.has_value(), "give on how many degrees the factor is that of the middle");
      need(".fade_deg", p.fade_deg.has_value(), "give over how many degrees it fades, 0 for none");
    } else if (p.shape == "plateau") {
      need(".full_cells", p.full_cells.has_value(), "give how many cells have the factor of the middle, a number > 0");
      need(".fade_cells", p.fade_cells.has_value(), "give over how many cells it fades, 0 for none");
    }
    if (p.shape == "array") check_array();
    if (p.shape == "table") check_table();
  }

  void check_array() {
    need(".array", !profile_.array.empty(), "name an array of the tissue's cells");
    need(".from", profile_.from.has_value(), "give the value of the array at which the factor is edge (0)");
    need(".to", profile_.to.has_value(), "give the value of the array at which the factor is middle (1)");
    if (profile_.from && profile_.from == profile_.to)
      report(".to", "is where the factor is edge, too", "give another value than from");
  }

  void check_table() {
    const std::string key = has_angles() ? ".at_deg" : ".at_um";
    const std::vector<double>& at = has_angles()              ? profile_.at_deg
                                    : !profile_.at_um.empty() ? profile_.at_um
                                                              : profile_.at_cells;
    need(key, !at.empty(),
         has_angles() ? "give the angles of the points" : "give the places of the points, or at_cells");
    need(".factor", !profile_.factor.empty(), "give a factor for each of the places");
    if (at.empty() || profile_.factor.empty() || !input_.sound(path_ + key)) return;
    if (at.size() != profile_.factor.size())
      report(".factor", fmt::format("has {} numbers for {} places", profile_.factor.size(), at.size()),
             "give as many factors as places");
    if (std::ranges::adjacent_find(at, std::ranges::greater_equal()) != at.end())
      report(key, "the places do not increase", "give each place farther than the one before");
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
    input.report(chooser, "is missing", "give the speed of the wave, a number > 0, or \"none\"");
  } else {
    const std::string problem = "has no meaning with speed \"none\"", remedy = "remove it, or give a speed";
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
      input.report(period, "is missing", "give how long a pulse takes, a number >= 1, or \"none\"");
    pulse = {};
    return;
  }
  if (pulse.phase.empty()) pulse.phase = "random";
  const double longest_s = longest_step_of_pulses_s(pulse);
  if (time.step_s && *time.step_s > longest_s && input.sound("time.step_s"))
    input.report(period, fmt::format("steps of {} s do not see pulses of {} s", *time.step_s, *pulse.period_s),
                 fmt::format("give time.step_s of at most {:.3g}, or \"adaptive\"", longest_s));
}

}  // namespace plica
