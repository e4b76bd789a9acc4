#include "scenario/abrupt_loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scenario/acting.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

// The axis along which a region ends inside the tissue, by most of the walls at its border; empty if it does not.
std::optional<std::string> axis_of_border(const Tissue& tissue, const CellSet& region) {
  const auto neighbours = wall_neighbours(tissue);
  std::array<int, 2> walls = {0, 0};
  for (std::size_t c = 0; c < region.size(); ++c)
    for (const CellId other : neighbours[c]) {
      if (!region[c] || region[other.index()]) continue;
      const Vec3 way = cell_centre(tissue.cells[other.index()], tissue.rest_positions) -
                       cell_centre(tissue.cells[c], tissue.rest_positions);
      ++walls[std::abs(way.x()) > std::hypot(way.y(), way.z()) ? 0 : 1];
    }
  if (walls[0] + walls[1] == 0) return std::nullopt;
  return walls[0] > walls[1] ? "along" : "across";
}

// Distance from the middle of the region to its border along an axis: that of the farthest centre and half a cell.
double half_width_um(const ActingInput& input, const Tissue& tissue, const std::string& axis) {
  constexpr double far_um = 1e6;
  ActingInput linear = input;
  linear.profile.shape = "linear";
  linear.profile.axis = axis;
  linear.profile.half_width_um = far_um;
  linear.variation.spread = 0;
  const CellPattern pattern = make_pattern(linear, tissue);
  double farthest = 0, volume = 0, height = 0;
  for (std::size_t c = 0; c < pattern.cells.size(); ++c) {
    if (!pattern.cells[c]) continue;
    farthest = std::max(farthest, (1 - pattern.strengths[c]) * far_um);
    const Cell& cell = tissue.cells[c];
    volume += cell_volume(tissue, cell, tissue.rest_positions);
    for (std::size_t i = 0; i < cell.sides(); ++i)
      height += (tissue.rest_positions[cell.apical_corners()[i].index()] -
                 tissue.rest_positions[cell.basal_corners()[i].index()])
                    .norm() /
                static_cast<double>(cell.sides());
  }
  return farthest + 0.5 * std::sqrt(volume / height);
}

}  // namespace

std::vector<std::string> abrupt_loads(const Scenario& scenario, const Tissue& tissue) {
  std::vector<std::string> warnings;
  for (const Acting& acting : acting_tables(scenario)) {
    const ActingInput& input = acting.input;
    if (!acting.is_constant || !input.profile.shape.empty()) continue;
    const auto axis = axis_of_border(tissue, tissue.regions.at(input.region));
    if (!axis) continue;
    warnings.push_back(fmt::format(
        "{0}: a constant tension ends at full strength at the border of region {1}, so depth has no limit under "
        "refinement; set {0}.profile = {{ shape = \"linear\", axis = \"{2}\", half_width_um = {3:.3g} }}",
        acting.table, input.region, *axis, half_width_um(input, tissue, *axis)));
  }
  return warnings;
}

}  // namespace plica
