// A comparison for reading, and for other programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "study/compare.hpp"

namespace plica {

/// The keys stand in docs/how-to/compare.md; what has no value is null.
nlohmann::ordered_json comparison_json(const Comparison& comparison);

/// A table for the terminal. Numbers that are the same in both runs are counted, not listed.
std::string comparison_text(const Comparison& comparison);

}  // namespace plica
