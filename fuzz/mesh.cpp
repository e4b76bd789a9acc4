#include "targets.hpp"
#include "tissue/files/child_reading.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {
namespace {

void require(bool holds) {
  if (!holds) __builtin_trap();
}

/// Guarantees of tissue_from_mesh.
void check(const Tissue& tissue) {
  require(!tissue.cells.empty() && tissue.element_cell.size() == tissue.elements.size());
  for (const Vec3& position : tissue.rest_positions) require(position.allFinite());
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    require(tissue.element_cell[e].index() < tissue.cells.size());
    for (const NodeId node : tissue.elements[e]) require(node.valid() && node.index() < tissue.node_count());
    require(hex_scaled_jacobian(tissue.element_rest_shape[e]) > 0);
  }
}

}  // namespace

bool fuzz_mesh(std::string_view bytes) try {
  if (bytes.empty()) return false;
  const int across = 1 + (bytes.front() & 3), radial = 1 + (bytes.front() >> 2 & 3);
  bytes.remove_prefix(1);
  check(tissue_from_mesh(from_bytes<HexahedralMesh>(bytes), {across, across, radial}));
  return true;
} catch (const MeshError&) {
  return false;
}

}  // namespace plica
