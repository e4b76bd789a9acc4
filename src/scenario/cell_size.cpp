#include "scenario/cell_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario/words.hpp"

namespace plica {
namespace {

constexpr double least_um = 1, most_um = 100;

bool is_of_a_cell(double size_um) { return size_um >= least_um && size_um <= most_um; }

double median_width_um(const Tissue& tissue) {
  std::vector<double> areas = apical_areas(tissue, tissue.rest_positions);
  std::erase(areas, 0.0);  // cells between two layers
  if (areas.empty()) return least_um;
  std::ranges::nth_element(areas, areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2));
  return std::sqrt(areas[areas.size() / 2]);
}

// A unit, if one fits, or else the power of ten nearest to 10 um.
double factor_for(double width_um) {
  for (const double unit : {1e3, 1e-3, 1e6, 1e-4, 1e4, 1e-6})
    if (is_of_a_cell(unit * width_um)) return unit;
  return std::pow(10, std::round(1 - std::log10(width_um)));
}

}  // namespace

std::string unit_warning(const EmbryoInput& embryo, const Tissue& tissue) {
  if (!is_from_file(shape_of(embryo))) return "";
  const double width_um = median_width_um(tissue);
  if (is_of_a_cell(width_um)) return "";
  const double factor = factor_for(width_um);
  return fmt::format(
      "embryo.scale: cells of the file are {:.3g} um wide (median), but coordinates are read in um; if they have "
      "another unit, set embryo.scale = [{:g}, {:g}, {:g}]",
      width_um, factor * embryo.scale[0], factor * embryo.scale[1], factor * embryo.scale[2]);
}

}  // namespace plica
