#include "record/csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>
#include <cmath>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/results.hpp"

namespace plica {
namespace {

constexpr int digits = 10;
constexpr double largest_short = 1e9;  // integers below it are written in full

char* put_number(char* at, char* end, double value) {
  const auto whole = std::abs(value) < largest_short ? static_cast<long>(value) : 0L;
  if (static_cast<double>(whole) == value) return std::to_chars(at, end, whole).ptr;  // includes -0
  return std::to_chars(at, end, value, std::chars_format::general, digits).ptr;
}

}  // namespace

std::string csv_rows(std::span<const double> values, std::size_t columns) {
  std::string text;
  text.reserve(values.size() * (digits + 2));
  std::array<char, 32> number;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += i % columns == 0 ? '\n' : ',';
    if (std::isfinite(values[i]))
      text.append(number.data(), put_number(number.data(), number.data() + number.size(), values[i]));
  }
  return text;
}

std::string csv_of_columns(std::span<const std::vector<double>> columns) {
  std::vector<double> rows;
  for (std::size_t r = 0; !columns.empty() && r < columns.front().size(); ++r)
    for (const std::vector<double>& column : columns) rows.push_back(column[r]);
  return csv_rows(rows, columns.size());
}

std::string csv_row(std::span<const std::optional<double>> values) {
  std::vector<std::string> fields;
  for (const std::optional<double>& value : values)
    fields.push_back(value && std::isfinite(*value) ? fmt::format("{}", *value + 0.0) : "");  // + 0: no "-0"
  return fmt::format("{}", fmt::join(fields, ","));
}

std::uint64_t begin_table(const std::filesystem::path& file, const std::vector<std::string>& header,
                          std::uint64_t keep_bytes) {
  if (keep_bytes > 0) return keep_bytes;
  const std::string line = fmt::format("{}\n", fmt::join(header, ","));
  write_file(file, line);
  return line.size();
}

std::vector<std::string> series_header(const Observer& observer) {
  std::vector<std::string> names;
  for (const Column* column : observer.columns())
    if (column->of_step) names.emplace_back(column->name);
  for (const Monitor& monitor : observer.monitors()) names.push_back(monitor.column());
  return names;
}

std::string series_row(const Observation& row, const ColumnList& columns) {
  std::vector<std::optional<double>> values;
  for (const Column* column : columns)
    if (column->of_step) values.push_back(row[*column]);
  values.insert(values.end(), row.monitors.begin(), row.monitors.end());
  return csv_row(values);
}

std::vector<Observation> read_series_rows(const std::filesystem::path& file, const Observer& observer) {
  constexpr std::uintmax_t most_bytes = std::uintmax_t{16} << 30;
  const Series series = read_series(file, most_bytes);
  if (series.columns != series_header(observer))
    throw FileError(file.string() + ": has other columns than this run; restart with --overwrite");
  std::vector<Observation> rows(series.rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    auto value = series.rows[r].begin();
    for (const Column* column : observer.columns())
      if (column->of_step) rows[r][*column] = *value++;
    rows[r].monitors.assign(value, series.rows[r].end());
    if (!fits_columns(rows[r])) throw FileError(fmt::format("{}:{}: a count is not an integer", file.string(), r + 2));
  }
  return rows;
}

}  // namespace plica
