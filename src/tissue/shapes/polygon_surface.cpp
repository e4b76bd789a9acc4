#include "tissue/shapes/polygon_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/place.hpp"

namespace plica {
namespace {

Vec3 mean_corner(const Vectors& vertices, const std::vector<std::size_t>& polygon) {
  Vec3 sum = Vec3::Zero();
  for (const std::size_t vertex : polygon) sum += vertices[vertex];
  return sum / static_cast<double>(polygon.size());
}

// One side of a polygon, to be matched with that of its neighbour.
struct Side {
  std::size_t low, high;  // vertices
  std::size_t polygon, place;
  bool rises;  // from low to high
};

std::vector<Side> sorted_sides(const PolygonSurface& surface) {
  std::vector<Side> sides;
  for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
    const auto& polygon = surface.polygons[p];
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::size_t from = surface.periods.original(polygon[k]),
                        to = surface.periods.original(polygon[(k + 1) % polygon.size()]);
      sides.push_back({std::min(from, to), std::max(from, to), p, k, from < to});
    }
  }
  std::ranges::stable_sort(sides, {}, [](const Side& side) { return std::pair(side.low, side.high); });
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    if (sides[i].low != sides[i + 1].low || sides[i].high != sides[i + 1].high) continue;
    const bool third = i + 2 < sides.size() && sides[i + 2].low == sides[i].low && sides[i + 2].high == sides[i].high;
    if (third || sides[i].rises == sides[i + 1].rises)
      throw MeshError(
          fmt::format("the edge between vertices {} and {} at {} {}; each edge must belong to two "
                      "cells that traverse it in opposite directions",
                      sides[i].low, sides[i].high, place_text(surface.vertices[sides[i].low]),
                      third ? "belongs to more than two cells" : "runs the same way in two cells"));
    ++i;
  }
  return sides;
}

}  // namespace

Vec3 area_vector(const Vectors& vertices, const std::vector<std::size_t>& polygon) {
  const Vec3 centre = mean_corner(vertices, polygon);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < polygon.size(); ++k)
    sum += (vertices[polygon[k]] - centre).cross(vertices[polygon[(k + 1) % polygon.size()]] - centre);
  return 0.5 * sum;
}

PolygonFan fan_about(const Vectors& vertices, const std::vector<std::size_t>& polygon, const Vec3& centre) {
  PolygonFan fan{0, Vec3::Zero()};
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3& a = vertices[polygon[k]];
    const Vec3& b = vertices[polygon[(k + 1) % polygon.size()]];
    const double area = 0.5 * (a - centre).cross(b - centre).norm();
    fan.area += area;
    fan.centroid += area / 3 * (a + b + centre);
  }
  if (fan.area > 0)
    fan.centroid /= fan.area;
  else
    fan.centroid = centre;
  return fan;
}

std::vector<double> polygon_areas(const PolygonSurface& surface) {
  std::vector<double> areas;
  areas.reserve(surface.polygons.size());
  for (const auto& polygon : surface.polygons)
    areas.push_back(fan_about(surface.vertices, polygon, mean_corner(surface.vertices, polygon)).area);
  return areas;
}

std::vector<std::vector<std::size_t>> polygon_neighbours(const PolygonSurface& surface) {
  std::vector<std::vector<std::size_t>> neighbours;
  for (const auto& polygon : surface.polygons) neighbours.emplace_back(polygon.size(), no_polygon);
  const std::vector<Side> sides = sorted_sides(surface);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    if (sides[i].low != sides[i + 1].low || sides[i].high != sides[i + 1].high) continue;
    neighbours[sides[i].polygon][sides[i].place] = sides[i + 1].polygon;
    neighbours[sides[i + 1].polygon][sides[i + 1].place] = sides[i].polygon;
  }
  return neighbours;
}

std::vector<PolygonEdge> polygon_edges(const PolygonSurface& surface) {
  const auto neighbours = polygon_neighbours(surface);
  std::vector<PolygonEdge> edges;
  for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
    const auto& polygon = surface.polygons[p];
    for (std::size_t k = 0; k < polygon.size(); ++k)
      // The lower polygon tells of the edge; two may share several edges, and each tells of its own.
      if (neighbours[p][k] == no_polygon || p < neighbours[p][k])
        edges.push_back({{polygon[k], polygon[(k + 1) % polygon.size()]}, p, neighbours[p][k]});
  }
  return edges;
}

std::vector<double> edge_lengths(const PolygonSurface& surface) {
  std::vector<double> lengths;
  for (const PolygonEdge& edge : polygon_edges(surface))
    lengths.push_back((surface.vertices[edge.vertices[1]] - surface.vertices[edge.vertices[0]]).norm());
  return lengths;
}

std::vector<std::size_t> corner_counts(const PolygonSurface& surface) {
  std::vector<std::size_t> counts;
  for (const auto& polygon : surface.polygons) {
    if (counts.size() <= polygon.size()) counts.resize(polygon.size() + 1, 0);
    ++counts[polygon.size()];
  }
  return counts;
}

}  // namespace plica
