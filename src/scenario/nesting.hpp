// Limits of a scenario's text that hold before the TOML library sees it.
#pragma once

#include <cstdint>
#include <string_view>

namespace plica {

/// Largest scenario file.
inline constexpr std::uintmax_t largest_scenario_bytes = std::uintmax_t{4} << 20;

/// Most scenarios that inherit from each other.
inline constexpr std::size_t most_bases = 16;

/// Most parts of a dotted key; a scenario's have at most four.
inline constexpr int most_key_parts = 16;

/// The line of a key with more than `most_key_parts` parts, or 0: the TOML library recurses once a part, until the
/// stack is full. Values nested without end it refuses itself.
int line_of_too_deep_key(std::string_view text);

}  // namespace plica
