// Formatting of CSV rows.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace plica {

/// Format rows of `columns` values each, separated by commas and joined by '\n', with up to ten significant digits (as
/// %.10g). Values that are not finite become empty fields; no "-0".
std::string csv_rows(std::span<const double> values, std::size_t columns);

/// Format one row; missing values become empty fields.
std::string csv_row(std::span<const std::optional<double>> values);

}  // namespace plica
