#include "simulation/bending_warning.hpp"

#include <fmt/format.h>

#include "measure/bending_error.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

// Twice as many elements through the height, by the key that this scenario has.
std::string finer_mesh(const Scenario& scenario, int elements) {
  if (!scenario.divisions.empty()) return "runs of this mesh only (cells that divide have one element)";
  const EmbryoShape shape = shape_of(scenario.embryo);
  if (shape == EmbryoShape::file) return fmt::format("a mesh of {} elements through the height", 2 * elements);
  if (!is_of_grid(shape)) return fmt::format("embryo.layers = {}", 2 * elements);
  const auto& [along, across, high] = scenario.embryo.elements_per_cell;
  return fmt::format("embryo.elements_per_cell = [{}, {}, {}]", along, across, 2 * high);
}

}  // namespace

std::string bending_warning(const Scenario& scenario, const Simulation& simulation) {
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
