// [volume], [vitelline] and [dynamics]: conserved volumes, membrane, drag and inertia. setup.cpp adds them to a model.
#include "scenario/tables/table.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

void check_shell_drag(const Scenario& scenario, Input& input) {
  const std::string key = "vitelline.drag_Pa_s_per_um";
  if (scenario.vitelline.drag_Pa_s_per_um == 0 || !input.sound(key) || !input.sound("vitelline.enabled")) return;
  if (!scenario.vitelline.enabled)
    input.report(key, "is not used without a vitelline membrane",
                 is_patch(shape_of(scenario.embryo)) ? "remove drag_Pa_s_per_um"
                                                     : "remove drag_Pa_s_per_um, or set enabled to true");
  else if (is_as_in_the_paper(scenario))
    input.report(key, "requires time.scheme \"newton\" and a volume.method other than \"projection\"",
                 "remove drag_Pa_s_per_um, or change time.scheme or volume.method");
}

void check_vitelline(Scenario& scenario, Input& input) {
  const EmbryoShape shape = shape_of(scenario.embryo);
  const bool may_be_open = is_patch(shape) || shape == EmbryoShape::surface || shape == EmbryoShape::prisms;
  if (!may_be_open || !input.sound("vitelline.enabled")) return;
  // The file determines whether its cells are a closed layer.
  if (input.place("vitelline.enabled") == nullptr) scenario.vitelline.enabled = false;
  if (scenario.vitelline.enabled && is_patch(shape))
    input.report("vitelline.enabled",
                 fmt::format("a vitelline membrane requires a closed embryo, but a {} is open", scenario.embryo.shape),
                 "set enabled to false");
}

void check_dynamics(Scenario& scenario, Input& input) {
  const DynamicsInput& dynamics = scenario.dynamics;
  if (!input.sound("dynamics.surface_drag_Pa_s_per_um") || !input.sound("dynamics.density_kg_per_m3")) return;
  if (dynamics.surface_drag_Pa_s_per_um == 0 && dynamics.density_kg_per_m3 == 0)
    input.report("dynamics.surface_drag_Pa_s_per_um", "drag and density are both 0",
                 "set surface_drag_Pa_s_per_um or density_kg_per_m3 above 0");
}

using V = VolumeInput;

void check_paper(const Scenario& scenario, Input& input) {
  if (!input.sound("time.scheme") || !input.sound("volume.method") || !input.sound("embryo.shape")) return;
  if (scenario.time.scheme == "linearly-implicit" && method_of(scenario.volume) == VolumeMethod::coupled)
    input.report("time.scheme",
                 "\"linearly-implicit\" does not support volume constraints (volume.method is \"coupled\")",
                 "set volume.method to \"projection\" or \"none\", or scheme to \"newton\"");
  if (!scenario.divisions.empty() && is_as_in_the_paper(scenario))
    input.report(method_of(scenario.volume) == VolumeMethod::projection ? "volume.method" : "time.scheme",
                 "the paper's algorithm does not support division",
                 "set volume.method to \"coupled\" or \"none\" and time.scheme to \"newton\", or remove [division]");
  if (scenario.volume.projection_surface == "embryo" && is_patch(shape_of(scenario.embryo)) &&
      input.sound("volume.projection_surface"))
    input.report("volume.projection_surface", fmt::format("the apical surface of a {} is open", scenario.embryo.shape),
                 "set projection_surface to \"cells\" or \"tissue\"");
}

void check_volume(Scenario& scenario, Input& input) {
  VolumeInput& volume = scenario.volume;
  if (method_of(volume) != VolumeMethod::projection) {
    const std::string chooser = "volume.method", choice = "projection";
    drop_unless_chosen(volume, &V::projection_surface, "volume.projection_surface", chooser, choice, input);
    drop_unless_chosen(volume, &V::projection_weights, "volume.projection_weights", chooser, choice, input);
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

}  // namespace

ScenarioTable volume_table() {
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

ScenarioTable vitelline_table() {
  ScenarioTable info{"vitelline", "Vitelline membrane.", "Surroundings"};
  const auto row = key_rows("vitelline", &Scenario::vitelline);
  info.rows = {
      row("enabled", &VitellineInput::enabled, anything,
          "Rigid membrane around a closed embryo (unilateral constraint); default false for a block, sheet, surface, "
          "or open mesh of shape `file`."),
      row("gap_um", &VitellineInput::gap_um, not_negative, "Perivitelline gap above the apical nodes at t = 0 (µm)."),
      row("drag_Pa_s_per_um", &VitellineInput::drag_Pa_s_per_um, not_negative,
          "Viscous drag on apical nodes that slide along the membrane (Pa s/µm); 0 from 0.1 µm away."),
  };
  info.rules = [](Scenario& scenario, Input& input) {
    check_vitelline(scenario, input);
    check_shell_drag(scenario, input);
  };
  return info;
}

ScenarioTable dynamics_table() {
  using D = DynamicsInput;
  ScenarioTable info{"dynamics", "Drag, viscosity and inertia; drag and density must not both be 0.",
                     "Passive mechanics"};
  const auto row = key_rows("dynamics", &Scenario::dynamics);
  info.rows = {
      row("surface_drag_Pa_s_per_um", &D::surface_drag_Pa_s_per_um, not_negative,
          "Viscous drag on apical and basal faces (Pa s/µm); sets the time scale."),
      row("shear_viscosity_Pa_s", &D::shear_viscosity_Pa_s, not_negative, "Kelvin–Voigt viscosity of cells (Pa s)."),
      row("density_kg_per_m3", &D::density_kg_per_m3, not_negative, "Density (kg/m³): inertia, negligible in vivo."),
  };
  info.rules = check_dynamics;
  return info;
}

}  // namespace plica
