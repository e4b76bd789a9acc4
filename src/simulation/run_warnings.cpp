#include "simulation/run_warnings.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/units.hpp"
#include "simulation/bending_warning.hpp"
#include "simulation/energy_warning.hpp"

namespace plica {
namespace {

std::string equilibrium_warning(const Simulation& simulation) {
  if (simulation.status() != RunStatus::equilibrium || simulation.steps() != 1) return "";
  return fmt::format(
      "equilibrium after the first step: no node is faster than stop.equilibrium_speed_um_per_min ({:g}); lower it, "
      "increase the forces or reduce the drag",
      simulation.controls().equilibrium_speed_um_per_s * units::minute);
}

}  // namespace

std::vector<RunWarning> run_warnings(const Scenario& scenario, const Simulation& simulation) {
  std::vector<RunWarning> warnings;
  const auto add = [&](const char* topic, std::string text) {
    if (!text.empty()) warnings.push_back({topic, std::move(text)});
  };
  add("energy_imbalance", energy_warning(simulation));
  add("equilibrium", equilibrium_warning(simulation));
  add("bending", bending_warning(scenario, simulation));
  return warnings;
}

}  // namespace plica
