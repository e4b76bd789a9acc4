// Text of a scenario: limits before it is parsed, and messages for syntax errors.
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "core/errors.hpp"

namespace plica {

/// Converts a parse error of `text` (named `file` in messages) to a message: a key set twice, text without quotes, or
/// the library's own description.
Diagnostic syntax_diagnostic(const std::string& file, const std::string& text, const toml::parse_error& error);

/// Largest size of a scenario file (bytes).
inline constexpr std::uintmax_t largest_scenario_bytes = std::uintmax_t{4} << 20;

/// Largest number of scenarios in a chain of bases.
inline constexpr std::size_t most_bases = 16;

/// Largest number of parts of a dotted key; scenario keys have at most four.
inline constexpr int most_key_parts = 16;

/// Returns the line of a key with more than `most_key_parts` parts, or 0. The TOML library recurses once per part and
/// would overflow the stack; it rejects deeply nested values itself.
int line_of_too_deep_key(std::string_view text);

}  // namespace plica
