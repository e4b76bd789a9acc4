// Formulas over the numbers of a run, as "vce_speed_um_per_s@900 / vml_speed_um_per_s@900".
//
// NAME is a number of summary.json, NAME@TIME a column of series.csv at a time (s, or the name of a number of
// summary.json), interpolated; after the end of the run, its last value. Between spaces: + - * /; also ( ), max(A,
// ...), min(A, ...) and rank_correlation(A, ...), Spearman's, of values with their order. Over the rows of series.csv,
// whose columns are then NAMEs: first(A > B, ...), the first time at which all conditions begin to hold; largest(A, B >
// C, ...) and least(...), of A where all conditions hold. A value is missing if a part of it is, or if it is not
// finite.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "record/results.hpp"

namespace plica {

struct RunNumbers {
  nlohmann::ordered_json summary;  // null if missing
  Series series;
};

class Formula {
 public:
  /// Part of a formula: its value, at a row of the series in functions over rows.
  using Part = std::function<std::optional<double>(const RunNumbers&, std::optional<std::size_t> row)>;
  /// Where a name must be known.
  enum class Source { summary, series, either };

  Formula() = default;
  /// Parse a formula; `named`: formulas that it may use by name. Throws std::invalid_argument with the problem.
  explicit Formula(const std::string& text, const std::map<std::string, Formula>& named = {});

  [[nodiscard]] std::optional<double> value(const RunNumbers& run) const { return part_(run, {}); }
  /// Names of numbers used, each with its source.
  [[nodiscard]] const std::vector<std::pair<std::string, Source>>& uses() const { return uses_; }
  [[nodiscard]] bool uses_series() const;

 private:
  friend class FormulaParser;
  Part part_;
  std::vector<std::pair<std::string, Source>> uses_;
};

}  // namespace plica
