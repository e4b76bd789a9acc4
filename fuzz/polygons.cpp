#include <array>

#include "targets.hpp"
#include "tissue/files/polygon_file.hpp"
#include "tissue/hexahedral_mesh.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace plica {
namespace {

void require(bool holds) {
  if (!holds) __builtin_trap();
}

/// Guarantees of build_under_surface.
void check(const Tissue& tissue, const PolygonFile& file) {
  require(tissue.cells.size() == file.surface.polygons.size());
  for (const Vec3& position : tissue.rest_positions) require(position.allFinite());
  for (const auto& element : tissue.elements)
    for (const NodeId node : element) require(node.valid() && node.index() < tissue.node_count());
}

}  // namespace

bool fuzz_polygons(std::string_view bytes) try {
  if (bytes.empty()) return false;
  const char kind = bytes.front();
  bytes.remove_prefix(1);
  const PolygonFile file = kind == 'o'   ? polygons_in_obj(bytes)
                           : kind == 'f' ? polygons_in_off(bytes)
                                         : polygons_in_ply(bytes);
  for (const auto& [name, values] : file.arrays) require(values.size() == file.surface.polygons.size());
  // Few bytes with repeated corners can make surfaces that take long.
  if (file.surface.polygons.size() > 500 || file.surface.vertices.size() > 2000) return true;
  check(build_under_surface({.surface = file.surface}, {.height_um = 0.2}).tissue, file);
  return true;
} catch (const MeshError&) {
  return false;
}

}  // namespace plica
