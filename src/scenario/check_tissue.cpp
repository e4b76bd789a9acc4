#include "scenario/check_tissue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/names.hpp"
#include "measure/self_intersections.hpp"
#include "mechanics/constraints/enclosed_volume.hpp"
#include "scenario/acting.hpp"
#include "scenario/regions.hpp"
#include "scenario/words.hpp"
#include "tissue/division.hpp"
#include "tissue/faces.hpp"
#include "tissue/place.hpp"

namespace plica {
namespace {

// Checks a mesh file's apical surface, which may be open; that of a built embryo is closed.
void check_encloses(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  if (!encloses(tissue, tissue.apical_facets))
    errors.push_back(diagnostic_at(scenario, "volume.projection_surface", "the apical surface of this mesh is open",
                                   "set projection_surface to \"cells\" or \"tissue\""));
}

// Checks that the basal surface encloses a volume; the end planes of a slice count as closed.
void check_encloses_yolk(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  if (!scenario.enclosed.empty() && !EnclosedVolume::is_closed(tissue))
    errors.push_back(diagnostic_at(scenario, "enclosed." + scenario.enclosed.begin()->first,
                                   "the basal surface of this mesh is open", "remove [enclosed.NAME]"));
}

// Projection needs drag on every node: cells without an apical or basal face have inner nodes without drag.
void check_is_one_layer(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  const std::optional<CellId> inner = cell_between_layers(tissue);
  if (!inner) return;
  errors.push_back(diagnostic_at(scenario, "volume.method",
                                 fmt::format("projection requires a single layer of cells, but {} has no apical or no "
                                             "basal face, so no drag acts on its inner nodes",
                                             cell_at(tissue, *inner)),
                                 "set method to \"coupled\" or \"none\", or use one layer of cells"));
}

// Polygon corners are hanging nodes on edges of neighbours; the paper's algorithm would move them independently and
// tear the tissue.
void check_nodes_are_free(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  if (tissue.hanging.empty() || !is_as_in_the_paper(scenario)) return;
  const bool projects = method_of(scenario.volume) == VolumeMethod::projection;
  errors.push_back(
      diagnostic_at(scenario, projects ? "volume.method" : "time.scheme",
                    "the paper's algorithm supports four-sided cells only, but this tissue has polygonal cells",
                    projects ? "set method to \"coupled\" or \"none\"" : "set scheme to \"newton\""));
}

// Checks that regions have the faces a table acts on; cells between two layers have neither apical nor basal faces.
void check_faces(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  const auto check = [&](const std::string& table, const char* key, const std::string& side, const CellSet& region) {
    const auto side_meant = meaning_of(words::edges, side);
    if (side_meant == CellSide::lateral) return;
    const auto& facets = side_meant == CellSide::apical ? tissue.apical_facets : tissue.basal_facets;
    if (std::ranges::none_of(facets, [&](const Facet& facet) { return region[facet.cell.index()]; }))
      errors.push_back(diagnostic_at(
          scenario, table + ".region",
          fmt::format("no cell of this region has {} {} face", side_meant == CellSide::apical ? "an" : "a", side),
          fmt::format("set region to cells with this face, or change {}", key)));
  };
  for (const auto& [name, it] : scenario.contractions) {
    const CellSet& region = tissue.regions.at(it.region);
    check("contraction." + name, "edges", it.edges, region);
    if (!it.diagonals) continue;
    for (std::size_t c = 0; c < region.size(); ++c)
      if (region[c] && tissue.cells[c].sides() != 4) {
        errors.push_back(
            diagnostic_at(scenario, "contraction." + name + ".diagonals",
                          fmt::format("{} has {} corners, but diagonals are defined for four-sided cells only",
                                      cell_at(tissue, CellId(c)), tissue.cells[c].sides()),
                          "set diagonals to false"));
        break;
      }
  }
  for (const auto& [name, it] : scenario.cortices)
    check("cortex." + name, "faces", it.faces, tissue.regions.at(it.region));
  for (const auto& [name, it] : scenario.pressures)
    check("pressure." + name, "face", it.face, tissue.regions.at(it.region));
}

// Contact requires a reference mesh without self-intersections: otherwise the two sides cannot be distinguished.
void check_contact_at_rest(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  if (scenario.self_contact.surface == "none") return;
  const CellSet crossing = self_intersecting_cells(tissue, tissue.rest_positions);
  const auto first = std::ranges::find(crossing, true);
  if (first != crossing.end())
    errors.push_back(
        diagnostic_at(scenario, "self_contact.surface",
                      fmt::format("the reference mesh self-intersects at {}",
                                  cell_at(tissue, CellId(static_cast<std::size_t>(first - crossing.begin())))),
                      "repair the mesh, or set surface to \"none\""));
}

// Rejects two tables for one element: neither takes precedence.
void check_elasticities_apart(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  std::vector<const std::string*> owner(tissue.elements.size(), nullptr);
  for (const auto& [name, input] : scenario.region_elasticities) {
    const std::vector<bool> chosen = elements_of(input, tissue.regions.at(input.region), tissue);
    if (std::ranges::find(chosen, true) == chosen.end())
      errors.push_back(
          diagnostic_at(scenario, "elasticity." + name + ".height_percent",
                        "no element of the region has its centre in this part of the height",
                        is_of_grid(shape_of(scenario.embryo))
                            ? "widen height_percent, or increase embryo.elements_per_cell through the height"
                            : "widen height_percent, or increase embryo.layers"));
    for (std::size_t e = 0; e < chosen.size(); ++e) {
      if (!chosen[e]) continue;
      if (owner[e]) {
        const bool has_layers = input.height_percent.has_value();
        errors.push_back(
            diagnostic_at(scenario, "elasticity." + name,
                          fmt::format("overlaps elasticity.{} in {}{}", *owner[e],
                                      has_layers ? "the same layer of " : "", cell_at(tissue, tissue.element_cell[e])),
                          has_layers ? "set height_percent to disjoint ranges, or use disjoint regions"
                                     : "use disjoint regions, for example with `except`"));
        break;
      }
      owner[e] = &name;
    }
  }
}

// Checks profiles by array: the tissue has the array, with a finite value in every cell of the region.
void check_arrays(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  const auto check = [&](const std::string& tables, const auto& inputs) {
    for (const auto& [name, input] : inputs) {
      if (input.profile.shape != "array") continue;
      const std::string key = fmt::format("{}.{}.profile.array", tables, name);
      const auto array = tissue.cell_arrays.find(input.profile.array);
      if (array == tissue.cell_arrays.end()) {
        const std::vector<std::string> names = keys_of(tissue.cell_arrays);
        errors.push_back(diagnostic_at(
            scenario, key, fmt::format("the embryo has no array \"{}\"", input.profile.array),
            names.empty() ? "set embryo.cell_arrays to a table with this column, or use a file with this array"
                          : fmt::format("set array to one of: {}", fmt::join(names, ", "))));
        continue;
      }
      const CellSet& cells = tissue.regions.at(input.region);
      for (std::size_t c = 0; c < cells.size(); ++c)
        if (cells[c] && !std::isfinite(array->second[c])) {
          errors.push_back(diagnostic_at(
              scenario, key,
              fmt::format("array \"{}\" has no value in {}", input.profile.array, cell_at(tissue, CellId(c))),
              "provide a number for every cell of the region"));
          break;
        }
    }
  };
  check("contraction", scenario.contractions);
  check("cortex", scenario.cortices);
  check("pressure", scenario.pressures);
  check("elasticity", scenario.region_elasticities);
}

// Names keys that the shape has, for cells that cannot divide.
std::string how_to_divide(const Scenario& scenario, const Tissue& tissue) {
  const EmbryoInput& embryo = scenario.embryo;
  if (cell_between_layers(tissue)) return "use one layer of cells";
  if (!is_of_grid(shape_of(embryo)) && shape_of(embryo) != EmbryoShape::file)
    return "set embryo.elements to \"diagonals\" and embryo.layers to 1";
  if (embryo.elements_per_cell != EmbryoInput().elements_per_cell) return "set embryo.elements_per_cell to [1, 1, 1]";
  return "use a mesh with one element per cell";
}

// Rejects profiles that reduce the modulus of a cell to 0.
void check_moduli(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  for (const auto& [name, input] : scenario.region_elasticities) {
    const CellPattern pattern = make_pattern(input, tissue);
    for (std::size_t c = 0; c < tissue.cells.size(); ++c)
      if (pattern.cells[c] && !(pattern.strengths[c] > 1e-6)) {
        errors.push_back(diagnostic_at(scenario, "elasticity." + name + ".profile",
                                       fmt::format("the modulus of {} would be 0", cell_at(tissue, CellId(c))),
                                       "set profile.edge or profile.factor above 0"));
        break;
      }
  }
}

void check_holds(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  for (const auto& [name, input] : scenario.holds)
    if (std::ranges::none_of(held_nodes(input, tissue), [](bool is_held) { return is_held; }))
      errors.push_back(diagnostic_at(scenario, "hold." + name, "no node of the region lies in these ranges",
                                     "widen x_um, y_um or z_um; `plica mesh` writes the positions of nodes"));
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
  check_faces(scenario, tissue, errors);
  check_contact_at_rest(scenario, tissue, errors);
  check_elasticities_apart(scenario, tissue, errors);
  check_arrays(scenario, tissue, errors);
  if (errors.empty()) check_moduli(scenario, tissue, errors);
  check_holds(scenario, tissue, errors);
  if (const auto why = why_indivisible(tissue); why && !scenario.divisions.empty())
    errors.push_back(diagnostic_at(scenario, "division." + scenario.divisions.begin()->first,
                                   "the cells of this embryo cannot divide: " + *why, how_to_divide(scenario, tissue)));
  if (scenario.volume.projection_surface == "embryo") check_encloses(scenario, tissue, errors);
  check_encloses_yolk(scenario, tissue, errors);
  if (method_of(scenario.volume) == VolumeMethod::projection) check_is_one_layer(scenario, tissue, errors);
  check_nodes_are_free(scenario, tissue, errors);
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
