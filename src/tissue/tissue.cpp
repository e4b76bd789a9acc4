#include "tissue/tissue.hpp"

namespace plica {

Vec3 cell_centre(const Cell& cell, const Vectors& positions) {
  Vec3 sum = Vec3::Zero();
  for (const NodeId node : cell.corners) sum += positions[node.index()];
  return sum / 8;
}

double cell_volume(const Tissue& tissue, const Cell& cell, const Vectors& positions) {
  double volume = 0;
  for (int e = 0; e < cell.element_count; ++e)
    volume += hex_volume(gather(positions, tissue.elements[cell.first_element.index() + e]));
  return volume;
}

}  // namespace plica
