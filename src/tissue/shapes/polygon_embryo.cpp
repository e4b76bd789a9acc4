#include "tissue/shapes/polygon_embryo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include "tissue/shapes/extrusion.hpp"
#include "tissue/shapes/given_surface.hpp"
#include "tissue/shapes/surface_polygons.hpp"

namespace plica {
namespace {

constexpr int egg_degree = 5;

double even_term(const Vec3& d) { return d.x() * d.x() * (1 - d.x() * d.x()); }
double odd_term(const Vec3& d) { return d.z() * d.x() * d.x() * (1 - d.x() * d.x() / 2); }

// The outline in the plane y = 0 of the scaled egg.
struct EggOutline {
  double even, odd;

  // At an angle from +x; towards the back where it is positive.
  [[nodiscard]] Vec3 at(double angle) const {
    const Vec3 d(std::cos(angle), 0, std::sin(angle));
    return (1 + even * even_term(d) + odd * odd_term(d)) * d;
  }

  [[nodiscard]] double half_length() const {
    // x has one maximum near the pole: golden section.
    double low = -1, high = 1;
    for (int i = 0; i < 80; ++i) {
      const double third = (high - low) * 0.382;
      if (at(low + third).x() < at(high - third).x())
        low += third;
      else
        high -= third;
    }
    return at(low).x();
  }

  // Sag of the dorsal (side 1) or ventral side (-1), relative to the half height.
  [[nodiscard]] double sag(int side) const {
    const double x = 0.6 * half_length();
    double low = 0, high = std::numbers::pi / 2;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (at(side * middle).x() > x ? low : high) = middle;
    }
    return 1 - std::abs(at(side * low).z());
  }
};

// Newton's method by differences: the terms that give these sags (as shares of the half height).
EggOutline outline_with(double belly_sag, double back_sag) {
  EggOutline outline{0, 0};
  const Eigen::Vector2d wanted(belly_sag, back_sag);
  const auto sags = [](const EggOutline& o) { return Eigen::Vector2d(o.sag(-1), o.sag(1)); };
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Eigen::Vector2d now = sags(outline);
    if ((now - wanted).norm() < 1e-10) break;
    constexpr double h = 1e-5;
    Eigen::Matrix2d slopes;
    slopes.col(0) = (sags({outline.even + h, outline.odd}) - now) / h;
    slopes.col(1) = (sags({outline.even, outline.odd + h}) - now) / h;
    const Eigen::Vector2d step = slopes.fullPivLu().solve(wanted - now);
    const double share = std::min(1.0, 0.1 / step.norm());
    outline.even += share * step[0];
    outline.odd += share * step[1];
  }
  // Beyond a half the pole or the middle of the back is hollow; that is no egg.
  const bool found = (sags(outline) - wanted).norm() < 1e-8;
  if (!found || outline.even > 0.48 || outline.even + std::abs(outline.odd) > 0.5)
    throw MeshError(
        "no egg shape has sags of {:.3g} and {:.3g} % of its height; an ellipsoid has 10 %, a measured embryo 9.4 and "
        "3.9 %",
        50 * belly_sag, 50 * back_sag);
  return outline;
}

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

}  // namespace

StarSurface smooth_surface(const PolygonSurface& surface) {
  const StarFit fit = fit_star_surface(surface.vertices);
  const double allowed = largest_roughness * fit.surface.half_axes().minCoeff();
  if (fit.largest_um > allowed)
    throw MeshError(
        "vertex {} at {} lies {:.2g} um from the fitted smooth surface; {:.2g} um are allowed: smooth the surface "
        "there",
        fit.largest_row, place_text(surface.vertices[fit.largest_row]), fit.largest_um, allowed);
  return fit.surface;
}

OuterShape shape_around(const StarSurface& smooth, const Vectors& vertices) {
  double outside = 0;
  for (const Vec3& vertex : vertices) outside = std::max(outside, smooth.closest(vertex).signed_distance_um);
  return OuterShape(std::make_shared<const StarSurface>(smooth)).moved_out(outside);
}

namespace {

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

StarSurface egg_surface(const EggShape& shape) {
  for (const double length : {shape.length_um, shape.width_um, shape.height_um})
    if (!(length > 0) || !std::isfinite(length))
      throw MeshError("an egg of {:.4g} x {:.4g} x {:.4g} um; lengths must be positive", shape.length_um,
                      shape.width_um, shape.height_um);
  Vec3 half_axes = 0.5 * Vec3(shape.length_um, shape.width_um, shape.height_um);
  EggOutline outline{0, 0};
  if (shape.belly_sag_um || shape.back_sag_um) {
    const double usual = 0.2 * half_axes.z();
    outline = outline_with(shape.belly_sag_um.value_or(usual) / half_axes.z(),
                           shape.back_sag_um.value_or(usual) / half_axes.z());
    half_axes.x() /= outline.half_length();
  }
  // The terms are polynomials of degree 5, so a fit to enough directions finds their harmonics to rounding.
  const Vectors directions = even_directions(400);
  std::vector<double> radii;
  for (const Vec3& d : directions) radii.push_back(1 + outline.even * even_term(d) + outline.odd * odd_term(d));
  const std::vector<double> weights(directions.size(), 1.0);
  return {Mat3::Identity(), half_axes, fit_harmonics(directions, radii, weights, egg_degree)};
}

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
      fmt::format("the points lie {:.2g} um (root mean square) from a smooth surface; row {} is farthest, {:.2g} um",
                  fit.rms_um, fit.largest_row, fit.largest_um));
  return tissue;
}

}  // namespace plica
