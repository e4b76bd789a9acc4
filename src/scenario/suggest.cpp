#include "scenario/suggest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <set>
#include <utility>

namespace plica {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

// Levenshtein distance in which swapping two neighbours is one edit; keeps three rows of the table.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> above, two_above, row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_above = std::exchange(above, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = a[i - 1] == b[j - 1];
      row[j] = std::min({above[j - 1] + (same ? 0 : 1), above[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& known) {
  const std::string wanted = lower(name);
  std::optional<std::string> nearest;
  std::size_t smallest = std::max<std::size_t>(1, wanted.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(wanted, lower(candidate));
    if (distance < smallest && distance < wanted.size()) {
      smallest = distance;
      nearest = candidate;
    }
  }
  if (nearest || wanted.size() < 4) return nearest;
  for (const std::string& candidate : known) {
    if (lower(candidate).starts_with(wanted)) return candidate;
  }
  return nearest;
}

std::string without_unit(std::string_view name) {
  static const std::set<std::string, std::less<>> units = {
      "per", "m",  "m2",  "m3", "cm",  "mm",  "mm2", "um", "um2", "um3", "nm", "s",  "ms", "sec",
      "h",   "hr", "min", "pa", "kpa", "mpa", "gpa", "n",  "mn",  "un",  "nn", "pn", "kg", "g"};
  std::string stem = lower(name);
  for (std::size_t bar = stem.rfind('_'); bar != std::string::npos && bar > 0; bar = stem.rfind('_')) {
    if (!units.contains(stem.substr(bar + 1))) break;
    stem.resize(bar);
  }
  return stem;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  if (const auto nearest = nearest_name(name, known)) return fmt::format("use \"{}\" (nearest match)", *nearest);
  return known.empty() ? "none is defined" : fmt::format("use one of: {}", fmt::join(known, ", "));
}

}  // namespace plica
