// Differences between two scenarios, key by key.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Dotted key and its two values in TOML; empty where a scenario lacks the key.
struct KeyDifference {
  std::string key, a, b;

  [[nodiscard]] std::string text() const;  // "embryo.length_um was 60 and is now 70"
};

/// Compares two resolved scenarios (scenario.toml of a run) and returns differing keys in alphabetical order. Invalid
/// TOML counts as empty.
std::vector<KeyDifference> scenario_differences(std::string_view a, std::string_view b);

}  // namespace plica
