#include "tissue/files/prism_file.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace plica {
namespace {

const CellArray& array_of(const PolygonFile& file, const char* name) {
  const auto found = file.arrays.find(name);
  if (found == file.arrays.end())
    throw MeshError(
        "has no face array \"{}\"; for prisms, give each face the number of its cell in \"cell\", and 1 or "
        "0 in \"is_apical\"",
        name);
  return found->second;
}

// Basal and apical face of each cell, by its number.
using Sides = std::map<double, std::array<std::optional<std::size_t>, 2>>;

Sides sides_of(const PolygonFile& file) {
  const CellArray &cell = array_of(file, "cell"), &is_apical = array_of(file, "is_apical");
  Sides sides;
  for (std::size_t face = 0; face < file.surface.polygons.size(); ++face) {
    if (!std::isfinite(cell[face]) || (is_apical[face] != 0 && is_apical[face] != 1))
      throw MeshError("face {} is of cell {} and has is_apical {}; give a number, and 1 or 0", face, cell[face],
                      is_apical[face]);
    auto& of_side = sides[cell[face]][is_apical[face] == 1 ? 1 : 0];
    if (of_side)
      throw MeshError("cell {} has two {} faces, {} and {}; one is required", cell[face],
                      is_apical[face] == 1 ? "apical" : "basal", *of_side, face);
    of_side = face;
  }
  return sides;
}

}  // namespace

GivenPrisms prisms_in(const PolygonFile& file) {
  GivenPrisms prisms{{}, {}, file.remarks};
  std::map<std::size_t, std::size_t> column_above, column_below;  // by apical and by basal vertex
  const Sides sides = sides_of(file);
  for (const auto& [number, faces] : sides) {
    const auto& [basal, apical] = faces;
    if (!basal || !apical) throw MeshError("cell {} has no {} face", number, basal ? "apical" : "basal");
    const auto &below = file.surface.polygons[*basal], &above = file.surface.polygons[*apical];
    if (below.size() != above.size())
      throw MeshError("cell {} has {} apical and {} basal corners; each apical corner requires one basal corner",
                      number, above.size(), below.size());
    auto& corners = prisms.sheet.cells.emplace_back();
    for (std::size_t k = 0; k < above.size(); ++k) {
      const auto [column, is_new] = column_above.try_emplace(above[k], prisms.sheet.apical.size());
      if (column_below.try_emplace(below[k], column->second).first->second != column->second ||
          (!is_new && prisms.sheet.basal[column->second] != file.surface.vertices[below[k]]))
        throw MeshError(
            "corner {} of cell {} joins vertices {} and {}, but a neighbour joins one of them to another; list basal "
            "corners in the order of the apical ones, and share vertices between neighbours",
            k, number, above[k], below[k]);
      if (is_new) {
        prisms.sheet.apical.push_back(file.surface.vertices[above[k]]);
        prisms.sheet.basal.push_back(file.surface.vertices[below[k]]);
      }
      corners.push_back(column->second);
    }
  }
  for (const auto& [name, values] : file.arrays)
    if (name != "is_apical")
      for (const auto& [number, faces] : sides) prisms.arrays[name].push_back(values[*faces[1]]);
  return prisms;
}

}  // namespace plica
