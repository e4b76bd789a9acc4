// [stop]: bounds on monitors that end a run, combined by any or all.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measure/monitor.hpp"

namespace plica {

/// A bound on one monitor, in the unit of its column. With both bounds, a value must lie between them.
struct Criterion {
  enum class Over { number, any, all };  // the monitor's number; one of its nodes or cells suffices; every one

  std::string name;
  std::size_t monitor = 0;      // its place among the monitors
  std::optional<double> above;  // met by larger values
  std::optional<double> below;  // met by smaller ones
  Over over = Over::number;

  /// What has no value meets nothing.
  [[nodiscard]] bool is_met(const Reading& reading) const;
};

/// When a run is over. Without criteria it never is.
struct StopRule {
  std::vector<Criterion> criteria;
  bool all = false;         // else any one suffices
  bool needs_rest = false;  // with `all`: the body must be at equilibrium, too

  /// Names of the criteria that are met; readings are those of the monitors.
  [[nodiscard]] std::vector<std::string> met(std::span<const Reading> readings) const;
  [[nodiscard]] bool is_over(std::size_t met_count, bool at_equilibrium) const;
};

}  // namespace plica
