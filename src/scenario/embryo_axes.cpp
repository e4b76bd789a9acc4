#include "scenario/embryo_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "scenario/words.hpp"

namespace plica {
namespace {

constexpr std::string_view minus = "\u2212", plus = "+";

// Ends of "low-high", or of one word: −word and +word.
std::optional<std::array<std::string, 2>> ends_of(const std::string& axis) {
  const std::size_t hyphen = axis.find('-');
  if (hyphen == std::string::npos) return {{fmt::format("{}{}", minus, axis), fmt::format("{}{}", plus, axis)}};
  const std::string low = axis.substr(0, hyphen), high = axis.substr(hyphen + 1);
  if (low.empty() || high.empty() || high.find('-') != std::string::npos) return std::nullopt;
  return {{low, high}};
}

std::vector<std::string> all_ends(const EmbryoAxes& axes) {
  std::vector<std::string> names;
  for (const auto& ends : axes) names.insert(names.end(), ends.begin(), ends.end());
  return names;
}

// End of the UTF-8 character at `from`.
std::size_t next_character(const std::string& text, std::size_t from) {
  do ++from;
  while (from < text.size() && (static_cast<unsigned char>(text[from]) & 0xC0) == 0x80);
  return from;
}

std::string letter_of(const std::string& name, const std::vector<std::string>& names) {
  if (name.starts_with(minus) || name.starts_with(plus)) return name;
  std::string letter;
  for (std::size_t end = 0; end < name.size();) {
    end = next_character(name, end);
    letter = name.substr(0, end);
    if (std::ranges::count_if(names, [&](const std::string& other) { return other.starts_with(letter); }) == 1) break;
  }
  letter[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(letter[0])));
  return letter;
}

}  // namespace

const EmbryoAxes& anatomical_axes() {
  static const EmbryoAxes axes = {{{"anterior", "posterior"}, {"left", "right"}, {"ventral", "dorsal"}}};
  return axes;
}

const EmbryoAxes& plain_axes() {
  static const EmbryoAxes axes = {*ends_of("x"), *ends_of("y"), *ends_of("z")};
  return axes;
}

EmbryoAxes axes_of(const EmbryoInput& embryo) {
  if (embryo.axes.empty()) {
    const EmbryoShape shape = shape_of(embryo);
    const bool is_embryo = shape == EmbryoShape::file || (!is_from_file(shape) && !is_patch(shape));
    return is_embryo ? anatomical_axes() : plain_axes();
  }
  EmbryoAxes axes;
  for (std::size_t i = 0; i < axes.size(); ++i) axes[i] = ends_of(embryo.axes.at(i)).value();
  return axes;
}

bool have_furrow(const EmbryoAxes& axes) { return axes[2] == anatomical_axes()[2]; }

EmbryoAxes letters_of(const EmbryoAxes& axes) {
  const std::vector<std::string> names = all_ends(axes);
  EmbryoAxes letters = axes;
  for (auto& ends : letters)
    for (std::string& end : ends) end = letter_of(end, names);
  return letters;
}

std::string axes_problem(const std::vector<std::string>& axes) {
  if (axes.size() != 3) return fmt::format("has {} name{}, not three", axes.size(), axes.size() == 1 ? "" : "s");
  std::vector<std::string> names;
  for (const std::string& axis : axes) {
    const auto ends = ends_of(axis);
    if (!ends) return fmt::format("\"{}\" is neither \"low-high\" nor one word", axis);
    for (const std::string& end : *ends) {
      if (std::ranges::find(names, end) != names.end()) return fmt::format("\"{}\" names two ends", end);
      names.push_back(end);
    }
  }
  return "";
}

}  // namespace plica
