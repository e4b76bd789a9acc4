// Rules between several keys of a scenario, which its tables check (tables/).
#pragma once

#include "scenario/input.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Reports inconsistent keys to `input` and sets defaults that depend on other keys: fields that the embryo's shape
/// does not use, the length of a sphere (its diameter), the vitelline membrane of a block (none), values that are
/// "automatic".
void validate(Scenario& scenario, Input& input);

/// Returns what second order in time does not support in a scenario; empty if nothing.
std::string what_bars_second_order(const Scenario& scenario);

}  // namespace plica
