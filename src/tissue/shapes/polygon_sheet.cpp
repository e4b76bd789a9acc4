// Each polygon is the rectangle, cut by the perpendicular bisectors to surrounding points, nearest first, until the
// next is too far away. So the boundary is exact. A vertex is named by the cells and sides of the rectangle that meet
// there, and is shared by all of them. (Rejected: points mirrored at the boundary, whose triangulation has two
// coincident vertices wherever two cells meet there.)
//
// If the rectangle is periodic, surrounding points include those of all periods. Images of a vertex have the same name,
// up to whole periods.
#include "tissue/shapes/polygon_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "tissue/mesh_input.hpp"
#include "tissue/shapes/extrusion.hpp"
#include "tissue/shapes/polygon_surface.hpp"

namespace plica {
namespace {

using IntegerPair = std::array<int, 2>;  // along x and y

/// Neighbour beyond a side: a cell, so many periods away, or below 0 a side of the rectangle.
struct SideNeighbour {
  int cell;
  IntegerPair periods = {0, 0};

  [[nodiscard]] bool is_cell() const { return cell >= 0; }
  auto operator<=>(const SideNeighbour&) const = default;
};

/// A convex polygon in the plane.
struct Cut {
  Vectors corners;
  std::vector<SideNeighbour> beyond;  // of the side from a corner to the next
};

/// Uncut region of a point: the rectangle, or along a period half the distance to its own images.
Cut uncut(const Rectangle& rectangle, std::size_t own, const Vec3& point) {
  const int cell = static_cast<int>(own);
  const double x = 0.5 * rectangle.size_um[0], y = 0.5 * rectangle.size_um[1];
  Cut cut{{{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}}, {{-1}, {-2}, {-3}, {-4}}};
  for (Vec3& corner : cut.corners)
    for (int axis = 0; axis < 2; ++axis)
      if (rectangle.is_periodic[axis]) corner[axis] += point[axis];
  if (rectangle.is_periodic[0]) cut.beyond[1] = {cell, {1, 0}}, cut.beyond[3] = {cell, {-1, 0}};
  if (rectangle.is_periodic[1]) cut.beyond[2] = {cell, {0, 1}}, cut.beyond[0] = {cell, {0, -1}};
  return cut;
}

/// Leaves what is nearer to `own` than to `other`.
void cut_by(const Vec3& own, const Vec3& other, const SideNeighbour& name, Cut& cut) {
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
    left.beyond.push_back(beyond[k] <= 0 ? name : cut.beyond[k]);
  }
  cut = std::move(left);
}

/// Points by squares of a grid, to find those near another. Along a period, squares are lengthened to fill it.
class PointGrid {
 public:
  PointGrid(const Vectors& points, const Rectangle& rectangle) : points_(points), rectangle_(rectangle) {
    const auto& [size, is_periodic] = rectangle;
    const double side = std::sqrt(2 * size[0] * size[1] / static_cast<double>(points.size()));
    for (int axis = 0; axis < 2; ++axis) {
      const int whole = static_cast<int>(size[axis] / side);
      counts_[axis] = is_periodic[axis] ? std::max(1, whole) : whole + 1;
      sides_[axis] = is_periodic[axis] ? size[axis] / counts_[axis] : side;
    }
    lists_.resize(static_cast<std::size_t>(counts_[0]) * static_cast<std::size_t>(counts_[1]));
    for (std::size_t i = 0; i < points.size(); ++i) lists_[number(place(points[i]))].push_back(i);
  }

  /// Return the polygon of a point.
  [[nodiscard]] Cut cell(std::size_t own) const {
    const Vec3& from = points_[own];
    Cut cut = uncut(rectangle_, own, from);
    for (int ring = 0;; ++ring) {
      double farthest = 0;
      for (const Vec3& corner : cut.corners) farthest = std::max(farthest, (corner - from).norm());
      // Whatever is in this ring lies (ring - 1) squares away or more.
      if ((ring - 1) * std::min(sides_[0], sides_[1]) > 2 * farthest) return cut;
      for (const auto& [at, name] : in_ring(ring, from)) {
        if (name.cell == static_cast<int>(own)) continue;
        if (from == at) throw MeshError("points {} and {} coincide", own, name.cell);
        cut_by(from, at, name, cut);
      }
    }
  }

 private:
  struct Image {
    Vec3 at;
    SideNeighbour name;
  };

  [[nodiscard]] IntegerPair place(const Vec3& point) const {
    IntegerPair place;
    for (int axis = 0; axis < 2; ++axis) {
      const double from_end = point[axis] + 0.5 * rectangle_.size_um[axis];
      place[axis] = std::clamp(static_cast<int>(from_end / sides_[axis]), 0, counts_[axis] - 1);
    }
    return place;
  }
  [[nodiscard]] std::size_t number(const IntegerPair& place) const {
    return static_cast<std::size_t>(place[0]) +
           static_cast<std::size_t>(counts_[0]) * static_cast<std::size_t>(place[1]);
  }

  // The nearest first.
  [[nodiscard]] std::vector<Image> in_ring(int ring, const Vec3& from) const {
    const IntegerPair middle = place(from);
    std::vector<Image> found;
    for (int row = middle[1] - ring; row <= middle[1] + ring; ++row)
      for (int column = middle[0] - ring; column <= middle[0] + ring; ++column)
        if (std::max(std::abs(row - middle[1]), std::abs(column - middle[0])) == ring)
          add_points_of({column, row}, found);
    std::ranges::stable_sort(found, {}, [&](const Image& one) { return (one.at - from).squaredNorm(); });
    return found;
  }

  // None where the rectangle ends.
  void add_points_of(IntegerPair place, std::vector<Image>& found) const {
    IntegerPair periods = {0, 0};
    Vec3 shift = Vec3::Zero();
    for (int axis = 0; axis < 2; ++axis) {
      const int whole = static_cast<int>(std::floor(static_cast<double>(place[axis]) / counts_[axis]));
      if (whole != 0 && !rectangle_.is_periodic[axis]) return;
      place[axis] -= whole * counts_[axis];
      periods[axis] = whole;
      shift[axis] = whole * rectangle_.size_um[axis];
    }
    for (const std::size_t i : lists_[number(place)])
      found.push_back({points_[i] + shift, {static_cast<int>(i), periods}});
  }

  const Vectors& points_;
  const Rectangle& rectangle_;
  std::array<double, 2> sides_;  // of a square, along x and y
  IntegerPair counts_;           // columns and rows
  std::vector<std::vector<std::size_t>> lists_;
};

std::vector<Cut> cut_rectangle(const Vectors& points, const Rectangle& rectangle) {
  const PointGrid grid(points, rectangle);
  std::vector<Cut> cuts;
  cuts.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) cuts.push_back(grid.cell(i));
  return cuts;
}

Vec3 centroid(const Cut& cut) {
  std::vector<std::size_t> polygon(cut.corners.size());
  for (std::size_t k = 0; k < polygon.size(); ++k) polygon[k] = k;
  return fan_about(cut.corners, polygon, cut.corners.front()).centroid;
}

// Then a wall is known by its two cells.
void refuse_few_cells(const std::vector<Cut>& cuts) {
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    std::vector<int> about = {static_cast<int>(i)};
    for (const SideNeighbour& one : cuts[i].beyond)
      if (one.is_cell()) about.push_back(one.cell);
    std::ranges::sort(about);
    if (std::ranges::adjacent_find(about) != about.end())
      throw MeshError(
          "cell {} would meet itself, or another cell twice, across the period; lengthen the period, or give more "
          "cells (about four along it)",
          i);
  }
}

/// A vertex and its images: by the periods of the first cell about each.
struct Images {
  std::map<IntegerPair, std::size_t> vertices;
  std::size_t original = 0;
  int cells = 0;  // that have come to one of them
};

Rectangle rectangle_of(const SheetShape& shape) { return {{shape.length_um, shape.width_um}, shape.is_periodic}; }

// Vertices of the rim stay on it.
std::vector<std::string> mend(const Vectors& points, PolygonSurface& polygons, const SheetShape& shape,
                              double least_edge) {
  const Vectors start = polygons.vertices;
  const std::array<double, 2> rim = {0.5 * shape.length_um, 0.5 * shape.width_um};
  MendingRules rules;
  rules.normals.assign(points.size(), Vec3::UnitZ());
  rules.along = [&](const PolygonEdge& edge) {
    if (edge.right != no_polygon) {
      const Vec3 way = points[edge.right] - points[edge.left];
      return Vec3(Vec3::UnitZ().cross(way - polygons.periods.whole(way)).normalized());
    }
    return Vec3((start[edge.vertices[1]] - start[edge.vertices[0]]).normalized());
  };
  rules.allowed = [&](std::size_t vertex, Vec3 to) {
    for (int axis = 0; axis < 2; ++axis)
      if (!shape.is_periodic[axis] && std::abs(start[vertex][axis]) == rim[axis]) to[axis] = start[vertex][axis];
    return to;
  };
  const MendedPolygons mended = mend_polygons(rules, {.least_edge = least_edge}, polygons);
  for (std::size_t p = 0; p < points.size(); ++p)
    if (const std::string flaw = polygon_flaw(polygons.vertices, polygons.polygons[p], Vec3::UnitZ()); !flaw.empty())
      throw MeshError("cell {} at ({:.4g}, {:.4g}) um {}; try another seed", p, points[p].x(), points[p].y(), flaw);
  return remarks_on(mended);
}

/// Map a place of the flat sheet to the curved one.
class CurvedSheet {
 public:
  explicit CurvedSheet(const SheetShape& shape)
      : along_(shape.curvature_per_um[0]), across_(shape.curvature_per_um[1]) {
    const double turn = std::abs(along_) * shape.length_um, tilt = std::abs(across_) * shape.width_um;
    constexpr double pi = std::numbers::pi;
    for (int axis = 0; axis < 2; ++axis)
      if (shape.is_periodic[axis] && shape.curvature_per_um[axis] != 0)
        throw MeshError("a sheet cannot be periodic along a direction in which it is curved");
    if (!(turn < 1.9 * pi) || !(tilt < 1.9 * pi))
      throw MeshError(
          "a sheet of {:.4g} x {:.4g} um with these curvatures turns by {:.0f} and {:.0f} degrees and would overlap "
          "itself; at most 340 are allowed",
          shape.length_um, shape.width_um, turn * 180 / pi, tilt * 180 / pi);
    const double narrowest = stretch(0.5 * shape.width_um), widest = std::max(1.0, narrowest);
    if (!(narrowest >= 0.5) || widest > 2)
      throw MeshError(
          "a sheet with these curvatures is {:.2g} times as long at its sides as in its middle; 0.5 to 2 are allowed: "
          "lower width_um or the curvature",
          narrowest);
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
  // Extent of an arc of this length along its first direction, and away from it.
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

// By x, so that neighbours are near each other in memory.
Vectors even_points(const Rectangle& rectangle, std::size_t count, std::uint64_t seed) {
  const auto& [size, is_periodic] = rectangle;
  std::mt19937_64 random(seed);
  const auto next = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5; };  // in [-0.5, 0.5)
  Vectors points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = next() * size[0];
    points.emplace_back(x, next() * size[1], 0);
  }
  std::ranges::sort(points, {}, [](const Vec3& p) { return p.x(); });
  for (int round = 0; round < Lloyd::rounds; ++round) {
    const std::vector<Cut> cuts = cut_rectangle(points, rectangle);
    for (std::size_t i = 0; i < count; ++i) {
      points[i] += Lloyd::share(round) * (centroid(cuts[i]) - points[i]);
      for (int axis = 0; axis < 2; ++axis) {
        double& x = points[i][axis];
        x = is_periodic[axis] ? x - size[axis] * std::floor(x / size[axis] + 0.5)
                              : std::clamp(x, -0.499 * size[axis], 0.499 * size[axis]);
      }
    }
  }
  return points;
}

PolygonSurface rectangle_polygons(const Vectors& points, const Rectangle& rectangle) {
  const std::vector<Cut> cuts = cut_rectangle(points, rectangle);
  refuse_few_cells(cuts);
  PolygonSurface surface;
  std::vector<std::size_t> originals;
  using Name = std::array<SideNeighbour, 3>;  // the cells and sides of the rectangle about a vertex
  std::map<Name, Images> all;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    std::vector<std::size_t>& polygon = surface.polygons.emplace_back();
    const std::size_t n = cuts[i].corners.size();
    for (std::size_t k = 0; k < n; ++k) {
      Name name = {SideNeighbour{static_cast<int>(i)}, cuts[i].beyond[(k + n - 1) % n], cuts[i].beyond[k]};
      std::ranges::sort(name);
      const IntegerPair periods =
          std::ranges::max_element(name, {}, &SideNeighbour::is_cell)->periods;  // of the first cell
      for (SideNeighbour& one : name)
        for (int axis = 0; axis < 2; ++axis) one.periods[axis] -= one.is_cell() ? periods[axis] : 0;
      Images& images = all[name];
      const auto [entry, is_new] = images.vertices.try_emplace(periods, surface.vertices.size());
      if (++images.cells == 1) images.original = entry->second;
      if (is_new) {
        surface.vertices.push_back(cuts[i].corners[k]);
        originals.push_back(images.original);
      }
      polygon.push_back(entry->second);
    }
  }
  for (const auto& [name, images] : all)
    if (images.cells != std::ranges::count_if(name, &SideNeighbour::is_cell)) {
      const Vec3& at = surface.vertices[images.original];
      throw MeshError("ambiguous cells at ({:.4g}, {:.4g}) um: points are too regular; set another seed", at.x(),
                      at.y());
    }
  const auto& [size, is_periodic] = rectangle;
  if (is_periodic[0] || is_periodic[1])
    surface.periods = {{is_periodic[0] ? size[0] : 0, is_periodic[1] ? size[1] : 0, 0}, std::move(originals)};
  return surface;
}

Tissue build_sheet(const SheetShape& shape, std::size_t count, std::uint64_t seed, const PolygonCells& cells) {
  return build_sheet(shape, even_points(rectangle_of(shape), count, seed), cells);
}

Tissue build_sheet(const SheetShape& shape, const Vectors& points, const PolygonCells& cells) {
  const CurvedSheet curved(shape);
  PolygonSurface polygons = rectangle_polygons(points, rectangle_of(shape));
  std::vector<std::string> remarks = mend(points, polygons, shape, cells.least_edge_ratio);
  std::vector<VertexBend> bends;
  for (Vec3& vertex : polygons.vertices) {
    bends.push_back(curved.bend(vertex.x(), vertex.y()));
    vertex = curved.place(vertex.x(), vertex.y()) + 0.5 * cells.height_um * Vec3::UnitZ();
  }
  const ExtrudedSheet sheet = extrude(polygons, bends, std::array{cells.height_um});
  Tissue tissue = tissue_from_prisms(sheet, cells.split, cells.layers);
  note_lower_cells(sheet, remarks);
  tissue.remarks = std::move(remarks);
  return tissue;
}

}  // namespace plica
