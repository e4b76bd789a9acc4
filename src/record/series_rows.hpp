// Rows of series.csv.
#pragma once

#include <string>
#include <vector>

#include "measure/observation.hpp"

namespace plica {

/// Column names: output variables of each step, then monitors.
std::vector<std::string> series_header(const Observer& observer);

std::string series_row(const Observation& row, const ColumnList& columns);

}  // namespace plica
