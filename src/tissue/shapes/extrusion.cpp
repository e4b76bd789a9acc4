#include "tissue/shapes/extrusion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "tissue/mesh_input.hpp"

namespace plica {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<std::vector<std::size_t>> polygons_at_vertices(const PolygonSurface& polygons) {
  std::vector<std::vector<std::size_t>> about(polygons.vertices.size());
  for (std::size_t p = 0; p < polygons.polygons.size(); ++p)
    for (const std::size_t vertex : polygons.polygons[p]) about[vertex].push_back(p);
  return about;
}

// Least squares for the depth below the tangent plane, a u + b v + (e u^2 + 2 f u v + g v^2) / 2. The slopes a and b
// take up what the normal is wrong by. Where the vertices do not fix all of them, few ones or some on a conic, the
// flattest one.
double least_radius(const Vec3& at, const Vec3& normal, const Vectors& others) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  double size = 0;
  for (const Vec3& other : others) size = std::max(size, (other - at).norm());
  if (!(size > 0)) return infinity;
  const auto count = static_cast<Eigen::Index>(others.size());
  Eigen::MatrixXd rows(count, 5);
  Eigen::VectorXd depths(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vec3 way = (others[static_cast<std::size_t>(i)] - at) / size;
    const double x = way.dot(u), y = way.dot(v);
    rows.row(i) << x, y, 0.5 * x * x, x * y, 0.5 * y * y;
    depths[i] = -way.dot(normal);
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposed;
  decomposed.setThreshold(1e-3);  // on a conic nearly, rounding would be taken for curvature
  decomposed.compute(rows);
  const Eigen::VectorXd fit = decomposed.solve(depths);
  const double mean = 0.5 * (fit[2] + fit[4]), half = 0.5 * (fit[2] - fit[4]);
  const double curvature = mean + std::sqrt(half * half + fit[3] * fit[3]);
  return curvature > 1e-9 ? size / curvature : infinity;
}

// `height` where it is well below `bound`, and never more than that: smooth to the second derivative.
double bounded_height(double height, double bound) {
  constexpr double free_share = 0.7;
  const double share = height / bound;
  if (share <= free_share) return height;
  return bound * (free_share + (1 - free_share) * std::tanh((share - free_share) / (1 - free_share)));
}

void check_heights(const PolygonSurface& polygons, std::span<const double> heights_um) {
  if (heights_um.size() != 1 && heights_um.size() != polygons.polygons.size())
    throw MeshError("{} heights for {} cells; give one, or one per cell", heights_um.size(), polygons.polygons.size());
  for (std::size_t i = 0; i < heights_um.size(); ++i)
    if (!(heights_um[i] > 0) || !std::isfinite(heights_um[i]))
      throw MeshError("the height of row {} is {:.4g} um; heights must be positive", i, heights_um[i]);
}

// Whether a part of the basal face, about its middle, is turned over or nearly so, seen along the apical normal.
bool is_folded(const PrismSheet& sheet, const std::vector<std::size_t>& cell) {
  constexpr double least_share = 0.05;  // of the apical part above
  const Vec3 normal = area_vector(sheet.apical, cell).normalized();
  Vec3 apical_middle = Vec3::Zero(), basal_middle = Vec3::Zero();
  for (const std::size_t vertex : cell) {
    apical_middle += sheet.apical[vertex] / static_cast<double>(cell.size());
    basal_middle += sheet.basal[vertex] / static_cast<double>(cell.size());
  }
  for (std::size_t k = 0; k < cell.size(); ++k) {
    const std::size_t a = cell[k], b = cell[(k + 1) % cell.size()];
    const double above = (sheet.apical[a] - apical_middle).cross(sheet.apical[b] - apical_middle).dot(normal);
    const double below = (sheet.basal[a] - basal_middle).cross(sheet.basal[b] - basal_middle).dot(normal);
    if (!(below > least_share * above)) return true;
  }
  return false;
}

// On a rough surface neighbouring normals cross below the bound. There, vertices are raised until they do not.
void unfold(PrismSheet& sheet) {
  constexpr int most_passes = 30;
  constexpr double left = 0.9;  // of a height, after a pass
  for (int pass = 0; pass < most_passes; ++pass) {
    std::vector<char> comes_up(sheet.apical.size(), 0);
    for (const auto& cell : sheet.cells)
      if (is_folded(sheet, cell))
        for (const std::size_t vertex : cell) comes_up[vertex] = 1;
    if (std::ranges::none_of(comes_up, [](char up) { return up != 0; })) return;
    for (std::size_t v = 0; v < comes_up.size(); ++v)
      if (comes_up[v] != 0) sheet.basal[v] = sheet.apical[v] + left * (sheet.basal[v] - sheet.apical[v]);
  }
}

}  // namespace

std::vector<VertexBend> vertex_bends(const PolygonSurface& polygons) {
  const auto about = polygons_at_vertices(polygons);
  Vectors areas;
  for (const auto& polygon : polygons.polygons) areas.push_back(area_vector(polygons.vertices, polygon));
  std::vector<VertexBend> bends(polygons.vertices.size(), {Vec3::UnitZ(), infinity});
  for (std::size_t vertex = 0; vertex < bends.size(); ++vertex) {
    if (about[vertex].empty()) continue;
    Vec3 normal = Vec3::Zero();
    for (const std::size_t p : about[vertex]) normal += areas[p];
    if (normal.norm() > 0) bends[vertex].normal = normal.normalized();
    // Those of its polygons; at a rim, where these are one or two, of their neighbours, too.
    std::set<std::size_t> ring = {vertex};
    for (int rings = 0; rings < 2 && ring.size() < 9; ++rings)
      for (const std::size_t near : std::set(ring))
        for (const std::size_t p : about[near]) ring.insert(polygons.polygons[p].begin(), polygons.polygons[p].end());
    Vectors others;
    for (const std::size_t other : ring)
      if (other != vertex) others.push_back(polygons.vertices[other]);
    bends[vertex].least_radius_um = least_radius(polygons.vertices[vertex], bends[vertex].normal, others);
  }
  return bends;
}

std::vector<VertexBend> vertex_bends(const PolygonSurface& polygons, const StarSurface& surface) {
  std::vector<VertexBend> bends;
  bends.reserve(polygons.vertices.size());
  for (const Vec3& vertex : polygons.vertices) {
    const SurfaceBend bend = surface.bend(vertex);
    double least = infinity;
    for (const double radius : bend.radii)
      if (radius > 0) least = std::min(least, radius);
    bends.push_back({bend.normal, least});
  }
  return bends;
}

ExtrudedSheet extrude(const PolygonSurface& polygons, std::span<const VertexBend> bends,
                      std::span<const double> heights_um) {
  check_heights(polygons, heights_um);
  const auto height_of = [&](std::size_t cell) { return heights_um[heights_um.size() == 1 ? 0 : cell]; };
  ExtrudedSheet sheet{{polygons.vertices, polygons.vertices, polygons.polygons, polygons.periods}, "", 0, 0, 0};

  // Mean requested height of the cells at a vertex.
  std::vector<double> asked(sheet.apical.size(), 0.0), cell_count(sheet.apical.size(), 0.0);
  for (std::size_t cell = 0; cell < sheet.cells.size(); ++cell)
    for (const std::size_t vertex : sheet.cells[cell]) {
      asked[vertex] += height_of(cell);
      cell_count[vertex] += 1;
    }
  for (std::size_t v = 0; v < sheet.apical.size(); ++v) {
    if (cell_count[v] == 0) continue;
    const double bound = largest_height_share * bends[v].least_radius_um;
    sheet.basal[v] -= bounded_height(asked[v] / cell_count[v], bound) * bends[v].normal;
  }

  unfold(sheet);
  const std::vector<double> heights = prism_heights(sheet);
  for (std::size_t cell = 0; cell < sheet.cells.size(); ++cell) {
    double wanted = 0;
    for (const std::size_t vertex : sheet.cells[cell]) wanted += asked[vertex] / cell_count[vertex];
    wanted /= static_cast<double>(sheet.cells[cell].size());
    if (heights[cell] < 0.99 * wanted) ++sheet.lower_cells;
    if (heights[cell] < heights[sheet.lowest_cell]) sheet.lowest_cell = cell;
    if (!(area_vector(sheet.basal, sheet.cells[cell]).dot(area_vector(sheet.apical, sheet.cells[cell])) > 0))
      throw MeshError(
          "the basal face of cell {}, whose apical face is at {}, is turned over; lower its height of {:.3g} um, or "
          "smooth the surface there",
          cell, place_text(sheet.apical[sheet.cells[cell].front()]), height_of(cell));
  }
  if (!heights.empty()) sheet.lowest_um = heights[sheet.lowest_cell];
  sheet.asked_um = heights_um.size() == 1 ? fmt::format("{:.3g} um", heights_um[0]) : "asked for";
  return sheet;
}

void note_lower_cells(const ExtrudedSheet& sheet, std::vector<std::string>& remarks) {
  if (sheet.lower_cells > 0)
    remarks.push_back(fmt::format(
        "{} cells are lower than {} (minimum: cell {}, {:.3g} um), because the surface bends too sharply there",
        sheet.lower_cells, sheet.asked_um, sheet.lowest_cell, sheet.lowest_um));
}

std::vector<double> prism_heights(const PrismSheet& sheet) {
  std::vector<double> heights;
  heights.reserve(sheet.cells.size());
  for (const auto& cell : sheet.cells) {
    double sum = 0;
    for (const std::size_t vertex : cell) sum += (sheet.apical[vertex] - sheet.basal[vertex]).norm();
    heights.push_back(sum / static_cast<double>(cell.size()));
  }
  return heights;
}

}  // namespace plica
