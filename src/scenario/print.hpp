// Output of a scenario as TOML, of its differences from another, and of the reference page of all keys.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"

namespace plica {

/// Writes every key with defaults filled in, except optional keys without a value. Loads back to the same Scenario.
std::string resolved_toml(const Scenario& scenario);

/// Quotes a text for TOML.
std::string in_toml(const std::string& text);

/// Writes a number as a TOML float even if it is whole, so that integer keys reject it.
std::string float_in_toml(double value);

/// Writes docs/reference/scenario.md: keys, types, defaults, allowed values and meanings by table. Inner tables that
/// several tables share (profile, program, ...) have one section each, linked from these tables.
std::string reference_markdown();

/// Dotted key and its two values in TOML; empty where a scenario lacks the key.
struct KeyDifference {
  std::string key, a, b;

  [[nodiscard]] std::string text() const;  // "embryo.length_um was 60 and is now 70"
};

/// Compares two resolved scenarios (scenario.toml of a run) and returns differing keys in alphabetical order. Invalid
/// TOML counts as empty.
std::vector<KeyDifference> scenario_differences(std::string_view a, std::string_view b);

}  // namespace plica
