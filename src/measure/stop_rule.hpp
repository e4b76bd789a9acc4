// Stop criteria ([stop]): bounds on monitors, combined by any or all.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measure/monitor.hpp"

namespace plica {

/// Bounds on one monitor, in the unit of its column; with both, a value must lie between them.
struct Criterion {
  enum class Over { number, any, all };  // the monitor's number; at least one of its nodes or cells; all of them

  std::string name;
  std::size_t monitor = 0;      // index among the monitors
  std::optional<double> above;  // met by larger values
  std::optional<double> below;  // met by smaller ones
  Over over = Over::number;

  /// Whether the reading meets the bounds; false without a value.
  [[nodiscard]] bool is_met(const Reading& reading) const;
};

/// Rule that ends a run; never without criteria.
struct StopRule {
  std::vector<Criterion> criteria;
  bool all = false;         // else one suffices
  bool needs_rest = false;  // with `all`: requires equilibrium, too

  /// Names of the criteria met by the readings of the monitors.
  [[nodiscard]] std::vector<std::string> met(std::span<const Reading> readings) const;
  [[nodiscard]] bool is_over(std::size_t met_count, bool at_equilibrium) const;
};

}  // namespace plica
