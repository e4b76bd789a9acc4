// Rows of numbers for CSV files.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace plica {

/// The rows of a table whose values lie row after row, `columns` in each, joined by '\n'; commas between values. At
/// most ten significant digits, as printf's %.10g gives them. A value that is not finite stands for none and leaves its
/// place empty. No "-0".
std::string csv_rows(std::span<const double> values, std::size_t columns);

/// One row; what has no value leaves its place empty.
std::string csv_row(std::span<const std::optional<double>> values);

}  // namespace plica
