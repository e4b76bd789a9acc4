#include "measure/stop_rule.hpp"

#include <algorithm>

namespace plica {

bool Criterion::is_met(const Reading& reading) const {
  const auto beyond = [&](double value) { return (!above || value > *above) && (!below || value < *below); };
  if (over == Over::number) return reading.number && beyond(*reading.number);
  if (over == Over::any) return std::ranges::any_of(reading.values, beyond);
  return !reading.values.empty() && std::ranges::all_of(reading.values, beyond);
}

std::vector<std::string> StopRule::met(std::span<const Reading> readings) const {
  std::vector<std::string> names;
  for (const Criterion& criterion : criteria)
    if (criterion.is_met(readings[criterion.monitor])) names.push_back(criterion.name);
  return names;
}

bool StopRule::is_over(std::size_t met_count, bool at_equilibrium) const {
  if (criteria.empty()) return false;
  if (!all) return met_count > 0;
  return met_count == criteria.size() && (at_equilibrium || !needs_rest);
}

}  // namespace plica
