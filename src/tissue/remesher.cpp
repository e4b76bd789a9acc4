#include "tissue/remesher.hpp"

#include <algorithm>
#include <cmath>

#include "tissue/division.hpp"
#include "tissue/mesher.hpp"
#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

constexpr double least_quality = 0.02;  // scaled Jacobian of new elements

std::vector<Vec3> corners_of(const Tissue& tissue, CellId cell, std::span<const Vec3> positions) {
  std::vector<Vec3> corners;
  for (const std::size_t level : {std::size_t{0}, tissue.sheet.level_count(cell)})
    for (const Stop& stop : tissue.sheet.cells[cell.index()].ring)
      corners.push_back(place_of(tissue, stop.vertex, level, positions));
  return corners;
}

}  // namespace

const std::vector<NodeId>& column(const Sheet& sheet, VertexId vertex) {
  return sheet.vertices[sheet.original_of(vertex).index()].nodes;
}

Vec3 shift_of(const Tissue& tissue, VertexId vertex) {
  const auto& [x, y, z] = tissue.sheet.vertices[vertex.index()].periods;
  return tissue.period.cwiseProduct(Vec3(x, y, z));
}

Vec3 place_of(const Tissue& tissue, VertexId vertex, std::size_t level, std::span<const Vec3> positions) {
  return positions[column(tissue.sheet, vertex)[level].index()] + shift_of(tissue, vertex);
}

Remesher::Remesher(Tissue& tissue, Vectors& positions, const Unstretch& unstretch)
    : tissue_(tissue), sheet_(tissue.sheet), positions_(positions), unstretch_(unstretch) {}

void Remesher::begin(std::span<const CellId> cells, std::span<const VertexId> columns) {
  polygons_.clear();
  places_.clear();
  for (const CellId cell : cells)
    if (cell.valid()) polygons_.emplace_back(cell, sheet_.cells[cell.index()]);
  for (const VertexId vertex : columns)
    for (const NodeId node : column(sheet_, vertex)) places_.emplace_back(node, positions_[node.index()]);
}

bool Remesher::finish() {
  for (const auto& [cell, before] : polygons_)
    for (Stop& stop : sheet_.cells[cell.index()].ring) stop.at = 0;
  if (std::ranges::all_of(polygons_, [&](const auto& one) { return take_split(one.first); })) return true;
  for (auto& [cell, before] : polygons_) sheet_.cells[cell.index()] = std::move(before);
  for (const auto& [node, place] : places_) positions_[node.index()] = place;
  return false;
}

VertexId Remesher::image(VertexId original, const std::array<int, 3>& periods) {
  if (periods == std::array<int, 3>{}) return original;
  const auto known = std::ranges::find_if(
      sheet_.vertices, [&](const Vertex& vertex) { return vertex.original == original && vertex.periods == periods; });
  if (known != sheet_.vertices.end()) return VertexId(static_cast<std::size_t>(known - sheet_.vertices.begin()));
  const std::size_t levels = sheet_.vertices[original.index()].nodes.size();
  sheet_.vertices.push_back({std::vector<NodeId>(levels), original, periods});
  return VertexId(sheet_.vertices.size() - 1);
}

bool Remesher::take_split(CellId cell) {
  const std::vector<Vec3> now = corners_of(tissue_, cell, positions_);
  std::vector<Vec3> rest = now;
  for (Vec3& corner : rest) corner = unstretch_(cell) * corner;
  const auto quality = [&](const std::vector<OutlineQuad>& split) {
    return std::min(worst_part(prism_of(now), split), worst_part(prism_of(rest), split));
  };
  Polygon& polygon = sheet_.cells[cell.index()];
  polygon.quadrilaterals = best_split(corners_of_polygon(polygon.ring.size()), quality);
  return quality(polygon.quadrilaterals) > least_quality;
}

void complete_remeshed(Tissue& tissue, const TissueChange& change, const Unstretch& unstretch,
                       const std::vector<double>& volumes, Vectors& positions) {
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    if (!change.remeshed[c]) continue;
    tissue.cells[c].rest_shape = corners_of(tissue, CellId(c), positions);
    for (Vec3& corner : tissue.cells[c].rest_shape) corner = unstretch(change.origin[c]) * corner;
  }
  complete(tissue, change);
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    if (!change.remeshed[c]) continue;
    Cell& cell = tissue.cells[c];
    const double factor = std::cbrt(volumes[change.origin[c].index()] / rest_volume(tissue, cell));
    for (Vec3& corner : cell.rest_shape) corner *= factor;
    set_element_rest_shapes(tissue, CellId(c));
  }
  positions.resize(tissue.node_count(), Vec3::Zero());
  tissue.place_hanging_positions(positions);
}

}  // namespace plica
