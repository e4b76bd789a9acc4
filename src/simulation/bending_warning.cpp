#include "simulation/bending_warning.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "measure/bending_error.hpp"
#include "scenario/finer_mesh.hpp"

namespace plica {
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

}  // namespace plica
