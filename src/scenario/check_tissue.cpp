#include "scenario/check_tissue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/names.hpp"
#include "measure/self_intersections.hpp"
#include "mechanics/constraints/enclosed_volume.hpp"
#include "scenario/acting.hpp"
#include "scenario/materials.hpp"
#include "scenario/regions.hpp"
#include "scenario/words.hpp"
#include "tissue/division.hpp"
#include "tissue/faces.hpp"
#include "tissue/place.hpp"

namespace plica {
namespace {

// A mesh file's apical surface may be open; that of a built embryo is not.
void check_encloses(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  if (!encloses(tissue, tissue.apical_facets))
    errors.push_back(diagnostic_at(scenario, "volume.projection_surface",
                                   "the apical surface of this mesh encloses nothing", "give \"cells\" or \"tissue\""));
}

// The same of a basal surface and the yolk; the planes at a slice's ends close it, too.
void check_encloses_yolk(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  if (!scenario.enclosed.empty() && !EnclosedVolume::is_closed(tissue))
    errors.push_back(diagnostic_at(scenario, "enclosed." + scenario.enclosed.begin()->first,
                                   "the basal surface of this mesh encloses nothing", "remove the table"));
}

// Cells without an apical or a basal face have nodes inside that no drag slows, and a projection throws them about.
void check_is_one_layer(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  const std::optional<CellId> inner = cell_between_layers(tissue);
  if (!inner) return;
  errors.push_back(diagnostic_at(scenario, "volume.method",
                                 fmt::format("a projection needs one layer of cells, and {} has no apical or no "
                                             "basal face: nothing slows the nodes between cells above each other",
                                             cell_at(tissue, *inner)),
                                 "give \"coupled\" or \"none\", or one layer of cells"));
}

// Corners of polygons lie on edges of their neighbours: the paper's algorithm moves them by themselves, and tears the
// tissue there.
void check_nodes_are_free(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  if (tissue.hanging.empty() || !is_as_in_the_paper(scenario)) return;
  const bool projects = method_of(scenario.volume) == VolumeMethod::projection;
  errors.push_back(diagnostic_at(scenario, projects ? "volume.method" : "time.scheme",
                                 "the paper's algorithm knows cells of four sides only, and this tissue has polygons",
                                 projects ? "give \"coupled\" or \"none\"" : "give \"newton\""));
}

// What acts on faces needs cells that have them: those between two layers have none.
void check_faces(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  const auto check = [&](const std::string& table, const char* key, const std::string& side, const CellSet& region) {
    const auto side_meant = meaning_of(words::edges, side);
    if (side_meant == CellSide::lateral) return;
    const auto& facets = side_meant == CellSide::apical ? tissue.apical_facets : tissue.basal_facets;
    if (std::ranges::none_of(facets, [&](const Facet& facet) { return region[facet.cell.index()]; }))
      errors.push_back(diagnostic_at(
          scenario, table + ".region",
          fmt::format("no cell of this region has {} {} face", side_meant == CellSide::apical ? "an" : "a", side),
          fmt::format("name a region on that side, or give other {}", key)));
  };
  for (const auto& [name, it] : scenario.contractions) {
    const CellSet& region = tissue.regions.at(it.region);
    check("contraction." + name, "edges", it.edges, region);
    if (!it.diagonals) continue;
    for (std::size_t c = 0; c < region.size(); ++c)
      if (region[c] && tissue.cells[c].sides() != 4) {
        errors.push_back(diagnostic_at(scenario, "contraction." + name + ".diagonals",
                                       fmt::format("{} has {} corners; which diagonals contract is told for four",
                                                   cell_at(tissue, CellId(c)), tissue.cells[c].sides()),
                                       "give false"));
        break;
      }
  }
  for (const auto& [name, it] : scenario.cortices)
    check("cortex." + name, "faces", it.faces, tissue.regions.at(it.region));
  for (const auto& [name, it] : scenario.pressures)
    check("pressure." + name, "face", it.face, tissue.regions.at(it.region));
}

// Contact keeps sides apart that lie apart: which side is which cannot be told where they are mixed from the start.
void check_contact_at_rest(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  if (scenario.self_contact.surface == "none") return;
  const CellSet crossing = self_intersecting_cells(tissue, tissue.rest_positions);
  const auto first = std::ranges::find(crossing, true);
  if (first != crossing.end())
    errors.push_back(
        diagnostic_at(scenario, "self_contact.surface",
                      fmt::format("the mesh passes through itself at rest, at {}",
                                  cell_at(tissue, CellId(static_cast<std::size_t>(first - crossing.begin())))),
                      "mend the mesh, or give \"none\""));
}

// Where two tables speak of one cell, nobody knows which is meant.
void check_elasticities_apart(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  std::vector<const std::string*> spoken_of(tissue.elements.size(), nullptr);
  for (const auto& [name, input] : scenario.region_elasticities) {
    const std::vector<bool> chosen = elements_of(input, tissue.regions.at(input.region), tissue);
    if (std::ranges::find(chosen, true) == chosen.end())
      errors.push_back(diagnostic_at(scenario, "elasticity." + name + ".height_percent",
                                     "no element of the region has its middle in this part of the height",
                                     is_of_grid(shape_of(scenario.embryo))
                                         ? "widen it, or give embryo.elements_per_cell more elements through the height"
                                         : "widen it, or give more embryo.layers"));
    for (std::size_t e = 0; e < chosen.size(); ++e) {
      if (!chosen[e]) continue;
      if (spoken_of[e]) {
        const bool has_layers = input.height_percent.has_value();
        errors.push_back(
            diagnostic_at(scenario, "elasticity." + name,
                          fmt::format("elasticity.{} speaks of {}{}, too", *spoken_of[e],
                                      has_layers ? "the same layer of " : "", cell_at(tissue, tissue.element_cell[e])),
                          has_layers ? "give them parts of the height without common elements, or other regions"
                                     : "give them regions without common cells, by `except` for instance"));
        break;
      }
      spoken_of[e] = &name;
    }
  }
}

// Profiles by an array: of the tissue, with numbers in every cell that acts.
void check_arrays(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  const auto check = [&](const std::string& tables, const auto& inputs) {
    for (const auto& [name, input] : inputs) {
      if (input.profile.shape != "array") continue;
      const std::string key = fmt::format("{}.{}.profile.array", tables, name);
      const auto array = tissue.cell_arrays.find(input.profile.array);
      if (array == tissue.cell_arrays.end()) {
        const std::vector<std::string> names = keys_of(tissue.cell_arrays);
        errors.push_back(
            diagnostic_at(scenario, key, fmt::format("the embryo has no array \"{}\"", input.profile.array),
                          names.empty() ? "it has none: arrays come with cells about points, or from a mesh file"
                                        : fmt::format("it has {}", fmt::join(names, ", "))));
        continue;
      }
      const CellSet& cells = tissue.regions.at(input.region);
      for (std::size_t c = 0; c < cells.size(); ++c)
        if (cells[c] && !std::isfinite(array->second[c])) {
          errors.push_back(diagnostic_at(
              scenario, key,
              fmt::format("array \"{}\" has no number in {}", input.profile.array, cell_at(tissue, CellId(c))),
              "give every cell of the region one"));
          break;
        }
    }
  };
  check("contraction", scenario.contractions);
  check("cortex", scenario.cortices);
  check("pressure", scenario.pressures);
  check("elasticity", scenario.region_elasticities);
}

// A modulus that a profile takes to 0 leaves cells without any.
void check_moduli(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  for (const auto& [name, input] : scenario.region_elasticities) {
    const CellPattern pattern = make_pattern(input, tissue);
    for (std::size_t c = 0; c < tissue.cells.size(); ++c)
      if (pattern.cells[c] && !(pattern.strengths[c] > 1e-6)) {
        errors.push_back(diagnostic_at(scenario, "elasticity." + name + ".profile",
                                       fmt::format("the modulus of {} would be 0", cell_at(tissue, CellId(c))),
                                       "give profile.edge, or factors, above 0"));
        break;
      }
  }
}

void check_holds(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  for (const auto& [name, input] : scenario.holds)
    if (std::ranges::none_of(held_nodes(input, tissue), [](bool is_held) { return is_held; }))
      errors.push_back(diagnostic_at(scenario, "hold." + name, "no node of the region lies in its ranges",
                                     "widen x_um, y_um or z_um; see `plica mesh` for where nodes lie"));
}

}  // namespace

// A mesh may be so coarse, thick or short that cells turn inside out where it is bent most.
void check_rest_shape(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    if (!(hex_scaled_jacobian(tissue.element_rest_shape[e]) > 0)) {
      const bool has_grid = is_of_grid(shape_of(scenario.embryo));
      errors.push_back(diagnostic_at(scenario, has_grid ? "embryo.cells" : "embryo.cell_height_um",
                                     fmt::format("the mesh would be inverted: {} is inside out or flat at rest",
                                                 cell_at(tissue, tissue.element_cell[e])),
                                     has_grid ? "take more cells, or flatter ones"
                                              : "give a smaller height, or a surface that is bent less there"));
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
                                   "the cells of this embryo cannot divide: " + *why,
                                   "take one element a cell and one layer of cells"));
  if (scenario.volume.projection_surface == "embryo") check_encloses(scenario, tissue, errors);
  check_encloses_yolk(scenario, tissue, errors);
  if (method_of(scenario.volume) == VolumeMethod::projection) check_is_one_layer(scenario, tissue, errors);
  check_nodes_are_free(scenario, tissue, errors);
  if (!errors.empty()) throw ScenarioError(std::move(errors));
}

}  // namespace plica
