// Each polygon is the rectangle, cut by the perpendicular bisectors to the points about its own, the nearest first,
// until the next is too far off to matter. So the rim is exact. A vertex is named by the cells and sides of the
// rectangle that meet there, which makes it one vertex for all of them. (Rejected: points mirrored at the rim, whose
// triangulation has two vertices in one place wherever two cells meet there.)
#include "tissue/shapes/polygon_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/shapes/extrusion.hpp"
#include "tissue/shapes/polygon_mending.hpp"

namespace plica {
namespace {

constexpr int rounds = 35;  // of Lloyd's relaxation, as on closed surfaces (even_points.cpp)
constexpr double overrelaxation = 1.5;

/// A convex polygon in the plane, and what lies beyond each side: a cell, or below 0 a side of the rectangle.
struct Cut {
  Vectors corners;
  std::vector<int> beyond;  // of the side from a corner to the next
};

Cut rectangle(double length, double width) {
  const double x = 0.5 * length, y = 0.5 * width;
  return {{{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}}, {-1, -2, -3, -4}};
}

/// Leaves what is nearer to `own` than to `other`.
void cut_by(const Vec3& own, const Vec3& other, int number, Cut& cut) {
  const Vec3 way = other - own, middle = 0.5 * (own + other);
  const std::size_t n = cut.corners.size();
  std::vector<double> beyond(n);
  for (std::size_t k = 0; k < n; ++k) beyond[k] = (cut.corners[k] - middle).dot(way);
  if (std::ranges::all_of(beyond, [](double d) { return d <= 0; })) return;
  Cut left;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t next = (k + 1) % n;
    if (beyond[k] <= 0) {
      left.corners.push_back(cut.corners[k]);
      left.beyond.push_back(cut.beyond[k]);
    }
    if ((beyond[k] <= 0) == (beyond[next] <= 0)) continue;
    const double share = beyond[k] / (beyond[k] - beyond[next]);
    left.corners.push_back(cut.corners[k] + share * (cut.corners[next] - cut.corners[k]));
    left.beyond.push_back(beyond[k] <= 0 ? number : cut.beyond[k]);
  }
  cut = std::move(left);
}

/// Points in squares, so that those near another are found.
class Squares {
 public:
  Squares(const Vectors& points, double length, double width)
      : points_(points), corner_(-0.5 * length, -0.5 * width, 0) {
    side_ = std::sqrt(2 * length * width / static_cast<double>(points.size()));
    columns_ = std::max(1, static_cast<int>(length / side_) + 1);
    rows_ = std::max(1, static_cast<int>(width / side_) + 1);
    lists_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [column, row] = place(points[i]);
      list(column, row).push_back(i);
    }
  }

  /// Of each point's own part of the rectangle.
  [[nodiscard]] Cut cell(std::size_t own, double length, double width) const {
    Cut cut = rectangle(length, width);
    const auto [column, row] = place(points_[own]);
    for (int ring = 0; ring <= std::max(columns_, rows_); ++ring) {
      double farthest = 0;
      for (const Vec3& corner : cut.corners) farthest = std::max(farthest, (corner - points_[own]).norm());
      // Whatever is in this ring lies (ring - 1) squares away or more.
      if ((ring - 1) * side_ > 2 * farthest) break;
      for (const std::size_t other : in_ring(column, row, ring, points_[own]))
        if (other != own) {
          if (points_[own] == points_[other])
            throw MeshError(fmt::format("points {} and {} are in one place", own, other));
          cut_by(points_[own], points_[other], static_cast<int>(other), cut);
        }
    }
    return cut;
  }

 private:
  [[nodiscard]] std::array<int, 2> place(const Vec3& point) const {
    const Vec3 from = (point - corner_) / side_;
    return {std::clamp(static_cast<int>(from.x()), 0, columns_ - 1),
            std::clamp(static_cast<int>(from.y()), 0, rows_ - 1)};
  }
  [[nodiscard]] std::vector<std::size_t>& list(int column, int row) {
    return lists_[static_cast<std::size_t>(column) +
                  static_cast<std::size_t>(columns_) * static_cast<std::size_t>(row)];
  }

  // The nearest first.
  [[nodiscard]] std::vector<std::size_t> in_ring(int column, int row, int ring, const Vec3& from) const {
    std::vector<std::size_t> found;
    for (int r = std::max(0, row - ring); r <= std::min(rows_ - 1, row + ring); ++r)
      for (int c = std::max(0, column - ring); c <= std::min(columns_ - 1, column + ring); ++c) {
        if (std::max(std::abs(r - row), std::abs(c - column)) != ring) continue;
        const auto& here =
            lists_[static_cast<std::size_t>(c) + static_cast<std::size_t>(columns_) * static_cast<std::size_t>(r)];
        found.insert(found.end(), here.begin(), here.end());
      }
    std::ranges::stable_sort(found, {}, [&](std::size_t i) { return (points_[i] - from).squaredNorm(); });
    return found;
  }

  const Vectors& points_;
  Vec3 corner_;
  double side_;
  int columns_, rows_;
  std::vector<std::vector<std::size_t>> lists_;
};

std::vector<Cut> cut_rectangle(const Vectors& points, double length, double width) {
  const Squares squares(points, length, width);
  std::vector<Cut> cuts;
  cuts.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) cuts.push_back(squares.cell(i, length, width));
  return cuts;
}

Vec3 centroid(const Cut& cut) {
  std::vector<std::size_t> polygon(cut.corners.size());
  for (std::size_t k = 0; k < polygon.size(); ++k) polygon[k] = k;
  return fan_about(cut.corners, polygon, cut.corners.front()).centroid;
}

// By x, so that neighbours are near each other in memory.
Vectors even_points_in(double length, double width, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto next = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5; };  // in [-0.5, 0.5)
  Vectors points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = next() * length;
    points.emplace_back(x, next() * width, 0);
  }
  std::ranges::sort(points, {}, [](const Vec3& p) { return p.x(); });
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Cut> cuts = cut_rectangle(points, length, width);
    const double share = round < 5 ? 1 : overrelaxation;
    for (std::size_t i = 0; i < count; ++i) {
      points[i] += share * (centroid(cuts[i]) - points[i]);
      points[i].x() = std::clamp(points[i].x(), -0.499 * length, 0.499 * length);
      points[i].y() = std::clamp(points[i].y(), -0.499 * width, 0.499 * width);
    }
  }
  return points;
}

// Vertices of the rim stay on it.
std::vector<std::string> mend(const Vectors& points, PolygonSurface& polygons, const SheetShape& shape,
                              double least_edge) {
  const Vectors start = polygons.vertices;
  const double x = 0.5 * shape.length_um, y = 0.5 * shape.width_um;
  MendingGround ground;
  ground.normals.assign(points.size(), Vec3::UnitZ());
  ground.along = [&](const PolygonEdge& edge) {
    if (edge.right != no_polygon) return Vec3(Vec3::UnitZ().cross(points[edge.right] - points[edge.left]).normalized());
    return Vec3((start[edge.vertices[1]] - start[edge.vertices[0]]).normalized());
  };
  ground.allowed = [&](std::size_t vertex, Vec3 to) {
    if (std::abs(start[vertex].x()) == x) to.x() = start[vertex].x();
    if (std::abs(start[vertex].y()) == y) to.y() = start[vertex].y();
    return to;
  };
  const MendedPolygons mended = mend_polygons(ground, {.least_edge = least_edge}, polygons);
  for (std::size_t p = 0; p < points.size(); ++p)
    if (const std::string flaw = polygon_flaw(polygons.vertices, polygons.polygons[p], Vec3::UnitZ()); !flaw.empty())
      throw MeshError(fmt::format("cell {} at ({:.4g}, {:.4g}) um {}; another seed may do better", p, points[p].x(),
                                  points[p].y(), flaw));
  return remarks_on(mended);
}

/// Where a place of the flat sheet comes to lie.
class Bent {
 public:
  explicit Bent(const SheetShape& shape) : along_(shape.curvature_per_um[0]), across_(shape.curvature_per_um[1]) {
    const double turn = std::abs(along_) * shape.length_um, tilt = std::abs(across_) * shape.width_um;
    constexpr double pi = std::numbers::pi;
    if (!(turn < 1.9 * pi) || !(tilt < 1.9 * pi))
      throw MeshError(
          fmt::format("a sheet of {:.4g} x {:.4g} um with these curvatures turns by {:.0f} and {:.0f} degrees "
                      "and would close upon itself; 340 are allowed",
                      shape.length_um, shape.width_um, turn * 180 / pi, tilt * 180 / pi));
    const double narrowest = stretch(0.5 * shape.width_um), widest = std::max(1.0, narrowest);
    if (!(narrowest >= 0.5) || widest > 2)
      throw MeshError(
          fmt::format("a sheet with these curvatures is {:.2g} times as long at its sides as in its middle; "
                      "0.5 to 2 are allowed: give a smaller width_um or curvature",
                      narrowest));
  }

  // The middle line is an arc along x, of normal n; across it, arcs in the plane of n and y.
  [[nodiscard]] Vec3 place(double s, double t) const {
    const Vec3 foot(arc(along_, s), 0, -rise(along_, s));
    return foot + arc(across_, t) * Vec3::UnitY() - rise(across_, t) * middle_normal(s);
  }
  [[nodiscard]] VertexBend bend(double s, double t) const {
    const double angle = across_ * t;
    const Vec3 normal = std::cos(angle) * middle_normal(s) + std::sin(angle) * Vec3::UnitY();
    const double sharpest = std::max(across_, along_ * std::cos(angle) / stretch(t));
    return {normal, sharpest > 0 ? 1 / sharpest : std::numeric_limits<double>::infinity()};
  }

 private:
  // How far an arc of this length goes along its first direction, and away from it.
  static double arc(double curvature, double way) {
    return curvature == 0 ? way : std::sin(curvature * way) / curvature;
  }
  static double rise(double curvature, double way) {
    return curvature == 0 ? 0 : 2 * std::pow(std::sin(0.5 * curvature * way), 2) / curvature;
  }
  [[nodiscard]] Vec3 middle_normal(double s) const { return {std::sin(along_ * s), 0, std::cos(along_ * s)}; }
  // Lengths along x over those on the middle line.
  [[nodiscard]] double stretch(double t) const { return 1 - along_ * rise(across_, t); }

  double along_, across_;
};

}  // namespace

PolygonSurface rectangle_polygons(const Vectors& points, double length_um, double width_um) {
  const std::vector<Cut> cuts = cut_rectangle(points, length_um, width_um);
  PolygonSurface surface;
  using Name = std::array<int, 3>;                       // of a vertex: the cells and sides of the rectangle about it
  std::map<Name, std::pair<std::size_t, int>> vertices;  // and how many cells have come to it
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    std::vector<std::size_t>& polygon = surface.polygons.emplace_back();
    const std::size_t n = cuts[i].corners.size();
    for (std::size_t k = 0; k < n; ++k) {
      Name name = {static_cast<int>(i), cuts[i].beyond[(k + n - 1) % n], cuts[i].beyond[k]};
      std::ranges::sort(name);
      const auto [entry, is_new] = vertices.try_emplace(name, surface.vertices.size(), 0);
      if (is_new) surface.vertices.push_back(cuts[i].corners[k]);
      ++entry->second.second;
      polygon.push_back(entry->second.first);
    }
  }
  for (const auto& [name, vertex] : vertices)
    if (vertex.second != std::ranges::count_if(name, [](int cell) { return cell >= 0; })) {
      const Vec3& at = surface.vertices[vertex.first];
      throw MeshError(
          fmt::format("cells cannot be told apart at ({:.4g}, {:.4g}) um: points lie too regularly", at.x(), at.y()));
    }
  return surface;
}

Tissue build_sheet(const SheetShape& shape, std::size_t count, std::uint64_t seed, const PolygonCells& cells) {
  const Bent bent(shape);
  const Vectors points = even_points_in(shape.length_um, shape.width_um, count, seed);
  PolygonSurface polygons = rectangle_polygons(points, shape.length_um, shape.width_um);
  std::vector<std::string> remarks = mend(points, polygons, shape, cells.least_edge_ratio);
  std::vector<VertexBend> bends;
  for (Vec3& vertex : polygons.vertices) {
    bends.push_back(bent.bend(vertex.x(), vertex.y()));
    vertex = bent.place(vertex.x(), vertex.y()) + 0.5 * cells.height_um * Vec3::UnitZ();
  }
  const ExtrudedSheet sheet = extrude(polygons, bends, std::array{cells.height_um});
  Tissue tissue = tissue_from_prisms(sheet, cells.split, cells.layers);
  note_lower_cells(sheet, remarks);
  tissue.remarks = std::move(remarks);
  return tissue;
}

}  // namespace plica
