#include "measure/neighbours.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "measure/measure_set.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

using enum InSummary;
using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

// Cell at a vertex, as it has that.
struct AtVertex {
  CellId cell;
  VertexId vertex;
};
using Three = std::array<AtVertex, 3>;

// Cells about the vertices where three of a set meet.
std::vector<Three> threes_of(const Sheet& sheet, const CellSet& cells) {
  std::map<VertexId, std::vector<AtVertex>> about;
  for (std::size_t c = 0; c < sheet.cells.size(); ++c)
    for (const Stop& stop : sheet.cells[c].ring)
      about[sheet.original_of(stop.vertex)].push_back({CellId(c), stop.vertex});
  std::vector<Three> threes;
  for (const auto& [vertex, three] : about)
    if (three.size() == 3 && std::ranges::all_of(three, [&](const AtVertex& at) { return cells[at.cell.index()]; }))
      threes.push_back({three[0], three[1], three[2]});
  return threes;
}

// Centres of these cells, from their vertex: the tissue may be periodic.
using Triangle = std::array<Vec3, 3>;

std::vector<Triangle> triangles_of(const Tissue& tissue, const std::vector<Three>& threes,
                                   std::span<const Vec3> positions) {
  const auto place = [&](VertexId vertex) {
    const auto& nodes = tissue.sheet.vertices[vertex.index()].nodes;
    return Vec3(0.5 * (positions[nodes.front().index()] + positions[nodes.back().index()]));
  };
  std::vector<Vec3> centres;
  for (const Polygon& polygon : tissue.sheet.cells) {
    Vec3 sum = Vec3::Zero();
    for (const Stop& stop : polygon.ring) sum += place(stop.vertex);
    centres.push_back(sum / static_cast<double>(polygon.ring.size()));
  }
  std::vector<Triangle> triangles;
  for (const Three& three : threes)
    for (Triangle& triangle = triangles.emplace_back(); const int i : {0, 1, 2})
      triangle[i] = centres[three[i].cell.index()] - place(three[i].vertex);
  return triangles;
}

// Directions in the surface: along x, and across.
std::optional<std::array<Vec3, 2>> axes_of(const Triangle& triangle) {
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
  const Vec3 along = Vec3::UnitX() - normal.x() * normal;
  if (along.norm() < 1e-3) return std::nullopt;  // at a pole
  return std::array{Vec3(along.normalized()), Vec3(normal.cross(along).normalized())};
}

// Two sides of a triangle as columns.
Mat2 sides_in(const std::array<Vec3, 2>& axes, const Triangle& triangle) {
  Mat2 sides;
  for (const int side : {0, 1})
    for (const int axis : {0, 1}) sides(axis, side) = axes[axis].dot(triangle[side + 1] - triangle[0]);
  return sides;
}

struct Kept {
  double below_um, shape_at_rest;
  std::string region;
};

// Walls shorter than the rule says, and vertices that they join.
struct ShortWalls {
  int walls = 0, four_fold = 0, more_fold = 0;
};

ShortWalls short_walls(const ColumnInput& m) {
  const Sheet& sheet = m.model.tissue.sheet;
  const auto original = [&](VertexId vertex) { return sheet.original_of(vertex).index(); };
  std::vector<std::size_t> group(sheet.vertices.size());
  std::iota(group.begin(), group.end(), 0);
  const auto group_of = [&](std::size_t vertex) {
    while (group[vertex] != vertex) vertex = group[vertex] = group[group[vertex]];
    return vertex;
  };
  std::set<WallId> found;
  for (const Polygon& polygon : sheet.cells)
    for (std::size_t i = 0; i < polygon.ring.size(); ++i) {
      const Stop &from = polygon.ring[i], &to = polygon.after(i);
      const auto &a = sheet.vertices[from.vertex.index()].nodes, &b = sheet.vertices[to.vertex.index()].nodes;
      double length = 0;
      for (const auto& [one, other] : {std::pair(a.front(), b.front()), {a.back(), b.back()}})
        length += 0.5 * (m.state.positions[other.index()] - m.state.positions[one.index()]).norm();
      if (length >= m.of_set<Kept>().below_um) continue;
      found.insert(from.wall);
      group[group_of(original(from.vertex))] = group_of(original(to.vertex));
    }
  std::map<std::size_t, std::set<std::size_t>> cells;  // groups
  for (std::size_t c = 0; c < sheet.cells.size(); ++c)
    for (const Stop& stop : sheet.cells[c].ring) cells[group_of(original(stop.vertex))].insert(c);
  ShortWalls result{.walls = static_cast<int>(found.size())};
  for (const auto& [vertex, about] : cells) {
    result.four_fold += static_cast<int>(about.size() == 4);
    result.more_fold += static_cast<int>(about.size() > 4);
  }
  return result;
}

// Cells by their number of neighbours, 4 or fewer to 8 or more, without those at a rim.
using Histogram = std::array<int, 5>;

Histogram histogram(const ColumnInput& m) {
  const Sheet& sheet = m.model.tissue.sheet;
  Histogram counts = {};
  for (std::size_t c = 0; c < sheet.cells.size(); ++c) {
    std::set<CellId> neighbours;
    for (const Stop& stop : sheet.cells[c].ring) neighbours.insert(sheet.walls[stop.wall.index()].beyond(CellId(c)));
    if (!neighbours.contains(CellId())) ++counts[std::clamp<std::size_t>(neighbours.size(), 4, 8) - 4];
  }
  return counts;
}

Column::OfStep count_of(int ShortWalls::*part) {
  return [=](const ColumnInput& m) { return m.once(short_walls).*part; };
}
Column::OfStep count_of(std::size_t neighbours) {
  return [=](const ColumnInput& m) { return m.once(histogram)[neighbours - 4]; };
}

double shear_of_shape(const ColumnInput& m) {
  const Kept& kept = m.of_set<Kept>();
  return shape_shear(m.model.tissue, m.model.tissue.regions.at(kept.region), m.state.positions) - kept.shape_at_rest;
}

Kept kept_of(const Tissue& tissue, double below_um, const std::string& region) {
  return {below_um, shape_shear(tissue, tissue.regions.at(region), tissue.rest_positions), region};
}

}  // namespace

double shear_between(const Tissue& tissue, const CellSet& cells, std::span<const Vec3> before,
                     std::span<const Vec3> after) {
  const std::vector<Three> threes = threes_of(tissue.sheet, cells);
  const std::vector<Triangle> from = triangles_of(tissue, threes, before), to = triangles_of(tissue, threes, after);
  double sum = 0, areas = 0;
  for (std::size_t t = 0; t < threes.size(); ++t) {
    Triangle midway;
    for (const int i : {0, 1, 2}) midway[i] = 0.5 * (from[t][i] + to[t][i]);
    const auto axes = axes_of(midway);
    if (!axes) continue;
    const Mat2 sides = sides_in(*axes, midway),
               gradient = (sides_in(*axes, to[t]) - sides_in(*axes, from[t])) * sides.inverse();
    const double area = 0.5 * std::abs(sides.determinant());
    sum += area * 0.5 * (gradient(0, 0) - gradient(1, 1));
    areas += area;
  }
  return areas > 0 ? sum / areas : 0;
}

double shape_shear(const Tissue& tissue, const CellSet& cells, std::span<const Vec3> positions) {
  // The equilateral triangle becomes one of these by the matrix S, which has S S^T as second moments, up to a factor.
  const Mat2 equilateral = (Mat2() << 1, 0.5, 0, std::sqrt(0.75)).finished();
  Mat2 sum = Mat2::Zero();
  for (const Triangle& triangle : triangles_of(tissue, threes_of(tissue.sheet, cells), positions)) {
    const auto axes = axes_of(triangle);
    if (!axes) continue;
    const Mat2 S = sides_in(*axes, triangle) * equilateral.inverse();
    sum += S * S.transpose();  // whose size is the area
  }
  const Eigen::SelfAdjointEigenSolver<Mat2> solved(sum);
  if (!(solved.eigenvalues()[0] > 0)) return 0;
  const Vec2 logs = solved.eigenvalues().array().log();
  const Mat2 log = solved.eigenvectors() * logs.asDiagonal() * solved.eigenvectors().transpose();
  return 0.25 * (log(0, 0) - log(1, 1));
}

MeasureSet neighbours_set() {
  return set_of(
      "neighbours", "`[exchange]`",
      [](const Subject& s) {
        return s.exchange_below_um ? std::any(kept_of(s.model.tissue, *s.exchange_below_um, s.exchange_region))
                                   : std::any();
      },
      {count({"exchanges", last, "Exchanges of neighbours so far, before those due at the end of the step.",
              [](const ColumnInput& m) { return m.state.exchanges.count; }}),
       {"exchange_energy_nN_um", last,
        "Change of energy at these exchanges, summed; not in `stored_energy_nN_um` "
        "([exchange](../theory/exchange.md)).",
        [](const ColumnInput& m) { return m.state.exchanges.energy; }},
       count({"extruded_cells", last, "Cells that have left the sheet so far.",
              [](const ColumnInput& m) { return m.state.exchanges.extruded; }}),
       {"extruded_volume_um3", last, "Their volume, which the tissue has lost.",
        [](const ColumnInput& m) { return m.state.exchanges.extruded_um3; }},
       count({"short_walls", last, "Lateral faces shorter than `exchange.below_um`.", count_of(&ShortWalls::walls)}),
       count({"four_fold_vertices", last, "Places where four cells meet: vertices joined by such faces count as one.",
              count_of(&ShortWalls::four_fold)}),
       count({"rosettes", last, "Places where five or more cells meet.", count_of(&ShortWalls::more_fold)}),
       count({"cells_of_4_neighbours", last, "Cells with 4 neighbours or fewer; cells at a rim are left out.",
              count_of(4)}),
       count({"cells_of_5_neighbours", last, "Cells with 5 neighbours, likewise.", count_of(5)}),
       count({"cells_of_6_neighbours", last, "Cells with 6 neighbours, likewise.", count_of(6)}),
       count({"cells_of_7_neighbours", last, "Cells with 7 neighbours, likewise.", count_of(7)}),
       count({"cells_of_8_neighbours", last, "Cells with 8 neighbours or more, likewise.", count_of(8)}),
       {"tissue_shear", last,
        "Shear of the cells of `exchange.region`: half of (logarithmic strain along x − across it), mean.",
        [](const ColumnInput& m) { return m.state.exchanges.shear; }},
       {"cell_shape_shear", last, "Part of it by which cells have become longer.", shear_of_shape},
       {"exchange_shear", last, "The rest of it, by exchange of neighbours.",
        [](const ColumnInput& m) { return m.state.exchanges.shear - shear_of_shape(m); }}});
}

}  // namespace plica
