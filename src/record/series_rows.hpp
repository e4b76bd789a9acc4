// The rows of series.csv.
#pragma once

#include <string>
#include <vector>

#include "measure/observation.hpp"

namespace plica {

/// Names of its columns: the measures of every step, then the monitors.
std::vector<std::string> series_header(const std::vector<Monitor>& monitors);

std::string series_row(const Observation& row);

}  // namespace plica
