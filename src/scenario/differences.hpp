// In which keys two scenarios differ.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// A key in dotted form, as in --set, and its two values as in TOML; empty where a scenario has none.
struct KeyDifference {
  std::string key, a, b;
};

/// Of two scenarios as a run leaves them (scenario.toml, every default filled in), in the order of keys. A text that is
/// no TOML has no keys.
std::vector<KeyDifference> scenario_differences(std::string_view a, std::string_view b);

}  // namespace plica
