#include "tissue/shapes/polygon_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/shapes/extrusion.hpp"
#include "tissue/shapes/polygon_mending.hpp"
#include "tissue/shapes/rectangle_polygons.hpp"

namespace plica {
namespace {

Rectangle rectangle_of(const SheetShape& shape) { return {{shape.length_um, shape.width_um}, shape.is_periodic}; }

// Vertices of the rim stay on it.
std::vector<std::string> mend(const Vectors& points, PolygonSurface& polygons, const SheetShape& shape,
                              double least_edge) {
  const Vectors start = polygons.vertices;
  const std::array<double, 2> rim = {0.5 * shape.length_um, 0.5 * shape.width_um};
  MendingGround ground;
  ground.normals.assign(points.size(), Vec3::UnitZ());
  ground.along = [&](const PolygonEdge& edge) {
    if (edge.right != no_polygon) {
      const Vec3 way = points[edge.right] - points[edge.left];
      return Vec3(Vec3::UnitZ().cross(way - polygons.periods.whole(way)).normalized());
    }
    return Vec3((start[edge.vertices[1]] - start[edge.vertices[0]]).normalized());
  };
  ground.allowed = [&](std::size_t vertex, Vec3 to) {
    for (int axis = 0; axis < 2; ++axis)
      if (!shape.is_periodic[axis] && std::abs(start[vertex][axis]) == rim[axis]) to[axis] = start[vertex][axis];
    return to;
  };
  const MendedPolygons mended = mend_polygons(ground, {.least_edge = least_edge}, polygons);
  for (std::size_t p = 0; p < points.size(); ++p)
    if (const std::string flaw = polygon_flaw(polygons.vertices, polygons.polygons[p], Vec3::UnitZ()); !flaw.empty())
      throw MeshError(
          fmt::format("cell {} at ({:.4g}, {:.4g}) um {}; try another seed", p, points[p].x(), points[p].y(), flaw));
  return remarks_on(mended);
}

/// Map a place of the flat sheet to the curved one.
class Bent {
 public:
  explicit Bent(const SheetShape& shape) : along_(shape.curvature_per_um[0]), across_(shape.curvature_per_um[1]) {
    const double turn = std::abs(along_) * shape.length_um, tilt = std::abs(across_) * shape.width_um;
    constexpr double pi = std::numbers::pi;
    for (int axis = 0; axis < 2; ++axis)
      if (shape.is_periodic[axis] && shape.curvature_per_um[axis] != 0)
        throw MeshError("a sheet cannot be periodic along a direction in which it is curved");
    if (!(turn < 1.9 * pi) || !(tilt < 1.9 * pi))
      throw MeshError(
          fmt::format("a sheet of {:.4g} x {:.4g} um with these curvatures turns by {:.0f} and {:.0f} degrees "
                      "and would overlap itself; at most 340 are allowed",
                      shape.length_um, shape.width_um, turn * 180 / pi, tilt * 180 / pi));
    const double narrowest = stretch(0.5 * shape.width_um), widest = std::max(1.0, narrowest);
    if (!(narrowest >= 0.5) || widest > 2)
      throw MeshError(
          fmt::format("a sheet with these curvatures is {:.2g} times as long at its sides as in its middle; "
                      "0.5 to 2 are allowed: lower width_um or the curvature",
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

Tissue build_sheet(const SheetShape& shape, std::size_t count, std::uint64_t seed, const PolygonCells& cells) {
  return build_sheet(shape, even_points(rectangle_of(shape), count, seed), cells);
}

Tissue build_sheet(const SheetShape& shape, const Vectors& points, const PolygonCells& cells) {
  const Bent bent(shape);
  PolygonSurface polygons = rectangle_polygons(points, rectangle_of(shape));
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
