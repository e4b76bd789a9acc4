// The rules between the keys of [monitor.NAME] and [stop.NAME].
#pragma once

#include "scenario/input.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Reports monitors whose keys do not fit their quantity, criteria that bound nothing or what is not there, and
/// expectations of monitors that are not there.
void check_monitors(const Scenario& scenario, Input& input);

}  // namespace plica
