// [vitelline] and [dynamics]: membrane, drag and inertia. setup.cpp adds them to a model.
#include "scenario/tables/table.hpp"

namespace plica {
namespace of_surroundings {

void check_shell_drag(const Scenario& scenario, Input& input) {
  const std::string key = "vitelline.drag_Pa_s_per_um";
  if (scenario.vitelline.drag_Pa_s_per_um == 0 || !input.sound(key) || !input.sound("vitelline.enabled")) return;
  if (!scenario.vitelline.enabled)
    input.report(key, "is not used without a vitelline membrane",
                 is_patch(shape_of(scenario.embryo)) ? "remove drag_Pa_s_per_um"
                                                     : "remove drag_Pa_s_per_um, or set enabled to true");
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

}  // namespace of_surroundings

ScenarioTable vitelline_table() {
  using namespace of_surroundings;
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
  using namespace of_surroundings;
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
