#include "output/run_shell.hpp"

namespace plica {

std::optional<Capsule> shell_of(const Scenario& scenario, const Vectors& rest_positions) {
  const EmbryoInput& embryo = scenario.embryo;
  if (!scenario.vitelline.enabled || embryo.shape == "block") return {};
  const double radius = embryo.diameter_um / 2, half_axis = embryo.shape == "pill" ? embryo.length_um / 2 - radius : 0;
  Capsule shell = embryo.shape == "file" ? enclosing_capsule(rest_positions) : Capsule{half_axis, radius};
  shell.radius_um += scenario.vitelline.gap_um;
  return shell;
}

}  // namespace plica
