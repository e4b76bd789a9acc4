#include "tissue/place.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/tissue.hpp"

namespace plica {
namespace {

std::string cell_text(std::size_t cell, const Vec3& middle) {
  return fmt::format("cell {} at {}", cell, place_text(middle));
}

}  // namespace

std::string place_text(const Vec3& place) {
  const auto rounded = [](double x) { return std::abs(x) < 1e-9 ? 0 : x; };
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) um", rounded(place.x()), rounded(place.y()), rounded(place.z()));
}

std::string cell_at(const Tissue& tissue, CellId cell) {
  return cell_text(cell.index(), cell_centre(tissue.cells[cell.index()], tissue.rest_positions));
}

std::string cell_at(const HexahedralMesh& mesh, std::size_t cell) {
  Vec3 middle = Vec3::Zero();
  for (const NodeId node : mesh.cells[cell]) middle += mesh.points[node.index()] / 8;
  return cell_text(cell, middle);
}

}  // namespace plica
