// CSV tables of a run: their text, and rows of series.csv written and read back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measure/observation.hpp"

namespace plica {

/// Format rows of `columns` values each, separated by commas and joined by '\n', with up to ten significant digits (as
/// %.10g). Values that are not finite become empty fields; no "-0".
std::string csv_rows(std::span<const double> values, std::size_t columns);

/// Format the rows of columns of equal length in the same way.
std::string csv_of_columns(std::span<const std::vector<double>> columns);

/// Format one row with as many digits as it takes to read the same values; missing values become empty fields.
std::string csv_row(std::span<const std::optional<double>> values);

/// Write a new table with this header, unless `keep_bytes` of an earlier one are kept; returns the bytes to keep, for
/// RowFile.
std::uint64_t begin_table(const std::filesystem::path& file, const std::vector<std::string>& header,
                          std::uint64_t keep_bytes);

/// Columns of series.csv: output variables of each step, then monitors.
std::vector<std::string> series_header(const Observer& observer);

std::string series_row(const Observation& row, const ColumnList& columns);

/// Read back the rows of a series.csv that this observer measured. Throws FileError for other columns or values.
std::vector<Observation> read_series_rows(const std::filesystem::path& file, const Observer& observer);

}  // namespace plica
