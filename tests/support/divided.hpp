// Divided tissues and what must hold of them.
#pragma once

#include "mechanics/division.hpp"
#include "support/models.hpp"
#include "support/tissues.hpp"
#include "tissue/faces.hpp"

namespace plica::support {

/// The cone from the origin to a bilinear facet, um^3: facets of a closed surface add up to the volume inside.
inline double cone(const std::array<NodeId, 4>& facet, const Vectors& positions) {
  const Vec3 &a = positions[facet[0].index()], &b = positions[facet[1].index()], &c = positions[facet[2].index()],
             &d = positions[facet[3].index()];
  return (a.dot(b.cross(c)) + a.dot(c.cross(d)) + a.dot(b.cross(d)) + b.dot(c.cross(d))) / 12;
}

/// Volume inside the boundary of a one-layered tissue: apical and basal facets, and walls that no neighbour shares.
/// Nothing inside counts, so a gap or an overlap between cells makes it differ from the sum of their volumes.
inline double volume_inside_boundary(const Tissue& tissue, const Vectors& positions) {
  double volume = 0;
  for (const auto* facets : {&tissue.apical_facets, &tissue.basal_facets})
    for (const Facet& facet : *facets) volume += cone(facet.nodes, positions);
  for (const Face& face : faces_of(tissue, CellSide::lateral))
    if (!face.beyond) volume += cone(face.nodes, positions);
  return volume;
}

inline double volume_of_cells(const Tissue& tissue, const Vectors& positions) {
  double volume = 0;
  for (const Cell& cell : tissue.cells) volume += cell_volume(tissue, cell, positions);
  return volume;
}

/// Largest number of cells that meet at a vertex.
inline std::size_t most_cells_at_a_vertex(const Sheet& sheet) {
  std::map<VertexId, std::size_t> cells;
  std::size_t most = 0;
  for (const Polygon& polygon : sheet.cells)
    for (const Stop& stop : polygon.ring) most = std::max(most, ++cells[sheet.original_of(stop.vertex)]);
  return most;
}

/// A random choice of cells and walls; `part` of all cells.
inline std::vector<PlannedDivision> random_divisions(const Tissue& tissue, double part, Random& random) {
  std::vector<PlannedDivision> planned;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c)
    if (0.5 * (random.number() + 1) < part) planned.push_back({{CellId(c), random.number() > 0 ? 1 : 0}, 0, 0.5});
  return planned;
}

inline std::vector<CellCut> cuts_of(const std::vector<PlannedDivision>& planned) {
  std::vector<CellCut> cuts;
  for (const PlannedDivision& one : planned) cuts.push_back(one.cut);
  return cuts;
}

}  // namespace plica::support
