#include "tissue/shapes/polygon_embryo.hpp"

#include <fmt/format.h>

#include <array>
#include <memory>

#include "tissue/shapes/even_points.hpp"
#include "tissue/shapes/extrusion.hpp"
#include "tissue/shapes/surface_polygons.hpp"

namespace plica {
namespace {

// What had to be mended, in the words of whoever wants to know.
std::vector<std::string> remarks_on(const CellPolygons& polygons, const ExtrudedSheet& sheet, double height_um) {
  std::vector<std::string> remarks;
  if (polygons.lengthened_edges + polygons.sharpened_corners > 0)
    remarks.push_back(fmt::format(
        "{} edges were too short for a mesh and {} angles too wide: their vertices were moved, by {:.2g} um at most",
        polygons.lengthened_edges, polygons.sharpened_corners, polygons.furthest_move_um));
  if (polygons.left_edges + polygons.left_corners > 0)
    remarks.push_back(
        fmt::format("{} edges are still short, and {} angles still wide", polygons.left_edges, polygons.left_corners));
  if (sheet.lower_cells > 0)
    remarks.push_back(fmt::format(
        "{} cells are lower than {:.3g} um, the lowest, cell {}, {:.3g} um: the surface bends too sharply there",
        sheet.lower_cells, height_um, sheet.lowest_cell, sheet.lowest_um));
  return remarks;
}

Tissue build_on(const StarSurface& surface, const Vectors& points, const PolygonCells& cells) {
  const CellPolygons polygons = polygons_of_points(points, surface, {.least_edge = cells.least_edge_ratio});
  const ExtrudedSheet sheet = extrude(polygons.surface, surface, std::array{cells.height_um});
  Tissue tissue = tissue_from_prisms(sheet, cells.split, cells.layers);
  tissue.outer_shape = OuterShape(std::make_shared<const StarSurface>(surface));
  tissue.remarks = remarks_on(polygons, sheet, cells.height_um);
  return tissue;
}

}  // namespace

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
  for (Vec3& point : points) point = point.cwiseProduct(measured.scale);
  const StarFit fit = fit_star_surface(points);
  Tissue tissue = build_on(fit.surface, points, cells);
  tissue.remarks.insert(
      tissue.remarks.begin(),
      fmt::format("the points lie {:.2g} um from a smooth surface (root of the mean square), row {} the "
                  "farthest, {:.2g} um",
                  fit.rms_um, fit.largest_row, fit.largest_um));
  return tissue;
}

}  // namespace plica
