#include "record/series_rows.hpp"

#include "record/csv.hpp"

namespace plica {

std::vector<std::string> series_header(const std::vector<Monitor>& monitors) {
  std::vector<std::string> names = series_names();
  for (const Monitor& monitor : monitors) names.push_back(monitor.column());
  return names;
}

std::string series_row(const Observation& row) {
  std::vector<std::optional<double>> values;
  for (std::size_t c = 0; c < columns().size(); ++c)
    if (columns()[c].in_series) values.push_back(row.values[c]);
  values.insert(values.end(), row.monitors.begin(), row.monitors.end());
  return csv_row(values);
}

}  // namespace plica
