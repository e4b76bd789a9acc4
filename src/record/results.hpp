// Results of a finished run, read from its directory.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "scenario/scenario.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Table of numbers with named columns, as series.csv. Empty fields are missing values.
struct Series {
  std::vector<std::string> columns;                      // the first is time_s
  std::vector<std::vector<std::optional<double>>> rows;  // each as long as columns; times increase

  [[nodiscard]] std::optional<std::size_t> column(const std::string& name) const;

  /// Value of a column at a time, interpolated linearly between rows. Empty outside, or if a neighbouring value is
  /// missing.
  [[nodiscard]] std::optional<double> at(std::size_t column, double time_s) const;
};

/// Read a time series. Throws FileError for an unreadable file, one larger than `most_bytes`, or a table whose first
/// column is not time_s.
Series read_series(const std::filesystem::path& file, std::uintmax_t most_bytes = largest_file_read_bytes);

/// Read summary.json; null if missing. Throws FileError for damaged content.
nlohmann::ordered_json read_summary(const std::filesystem::path& directory);

/// Number of a summary; empty if missing.
std::optional<double> number_of(const nlohmann::ordered_json& summary, const std::string& key);

/// Load scenario.toml of a run; empty if it is missing or of an incompatible version.
std::optional<Scenario> scenario_of_run(const std::filesystem::path& directory);

/// Returns the scenario with which to resume the run in a directory: values that neither file nor overrides set and
/// that are chosen automatically stay as the run began, whichever version chose them.
Scenario as_begun(Scenario scenario, const std::filesystem::path& directory);

/// Vitelline membrane of a run around the reference positions of nodes (um); empty if it has none.
std::optional<Capsule> shell_of_run(const Scenario& scenario, const Vectors& rest_positions);

}  // namespace plica
