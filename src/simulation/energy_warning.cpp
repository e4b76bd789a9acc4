#include "simulation/energy_warning.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "measure/cells.hpp"

namespace plica {
namespace {

constexpr double tolerated = 0.01;  // part of the energy
constexpr int few_steps = 10;

double sum_of_norms(const Vectors& forces) {
  double sum = 0;
  for (const Vec3& force : forces) sum += force.norm();
  return sum;
}

// Whether an acting law pulls at t = 0, or jumps later: steps then start again from the first length, of first order
// and without an estimate of their error.
bool starts_abruptly(const Simulation& simulation) {
  const Model& model = simulation.model();
  if (std::ranges::any_of(simulation.controls().program_jumps_s, [&](double s) { return s < simulation.time_s(); }))
    return true;
  const State at_rest = rest_state(model);
  constexpr double gentle = 0.01;  // part of the present force
  return std::ranges::any_of(model.laws, [&](const auto& law) {
    return pattern_of(*law) != nullptr && sum_of_norms(forces_of_law(model, at_rest, *law)) >
                                              gentle * sum_of_norms(forces_of_law(model, simulation.state(), *law));
  });
}

// Keys to change. The error is of the scheme's order in the steps, whose length grows as tolerance^(1/(order + 1))
// where the tolerance limits it; a large one does not.
std::vector<std::string> remedies(const Simulation& simulation, double imbalance) {
  const RunControls &controls = simulation.controls(), usual;
  const bool is_first_order = controls.scheme.order == TimeOrder::first;
  const double part = 0.8 * tolerated / imbalance;
  std::vector<std::string> changes;
  const auto set = [&](const char* key, double value) { changes.push_back(fmt::format("{} to {:.1g}", key, value)); };
  if (controls.scheme.forces != StepScheme::Forces::newton && controls.fixed_step_s) {
    set("time.step_s", part * *controls.fixed_step_s);
    return changes;
  }
  if (controls.fixed_step_s) changes.emplace_back("time.step_s to \"adaptive\"");
  const double tolerance_um = std::min(controls.position_tolerance_um, usual.position_tolerance_um);
  if (starts_abruptly(simulation)) {
    set("time.first_step_s", 0.5 * part * std::min(controls.first_step_s, usual.first_step_s));
    set("time.tolerance_um", tolerance_um / 3);
  }
  if (is_first_order && controls.scheme.forces == StepScheme::Forces::newton && simulation.model().masses().empty())
    changes.emplace_back("time.integrator to \"bdf2\"");
  else if (changes.empty())
    set("time.tolerance_um", tolerance_um * std::pow(part, is_first_order ? 2 : 1.5));
  return changes;
}

}  // namespace

std::string energy_warning(const Simulation& simulation) {
  const RunStatus status = simulation.status();
  if (status == RunStatus::failed || status == RunStatus::under_way) return "";
  if (simulation.steps() < (status == RunStatus::equilibrium ? 2 : few_steps)) return "";
  if (simulation.controls().scheme.projection) return "";
  EnergyFlow sum;
  for (const EnergyFlow& flow : simulation.energies()) sum += flow;
  const double missing = sum.active - sum.stored - sum.dissipated;
  const double imbalance = std::abs(missing) / std::max({sum.active, std::abs(sum.stored), std::abs(sum.dissipated)});
  if (sum.active <= 0 || imbalance <= tolerated) return "";
  return fmt::format("time steps {} {:.2g} % of the energy (energy_imbalance_ratio {:.2g}); set {}",
                     missing > 0 ? "lose" : "add", 100 * imbalance, missing / sum.active,
                     fmt::join(remedies(simulation, imbalance), " and "));
}

}  // namespace plica
