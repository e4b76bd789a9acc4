#include "scenario/check_tissue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario/acting.hpp"
#include "scenario/regions.hpp"
#include "scenario/schema.hpp"
#include "scenario/words.hpp"
#include "tissue/faces.hpp"
#include "tissue/place.hpp"

namespace plica {
namespace {

// Checks that regions have the faces a table acts on; cells between two layers have neither apical nor basal faces.
void check_faces(const Scenario& scenario, const Acting& acting, const Tissue& tissue,
                 std::vector<Diagnostic>& errors) {
  const CellSide side = meaning_of(words::edges, acting.input.faces);
  if (acting.faces_key.empty() || side == CellSide::lateral) return;
  const CellSet& region = tissue.regions.at(acting.input.region);
  const auto& facets = side == CellSide::apical ? tissue.apical_facets : tissue.basal_facets;
  if (std::ranges::none_of(facets, [&](const Facet& facet) { return region[facet.cell.index()]; }))
    errors.push_back(diagnostic_at(
        scenario, acting.table + ".region",
        fmt::format("no cell of this region has {} {} face", side == CellSide::apical ? "an" : "a", acting.input.faces),
        fmt::format("set region to cells with this face, or change {}", acting.faces_key)));
}

// Checks profiles by array: the tissue has the array, with a finite value in every cell of the region.
void check_array(const Scenario& scenario, const Acting& acting, const Tissue& tissue,
                 std::vector<Diagnostic>& errors) {
  const std::string& name = acting.input.profile.array;
  if (acting.input.profile.shape != "array") return;
  const std::string key = acting.table + ".profile.array";
  if (!tissue.cell_arrays.contains(name)) {
    errors.push_back(no_array(scenario, key, name, tissue));
    return;
  }
  const CellSet& cells = tissue.regions.at(acting.input.region);
  const CellArray& values = tissue.cell_arrays.at(name);
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (cells[c] && !std::isfinite(values[c])) {
      errors.push_back(diagnostic_at(scenario, key,
                                     fmt::format("array \"{}\" has no value in {}", name, cell_at(tissue, CellId(c))),
                                     "provide a number for every cell of the region"));
      return;
    }
}

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

// Coarse, thick or short meshes have inverted cells where curvature is highest.
void check_rest_shape(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    if (!(hex_scaled_jacobian(tissue.element_rest_shape[e]) > 0)) {
      const bool has_grid = is_of_grid(shape_of(scenario.embryo));
      const std::string doubt = unit_warning(scenario.embryo, tissue);
      errors.push_back(diagnostic_at(scenario, has_grid ? "embryo.cells" : "embryo.cell_height_um",
                                     fmt::format("the mesh is invalid: {} is inverted or flat in the reference state",
                                                 cell_at(tissue, tissue.element_cell[e])),
                                     has_grid ? "increase cells, or reduce cell_height_um"
                                     : doubt.empty()
                                         ? "reduce cell_height_um, or use a surface with a lower curvature there"
                                         : doubt));
      return;
    }
}

void check_tissue(const Scenario& scenario, const Tissue& tissue) {
  std::vector<Diagnostic> errors;
  const std::vector<Acting> acting = acting_tables(scenario);
  for (const Acting& one : acting) check_faces(scenario, one, tissue, errors);
  for (const Acting& one : acting) check_array(scenario, one, tissue, errors);
  for (const ScenarioTable& table : scenario_tables())
    if (table.check) table.check(scenario, tissue, errors);
  if (!errors.empty()) throw ScenarioError(std::move(errors));
}

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
