#include "record/series_rows.hpp"

#include "record/csv.hpp"

namespace plica {

std::vector<std::string> series_header(const Observer& observer) {
  std::vector<std::string> names;
  for (const Column* column : observer.columns())
    if (column->in_series) names.emplace_back(column->name);
  for (const Monitor& monitor : observer.monitors()) names.push_back(monitor.column());
  return names;
}

std::string series_row(const Observation& row, const ColumnList& columns) {
  std::vector<std::optional<double>> values;
  for (const Column* column : columns)
    if (column->in_series) values.push_back(row[*column]);
  values.insert(values.end(), row.monitors.begin(), row.monitors.end());
  return csv_row(values);
}

}  // namespace plica
