// Suggestions for unknown names.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Returns the known name nearest to `name` by edit distance, ignoring case; nothing if none is near.
std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& known);

/// Returns `name` without its unit: young_modulus for young_modulus_Pa and for young_modulus_kPa.
std::string without_unit(std::string_view name);

/// Returns a remedy: "use "x" (nearest match)" if a known name is near, otherwise "use one of: ...".
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

}  // namespace plica
