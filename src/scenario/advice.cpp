#include "scenario/advice.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tissue/mesh_quality.hpp"

namespace plica {

std::vector<std::string> advice(const Scenario& scenario, const Model& model) {
  std::vector<std::string> lines;
  const auto warn = [&](std::string text) { lines.push_back("warning: " + std::move(text)); };
  const auto note = [&](std::string text) { lines.push_back("note: " + std::move(text)); };

  const bool pulls = std::ranges::any_of(scenario.contractions, [](const auto& entry) {
    return entry.second.stiffness_nN_per_um > 0 || entry.second.preload_nN > 0;
  });
  if (!pulls && scenario.pressures.empty())
    warn("nothing pushes or pulls: without [contraction] or [pressure] the embryo stays at rest");
  for (const auto& [name, contraction] : scenario.contractions)
    if (!contraction.program.activity.empty() && std::ranges::max(contraction.program.activity) == 0)
      warn(fmt::format("contraction.{}: its program is 0 at every point", name));
  for (const auto& [name, contraction] : scenario.contractions)
    if (!contraction.program.time_s.empty() && contraction.program.time_s.back() > scenario.time.end_s)
      warn(fmt::format("contraction.{}: its program goes on after the run's end at {} s", name, scenario.time.end_s));
  if (scenario.time.step_s && *scenario.time.step_s > scenario.time.end_s)
    warn("time.step_s is longer than the whole run");
  if (scenario.volume.method == "coupled")
    note(
        "every cell's volume is held exactly, so Poisson's ratio sets only the shear modulus and how far parts of a "
        "cell "
        "may swell at each other's cost");
  if (scenario.volume.method == "projection") {
    note("volumes are projected after the forces: where the embryo comes to rest depends on time.step_s");
    if (!scenario.time.step_s && scenario.volume.projection_weights == "equal")
      warn(
          "where a projection with equal weights comes to rest moves with the step's length, so adaptive steps chase "
          "it "
          "and stay short; give time.step_s a number");
  }
  if (model.vitelline && scenario.vitelline.gap_um > 0)
    note(fmt::format("the embryo starts {} um away from its shell", scenario.vitelline.gap_um));

  if (model.vitelline && scenario.embryo.shape == "file")
    note(fmt::format("the shell is the capsule along x around the mesh, {:.4g} um long and {:.4g} um across",
                     2 * (model.vitelline->shell().half_axis_um + model.vitelline->shell().radius_um),
                     2 * model.vitelline->shell().radius_um));

  const MeshQuality quality = mesh_quality(model.tissue, model.tissue.rest_positions);
  note(fmt::format(
      "{} cells, {} elements, {} nodes; cell volume {:.0f} to {:.0f} um3, apical area {:.0f} to {:.0f} um2",
      model.tissue.cells.size(), model.tissue.elements.size(), model.tissue.node_count(), quality.volume_um3.min,
      quality.volume_um3.max, quality.apical_area_um2.min, quality.apical_area_um2.max));
  if (quality.min_scaled_jacobian < 0.2)
    warn(fmt::format("the worst element has a scaled Jacobian of {:.2f} (1 is a brick): results near it are poor",
                     quality.min_scaled_jacobian));
  return lines;
}

}  // namespace plica
