#include "simulation/bending_warning.hpp"

#include <fmt/format.h>

#include "measure/bending_error.hpp"
#include "scenario/finer_mesh.hpp"

namespace plica {
std::string bending_warning(const Scenario& scenario, const Simulation& simulation) {
  const RunStatus status = simulation.status();
  if (status == RunStatus::failed || status == RunStatus::under_way) return "";
  constexpr double worth_telling = 0.05;
  const Model& model = simulation.model();
  const double error = bending_error(model, simulation.state().positions).value_or(0);
  if (error < worth_telling) return "";
  const int elements = elements_through_height(model.tissue);
  return fmt::format(
      "with {} through the height, bending is uncertain by about {:.0f} % at these strains, and so is the depth; "
      "compare with {}",
      elements == 1 ? "one element" : fmt::format("{} elements", elements), 100 * error,
      finer_mesh(scenario, elements));
}

}  // namespace plica
