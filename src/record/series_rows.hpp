// Rows of series.csv.
#pragma once

#include <string>
#include <vector>

#include "measure/observation.hpp"

namespace plica {

/// Column names: output variables of each step, then monitors.
std::vector<std::string> series_header(const std::vector<Monitor>& monitors);

std::string series_row(const Observation& row);

}  // namespace plica
