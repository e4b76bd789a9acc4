#include "simulation/run_warnings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units.hpp"
#include "measure/bending_error.hpp"
#include "measure/cells.hpp"
#include "measure/self_intersections.hpp"
#include "scenario/advice.hpp"

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
    return law->pattern() != nullptr && sum_of_norms(forces_of_law(model, at_rest, *law)) >
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

std::string equilibrium_warning(const Simulation& simulation) {
  if (simulation.status() != RunStatus::equilibrium || simulation.steps() != 1) return "";
  return fmt::format(
      "equilibrium after the first step: no node is faster than stop.equilibrium_speed_um_per_min ({:g}); lower it, "
      "increase the forces or reduce the drag",
      simulation.controls().equilibrium_speed_um_per_s * units::minute);
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

std::string bending_warning(const Scenario& scenario, const Simulation& simulation) {
  const RunStatus status = simulation.status();
  if (status == RunStatus::failed || status == RunStatus::under_way) return "";
  const Model& model = simulation.model();
  const int elements = elements_through_height(model.tissue);
  // Measured, not derived (docs/developers/convergence.md): with one element the depth erred up to 4.6 times as much as
  // bending and by 18 % at most, with several less.
  constexpr double most_of_depth = 0.2, worth_telling = 0.15;
  const double error = bending_error(model, simulation.state().positions).value_or(0);
  const double of_depth = std::max(error, std::min(5 * error / elements, most_of_depth));
  if (of_depth < worth_telling) return "";
  return fmt::format(
      "with {} through the height, bending is uncertain by about {:.0f} % at these strains, and the depth by up to "
      "about {:.0f} %; compare with {}",
      elements == 1 ? "one element" : fmt::format("{} elements", elements), 100 * error, 100 * of_depth,
      finer_mesh(scenario, elements));
}

std::string crossing_warning(const Scenario& scenario, const Simulation& simulation) {
  const Tissue& tissue = simulation.model().tissue;
  const Vectors& positions = simulation.state().positions;
  for (const auto& [side, facets] : {std::pair("apical", &tissue.apical_facets), {"basal", &tissue.basal_facets}}) {
    const auto pairs = crossing_facets(*facets, positions);
    if (pairs.empty()) continue;
    const Facet &one = (*facets)[pairs.front().first], &other = (*facets)[pairs.front().second];
    Vec3 place = Vec3::Zero();
    for (const NodeId node : one.nodes) place += positions[node.index()] / 4;
    const auto id = [&](const Facet& facet) { return tissue.cells[facet.cell.index()].lineage.id; };
    return fmt::format(
        "the tissue self-intersects: at t = {:.4g} min {} faces of cells {} and {} cross at x = {:.1f}, y = {:.1f}, "
        "z = {:.1f} um ({} pairs in all); later results are unphysical{}",
        simulation.time_s() / units::minute, side, id(one), id(other), place.x(), place.y(), place.z(), pairs.size(),
        crossing_remedy(scenario));
  }
  return "";
}

std::string crossing_remedy(const Scenario& scenario) {
  // The rim of an open tissue is no contact surface.
  return scenario.self_contact.surface == "both"
             ? ""
             : "; set self_contact.surface to \"both\" to prevent it (except at the rim of an open tissue)";
}

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
