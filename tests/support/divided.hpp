// Divided tissues and what must hold of them.
#pragma once

#include <algorithm>
#include <map>
#include <set>

#include "mechanics/division.hpp"
#include "support/models.hpp"
#include "support/tissues.hpp"

namespace plica::support {

/// Volume inside the boundary: over the faces of elements that no other element has, the cone from the origin to each.
/// At a hanging node a whole face and its parts all count, in opposite directions, and cancel.
inline double volume_inside_boundary(const Tissue& tissue, const Vectors& positions) {
  std::map<std::array<NodeId, 4>, std::array<NodeId, 4>> faces;
  for (const auto& element : tissue.elements)
    for (const auto& corners : hex_faces) {
      std::array<NodeId, 4> face{}, key{};
      for (int i = 0; i < 4; ++i) face[i] = key[i] = element[corners[i]];
      std::sort(key.begin(), key.end());
      if (!faces.emplace(key, face).second) faces.erase(key);
    }
  double volume = 0;
  for (const auto& [key, face] : faces) {
    std::array<Vec3, 4> x;
    for (int i = 0; i < 4; ++i) x[i] = positions[face[i].index()];
    const auto& [a, b, c, d] = x;
    volume += (a.dot(b.cross(c)) + a.dot(c.cross(d)) + a.dot(b.cross(d)) + b.dot(c.cross(d))) / 12;
  }
  return volume;
}

inline double volume_of_cells(const Tissue& tissue, const Vectors& positions) {
  double volume = 0;
  for (const Cell& cell : tissue.cells) volume += cell_volume(tissue, cell, positions);
  return volume;
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
