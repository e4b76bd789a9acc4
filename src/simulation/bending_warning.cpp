#include "simulation/bending_warning.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "measure/bending_error.hpp"

namespace plica {

std::string bending_warning(const Simulation& simulation) {
  constexpr double worth_telling = 0.05;
  const Model& model = simulation.model();
  const double error = bending_error(model, simulation.state().positions).value_or(0);
  if (error < worth_telling) return "";
  const int elements = elements_through_height(model.tissue);
  const bool is_grid = std::ranges::all_of(model.tissue.cells, &Cell::is_of_grid);
  const std::string more = is_grid ? fmt::format("embryo.elements_per_cell = [1, 1, {}]", 2 * elements)
                                   : fmt::format("embryo.layers = {}", 2 * elements);
  return fmt::format(
      "with {} through the height, bending is uncertain by about {:.0f} % at these strains, and so is the depth; "
      "compare "
      "with {}",
      elements == 1 ? "one element" : fmt::format("{} elements", elements), 100 * error, more);
}

}  // namespace plica
