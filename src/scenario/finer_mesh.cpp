#include "scenario/finer_mesh.hpp"

#include <fmt/format.h>

#include "scenario/words.hpp"

namespace plica {

std::string finer_mesh(const Scenario& scenario, int elements) {
  if (!scenario.divisions.empty()) return "runs of this mesh only (cells that divide have one element)";
  const EmbryoShape shape = shape_of(scenario.embryo);
  if (shape == EmbryoShape::file) return fmt::format("a mesh of {} elements through the height", 2 * elements);
  if (!is_of_grid(shape)) return fmt::format("embryo.layers = {}", 2 * elements);
  const auto& [along, across, high] = scenario.embryo.elements_per_cell;
  return fmt::format("embryo.elements_per_cell = [{}, {}, {}]", along, across, 2 * high);
}

}  // namespace plica
