// Output of a comparison as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "study/compare.hpp"

namespace plica {

/// Convert to JSON; keys are listed in docs/how-to/compare.md, missing values are null.
nlohmann::ordered_json comparison_json(const Comparison& comparison);

/// Convert to a table for the terminal. Equal numbers are counted, not listed.
std::string comparison_text(const Comparison& comparison);

}  // namespace plica
