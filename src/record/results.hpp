// Numbers of a finished run, read back from its directory.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace plica {

/// A table of numbers with named columns: series.csv and its like. An empty field has no value.
struct Series {
  std::vector<std::string> columns;                      // the first is time_s
  std::vector<std::vector<std::optional<double>>> rows;  // each as long as columns; times increase

  [[nodiscard]] std::optional<std::size_t> column(const std::string& name) const;

  /// A column's value at a time: of the row then, else linear between the rows around it. None outside, or where one of
  /// these rows has none.
  [[nodiscard]] std::optional<double> at(std::size_t column, double time_s) const;
};

/// FileError when the file cannot be read, or is no table that begins with time_s.
Series read_series(const std::filesystem::path& file);

/// The same of a table with several rows a time: cells.csv, midline.csv. `times_increase` asks for one row a time.
Series read_table(const std::filesystem::path& file, bool times_increase = false);

/// summary.json; null where the run has not left one (yet). FileError when it cannot be understood.
nlohmann::ordered_json read_summary(const std::filesystem::path& directory);

/// A number of it; none where there is no such number.
std::optional<double> number_of(const nlohmann::ordered_json& summary, const std::string& key);

}  // namespace plica
