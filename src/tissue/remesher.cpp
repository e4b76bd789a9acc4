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

// Scaled Jacobian of the worst element of a cell.
double worst_element(const Tissue& tissue, const Cell& cell, std::span<const Vec3> positions) {
  double worst = 1;
  for (int e = 0; e < cell.element_count; ++e)
    worst = std::min(worst, hex_scaled_jacobian(gather(positions, tissue.elements[cell.first_element.index() + e])));
  return worst;
}

struct Split {
  std::vector<OutlineQuad> quadrilaterals;
  double quality;  // scaled Jacobian of the worst element, at present or in the rest shape
};

// The best one of a cell all of whose stops are corners.
Split split_of(const Tissue& tissue, CellId cell, std::span<const Vec3> positions, const Unstretch& unstretch) {
  const std::vector<Vec3> now = corners_of(tissue, cell, positions);
  std::vector<Vec3> rest = now;
  const Mat3 map = unstretch(cell);
  for (Vec3& corner : rest) corner = map * corner;
  const auto quality = [&](const std::vector<OutlineQuad>& split) {
    return std::min(worst_part(prism_of(now), split), worst_part(prism_of(rest), split));
  };
  std::vector<OutlineQuad> best = best_split(corners_of_polygon(now.size() / 2), quality);
  const double its = quality(best);
  return {std::move(best), its};
}

void make_corners(Polygon& polygon) {
  for (Stop& stop : polygon.ring) stop.at = 0;
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
  for (const auto& [cell, before] : polygons_) make_corners(sheet_.cells[cell.index()]);
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
  Split split = split_of(tissue_, cell, positions_, unstretch_);
  sheet_.cells[cell.index()].quadrilaterals = std::move(split.quadrilaterals);
  return split.quality > least_quality;
}

std::vector<double> rest_volumes(const Tissue& tissue) {
  std::vector<double> volumes;
  for (const Cell& cell : tissue.cells) volumes.push_back(rest_volume(tissue, cell));
  return volumes;
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

std::vector<CellId> badly_split(const Tissue& tissue, std::span<const Vec3> positions) {
  constexpr double bad = 0.05;  // scaled Jacobian
  std::vector<CellId> cells;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c)
    if (worst_element(tissue, tissue.cells[c], positions) < bad) cells.emplace_back(c);
  return cells;
}

bool gains_by_split(const Tissue& tissue, CellId cell, std::span<const Vec3> positions, const Unstretch& unstretch) {
  const double worst = worst_element(tissue, tissue.cells[cell.index()], positions);
  return split_of(tissue, cell, positions, unstretch).quality > std::max(least_quality, 2 * worst);
}

TissueChange split_again(Tissue& tissue, std::span<const CellId> cells, Vectors& positions,
                         const Unstretch& unstretch) {
  TissueChange change = no_change(tissue);
  change.remeshed.assign(tissue.cells.size(), false);
  const std::vector<double> volumes = rest_volumes(tissue);
  for (const CellId cell : cells) {
    Polygon& polygon = tissue.sheet.cells[cell.index()];
    make_corners(polygon);
    polygon.quadrilaterals = split_of(tissue, cell, positions, unstretch).quadrilaterals;
    change.remeshed[cell.index()] = true;
  }
  complete_remeshed(tissue, change, unstretch, volumes, positions);
  return change;
}

}  // namespace plica
