#include "record/run_scenario.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "mechanics/obstacles/vitelline.hpp"
#include "scenario/load.hpp"
#include "scenario/words.hpp"

namespace plica {

std::optional<Scenario> scenario_of_run(const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / "scenario.toml";
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return {};
  try {
    return load_scenario({"scenario", file.string(), read_file(file)});
  } catch (const ScenarioError&) {
    return {};
  }
}

Scenario as_begun(Scenario scenario, const std::filesystem::path& directory) {
  const std::optional<Scenario> before = scenario_of_run(directory);
  if (!before) return scenario;
  if (!scenario.given_at.contains("elasticity.corner_barrier_Pa"))
    scenario.elasticity.corner_barrier_Pa = before->elasticity.corner_barrier_Pa;
  if (!scenario.given_at.contains("time.integrator")) scenario.time.integrator = before->time.integrator;
  return scenario;
}

std::optional<Capsule> shell_of_run(const Scenario& scenario, const Vectors& rest_positions) {
  const EmbryoInput& embryo = scenario.embryo;
  const EmbryoShape shape = shape_of(embryo);
  if (!scenario.vitelline.enabled || is_patch(shape)) return {};
  if (!is_of_grid(shape) && shape != EmbryoShape::file) return {};  // the shell touches the apical surface
  const double radius = embryo.diameter_um / 2,
               half_axis = shape_of(embryo) == EmbryoShape::pill    ? embryo.length_um / 2 - radius
                           : shape_of(embryo) == EmbryoShape::slice ? embryo.length_um / 2
                                                                    : 0;
  Capsule shell =
      shape_of(embryo) == EmbryoShape::file ? enclosing_capsule(rest_positions) : Capsule{half_axis, radius};
  shell.radius_um += scenario.vitelline.gap_um;
  return shell;
}

}  // namespace plica
