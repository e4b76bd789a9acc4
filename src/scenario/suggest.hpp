// What somebody who wrote an unknown name probably meant.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// The known name nearest to `name` by edit distance, case ignored; none where nothing is near.
std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& known);

/// `name` without the unit it ends with: young_modulus for young_modulus_Pa and for young_modulus_kPa.
std::string without_unit(std::string_view name);

/// "did you mean "x"?" where one is near, and otherwise "known are: ...".
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

}  // namespace plica
