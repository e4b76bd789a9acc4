#include "tissue/shapes/polygon_embryo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <optional>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/place.hpp"
#include "tissue/shapes/even_points.hpp"
#include "tissue/shapes/extrusion.hpp"
#include "tissue/shapes/given_surface.hpp"
#include "tissue/shapes/surface_polygons.hpp"

namespace plica {
namespace {

Tissue build_on(const StarSurface& surface, const Vectors& points, const PolygonCells& cells) {
  const CellPolygons polygons = polygons_of_points(points, surface, {.least_edge = cells.least_edge_ratio});
  const ExtrudedSheet sheet =
      extrude(polygons.surface, vertex_bends(polygons.surface, surface), std::array{cells.height_um});
  Tissue tissue = tissue_from_prisms(sheet, cells.split, cells.layers);
  tissue.outer_shape = OuterShape(std::make_shared<const StarSurface>(surface));
  tissue.remarks = remarks_on(polygons);
  note_lower_cells(sheet, tissue.remarks);
  return tissue;
}

constexpr double largest_roughness = 0.02;  // of the least half-axis, that a vertex may be from a smooth surface

StarSurface smooth_surface(const PolygonSurface& surface) {
  const StarFit fit = fit_star_surface(surface.vertices);
  const double allowed = largest_roughness * fit.surface.half_axes().minCoeff();
  if (fit.largest_um > allowed)
    throw MeshError(
        fmt::format("vertex {} at {} lies {:.2g} um from the fitted smooth surface; {:.2g} um "
                    "are allowed: smooth the surface there",
                    fit.largest_row, place_text(surface.vertices[fit.largest_row]), fit.largest_um, allowed));
  return fit.surface;
}

// No vertex lies beyond it.
OuterShape shape_around(const StarSurface& smooth, const Vectors& vertices) {
  double outside = 0;
  for (const Vec3& vertex : vertices) outside = std::max(outside, smooth.closest(vertex).signed_distance_um);
  return OuterShape(std::make_shared<const StarSurface>(smooth)).moved_out(outside);
}

Vec3 area_centroid(const PolygonSurface& surface) {
  Vec3 sum = Vec3::Zero();
  double area = 0;
  for (const auto& polygon : surface.polygons) {
    Vec3 middle = Vec3::Zero();
    for (const std::size_t vertex : polygon) middle += surface.vertices[vertex] / static_cast<double>(polygon.size());
    const PolygonFan fan = fan_about(surface.vertices, polygon, middle);
    sum += fan.area * fan.centroid;
    area += fan.area;
  }
  return sum / area;
}

}  // namespace

CellArray of_kept(const CellArray& of_faces, const std::vector<std::size_t>& kept) {
  CellArray values;
  for (const std::size_t face : kept) values.push_back(of_faces[face]);
  return values;
}

SurfaceTissue build_under_surface(GivenSurface given, const PolygonCells& cells) {
  PolygonSurface& surface = given.surface;
  const std::size_t face_count = surface.polygons.size();
  given.placement.turn(surface.vertices);
  const MendedSurface mended =
      check_and_mend(surface, given.mend, {.least_edge = cells.least_edge_ratio}, given.keep_largest);
  if (given.placement.centre) move_to_origin(surface.vertices, area_centroid(surface));
  SurfaceTissue result;
  result.kept = mended.kept;
  std::optional<StarSurface> smooth;
  try {
    if (!mended.is_closed) throw MeshError("the surface has a boundary; give a closed surface");
    smooth = smooth_surface(surface);
  } catch (const MeshError& error) {
    result.why_no_shape = error.what();
  }
  std::vector<double> heights_um = given.heights_um.empty() ? std::vector{cells.height_um} : given.heights_um;
  if (heights_um.size() == face_count) heights_um = of_kept(heights_um, mended.kept);
  const ExtrudedSheet sheet =
      extrude(surface, smooth ? vertex_bends(surface, *smooth) : vertex_bends(surface), heights_um);
  result.tissue = tissue_from_prisms(sheet, cells.split, cells.layers);
  result.tissue.remarks = mended.remarks;
  note_lower_cells(sheet, result.tissue.remarks);
  if (smooth) result.tissue.outer_shape = shape_around(*smooth, surface.vertices);
  return result;
}

Tissue build_egg(const EggShape& shape, std::size_t count, std::uint64_t seed, const PolygonCells& cells) {
  const StarSurface surface = egg_surface(shape);
  return build_on(surface, even_points(surface, count, seed), cells);
}

Tissue build_about_points(const MeasuredPoints& measured, const PolygonCells& cells) {
  Vectors points = measured.points;
  if (measured.depth_um > 0) {
    const StarFit below = fit_star_surface(points);
    for (Vec3& point : points) point += measured.depth_um * below.surface.closest(point).normal;
  }
  measured.placement.turn(points);
  if (measured.placement.centre && !points.empty())
    move_to_origin(points, std::accumulate(points.begin(), points.end(), Vec3(0, 0, 0)) / points.size());
  const StarFit fit = fit_star_surface(points);
  Tissue tissue = build_on(fit.surface, points, cells);
  tissue.remarks.insert(
      tissue.remarks.begin(),
      fmt::format("the points lie {:.2g} um (root mean square) from a smooth surface; row {} is farthest, "
                  "{:.2g} um",
                  fit.rms_um, fit.largest_row, fit.largest_um));
  return tissue;
}

}  // namespace plica
