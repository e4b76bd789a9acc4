// [volume], and what the paper's algorithm does not support. setup.cpp adds the constraints to a model.
#include "scenario/tables/table.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace of_volume {

void refuse_with_paper(const Scenario& scenario, Input& input) {
  const auto refuse = [&](const std::string& key, std::string_view what, std::string_view remedy) {
    if (input.sound(key))
      input.report(
          key, fmt::format("the paper's algorithm does not support {}", what),
          fmt::format("{}, or set time.scheme to \"newton\" and volume.method to \"coupled\" or \"none\"", remedy));
  };
  if (!scenario.embryo.mirror.empty()) refuse("embryo.mirror", "mirror planes", "remove mirror");
  if (!scenario.embryo.periodic.empty()) refuse("embryo.periodic", "periodic sheets", "remove periodic");
  if (scenario.vitelline.drag_Pa_s_per_um > 0)
    refuse("vitelline.drag_Pa_s_per_um", "drag along the membrane", "remove drag_Pa_s_per_um");
  for (const auto& [name, enclosed] : scenario.enclosed)
    if (enclosed.volume == "held")
      refuse("enclosed." + name + ".volume", "a held volume", "set volume to \"compliant\"");
  if (scenario.self_contact.surface != "none")
    refuse("self_contact.surface", "self-contact", "set surface to \"none\"");
  for (const auto& [name, growth] : scenario.growths) refuse("growth." + name, "growth", "remove [growth]");
  // What changes the tissue is an aim, so the algorithm is named as what is wrong.
  const std::string algorithm =
      method_of(scenario.volume) == VolumeMethod::projection ? "volume.method" : "time.scheme";
  if (!scenario.divisions.empty()) refuse(algorithm, "division", "remove [division]");
  if (scenario.exchange.below_um) refuse(algorithm, "exchange of neighbours", "remove [exchange]");
}

void check_paper(const Scenario& scenario, Input& input) {
  if (!input.sound("time.scheme") || !input.sound("volume.method") || !input.sound("embryo.shape")) return;
  if (scenario.time.scheme == "linearly-implicit" && method_of(scenario.volume) == VolumeMethod::coupled)
    input.report("time.scheme",
                 "\"linearly-implicit\" does not support volume constraints (volume.method is \"coupled\")",
                 "set volume.method to \"projection\" or \"none\", or scheme to \"newton\"");
  if (is_as_in_the_paper(scenario)) refuse_with_paper(scenario, input);
  if (scenario.volume.projection_surface == "embryo" && is_patch(shape_of(scenario.embryo)) &&
      input.sound("volume.projection_surface"))
    input.report("volume.projection_surface", fmt::format("the apical surface of a {} is open", scenario.embryo.shape),
                 "set projection_surface to \"cells\" or \"tissue\"");
}

void check_volume(Scenario& scenario, Input& input) {
  VolumeInput& volume = scenario.volume;
  if (method_of(volume) != VolumeMethod::projection) {
    const std::string chooser = "volume.method", choice = "projection";
    drop_unless_chosen(volume, &VolumeInput::projection_surface, "volume.projection_surface", chooser, choice, input);
    drop_unless_chosen(volume, &VolumeInput::projection_weights, "volume.projection_weights", chooser, choice, input);
  }
  check_paper(scenario, input);
}

// Checks a mesh file's apical surface, which may be open; that of a built embryo is closed.
void check_encloses(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  if (!encloses(tissue, tissue.apical_facets))
    errors.push_back(diagnostic_at(scenario, "volume.projection_surface", "the apical surface of this mesh is open",
                                   "set projection_surface to \"cells\" or \"tissue\""));
}

// Projection needs drag on every node: cells without an apical or basal face have inner nodes without drag.
void check_is_one_layer(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  const std::optional<CellId> inner = cell_between_layers(tissue);
  if (!inner) return;
  errors.push_back(diagnostic_at(scenario, "volume.method",
                                 fmt::format("projection requires a single layer of cells, but {} has no apical or no "
                                             "basal face, so no drag acts on its inner nodes",
                                             cell_at(tissue, *inner)),
                                 "set method to \"coupled\" or \"none\", or use one layer of cells"));
}

// Polygon corners are hanging nodes on edges of neighbours; the paper's algorithm would move them independently and
// tear the tissue.
void check_nodes_are_free(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  if (tissue.hanging.empty() || !is_as_in_the_paper(scenario)) return;
  const bool projects = method_of(scenario.volume) == VolumeMethod::projection;
  errors.push_back(
      diagnostic_at(scenario, projects ? "volume.method" : "time.scheme",
                    "the paper's algorithm supports four-sided cells only, but this tissue has polygonal cells",
                    projects ? "set method to \"coupled\" or \"none\"" : "set scheme to \"newton\""));
}

void check_surfaces(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  if (scenario.volume.projection_surface == "embryo") check_encloses(scenario, tissue, errors);
  if (method_of(scenario.volume) == VolumeMethod::projection) check_is_one_layer(scenario, tissue, errors);
  check_nodes_are_free(scenario, tissue, errors);
}

}  // namespace of_volume

ScenarioTable volume_table() {
  using namespace of_volume;
  ScenarioTable info{"volume", "Conservation of cell volume.", "Passive mechanics"};
  const auto row = key_rows("volume", &Scenario::volume);
  info.rows = {
      row("method", &VolumeInput::method, one_of(words::volume_methods),
          "`coupled`: equality constraints in each step. `projection`: the paper's projection after each step, so that "
          "the equilibrium depends on the step. `none`: not conserved."),
      row("projection_surface", &VolumeInput::projection_surface, one_of(words::projection_surfaces),
          "Surfaces whose volume is projected: of each cell, of the tissue, or the apical one with the lumen inside."),
      row("projection_weights", &VolumeInput::projection_weights, one_of(words::projection_weights),
          "Node displacement along the volume gradient: equal (the paper), or by mobility (drag and mass), which "
          "approaches `coupled` for short steps."),
  };
  info.rules = check_volume;
  info.check = check_surfaces;
  return info;
}

}  // namespace plica
