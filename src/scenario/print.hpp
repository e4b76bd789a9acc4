// A scenario as TOML again, and the reference page of all keys.
#pragma once

#include <string>

#include "scenario/scenario.hpp"

namespace plica {

/// Every key with its default filled in; optional keys without a value are left out. Loads back to the same Scenario.
std::string resolved_toml(const Scenario& scenario);

/// A text in TOML's quotes.
std::string in_toml(const std::string& text);

/// A number in TOML that is floating-point also where it is whole, so that a key that wants an integer says so.
std::string float_in_toml(double value);

/// The page docs/reference/scenario.md: for each table its keys, types, defaults, what is allowed, and meaning.
std::string reference_markdown();

}  // namespace plica
