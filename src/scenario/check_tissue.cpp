#include "scenario/check_tissue.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "measure/self_intersections.hpp"
#include "mechanics/constraints/enclosed_volume.hpp"
#include "scenario/acting.hpp"
#include "scenario/regions.hpp"
#include "scenario/words.hpp"
#include "solver/projection/closed_surface.hpp"
#include "tissue/division.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

// A mesh file's apical surface may be open; that of a built embryo is not.
void check_encloses(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  if (!ClosedSurface(tissue.apical_facets).is_closed())
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
                                 fmt::format("a projection needs one layer of cells, and cell {} has no apical or no "
                                             "basal face: nothing slows the nodes between cells above each other",
                                             inner->number()),
                                 "give \"coupled\" or \"none\", or one layer of cells"));
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
                                       fmt::format("cell {} has {} corners; which diagonals contract is told for four",
                                                   c, tissue.cells[c].sides()),
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
    errors.push_back(diagnostic_at(scenario, "self_contact.surface",
                                   fmt::format("the mesh passes through itself at rest, at cell {}",
                                               CellId(static_cast<std::size_t>(first - crossing.begin())).number()),
                                   "mend the mesh, or give \"none\""));
}

// Where two tables speak of one cell, nobody knows which is meant.
void check_elasticities_apart(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors) {
  std::vector<const std::string*> spoken_of(tissue.cells.size(), nullptr);
  for (const auto& [name, input] : scenario.region_elasticities) {
    const CellSet& cells = tissue.regions.at(input.region);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (!cells[c]) continue;
      if (spoken_of[c]) {
        errors.push_back(diagnostic_at(scenario, "elasticity." + name,
                                       fmt::format("elasticity.{} speaks of cell {}, too", *spoken_of[c], c),
                                       "give them regions without common cells, by `except` for instance"));
        break;
      }
      spoken_of[c] = &name;
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
                                     fmt::format("the mesh would be inverted: cell {} is inside out or flat at rest",
                                                 tissue.element_cell[e].number()),
                                     "take more cells, or flatter ones"));
      return;
    }
}

void check_tissue(const Scenario& scenario, const Tissue& tissue) {
  std::vector<Diagnostic> errors;
  check_faces(scenario, tissue, errors);
  check_contact_at_rest(scenario, tissue, errors);
  check_elasticities_apart(scenario, tissue, errors);
  check_holds(scenario, tissue, errors);
  if (const auto why = why_indivisible(tissue); why && !scenario.divisions.empty())
    errors.push_back(diagnostic_at(scenario, "division." + scenario.divisions.begin()->first,
                                   "the cells of this embryo cannot divide: " + *why,
                                   "take one element a cell and one layer of cells"));
  if (scenario.volume.projection_surface == "embryo") check_encloses(scenario, tissue, errors);
  check_encloses_yolk(scenario, tissue, errors);
  if (method_of(scenario.volume) == VolumeMethod::projection) check_is_one_layer(scenario, tissue, errors);
  if (!errors.empty()) throw ScenarioError(std::move(errors));
}

}  // namespace plica
