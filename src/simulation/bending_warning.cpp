#include "simulation/bending_warning.hpp"

#include <fmt/format.h>

#include "measure/bending_error.hpp"
#include "scenario/finer_mesh.hpp"

namespace plica {
std::string bending_warning(const Scenario& scenario, const Simulation& simulation) {
  const RunStatus status = simulation.status();
  if (status == RunStatus::failed || status == RunStatus::under_way) return "";
  const Model& model = simulation.model();
  const int elements = elements_through_height(model.tissue);
  // With one element, the depth errs 1 to 4.6 times as much as bending, with two 1 to 1.3 times
  // (docs/developers/convergence.md).
  const double error = bending_error(model, simulation.state().positions).value_or(0), of_depth = 5 * error / elements;
  constexpr double worth_telling = 0.15;
  if (of_depth < worth_telling) return "";
  return fmt::format(
      "with {} through the height, bending is uncertain by about {:.0f} % at these strains, and the depth by up to "
      "about {:.0f} %; compare with {}",
      elements == 1 ? "one element" : fmt::format("{} elements", elements), 100 * error, 100 * of_depth,
      finer_mesh(scenario, elements));
}

}  // namespace plica
