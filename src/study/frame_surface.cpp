#include "study/frame_surface.hpp"

#include <algorithm>
#include <cmath>

#include "tissue/mesh_faces.hpp"

namespace plica {
namespace {

constexpr int samples = 4;  // of a facet in each direction
constexpr int pieces = 8;   // the same, of its triangles; a multiple, so that samples are corners of triangles
constexpr int basal_face = 4, apical_face = 5;

using Corners = std::array<Vec3, 4>;

Vec3 point_at(const Corners& x, double u, double v) {
  return (1 - u) * (1 - v) * x[0] + u * (1 - v) * x[1] + u * v * x[2] + (1 - u) * v * x[3];
}

/// Area density of the facet at (u, v).
double stretch_at(const Corners& x, double u, double v) {
  const Vec3 along_u = (1 - v) * (x[1] - x[0]) + v * (x[2] - x[3]);
  const Vec3 along_v = (1 - u) * (x[3] - x[0]) + u * (x[2] - x[1]);
  return along_u.cross(along_v).norm();
}

Quads facets_on(const Frame& frame, int face) {
  const MeshFaces faces(frame.elements);
  Quads facets;
  for (std::size_t e = 0; e < frame.elements.size(); ++e)
    if (faces.on_surface({e, face})) facets.push_back(face_nodes(frame.elements[e], face));
  return facets;
}

/// Fill missing node values with the mean of their neighbours, from the surfaces inwards.
void fill_between(const Frame& frame, std::vector<std::optional<double>>& values) {
  while (!std::ranges::all_of(values, [](const auto& value) { return value.has_value(); })) {
    std::vector<double> sums(values.size(), 0.0);
    std::vector<int> counts(values.size(), 0);
    for (const auto& element : frame.elements)
      for (const auto& [a, b] : hex_edges)
        for (const auto& [from, to] : {std::pair(element[a], element[b]), std::pair(element[b], element[a])})
          if (values[from.index()] && !values[to.index()]) {
            sums[to.index()] += *values[from.index()];
            ++counts[to.index()];
          }
    bool any = false;
    for (std::size_t n = 0; n < values.size(); ++n)
      if (counts[n] > 0) values[n] = sums[n] / counts[n], any = true;
    if (!any) break;
  }
}

}  // namespace

Quads apical_facets(const Frame& frame) { return facets_on(frame, apical_face); }
Quads basal_facets(const Frame& frame) { return facets_on(frame, basal_face); }

double total_area(const Frame& frame, const Quads& facets) {
  double area = 0;
  for (const auto& facet : facets) area += facet_area(gather(frame.positions, facet));
  return area;
}

TriangleSurface fine_triangles(const Frame& frame, const Quads& facets) {
  TriangleSurface surface;
  for (const auto& facet : facets) {
    const Corners corners = gather(frame.positions, facet);
    const int first = static_cast<int>(surface.points.size());
    constexpr int row = pieces + 1, middles = row * row;
    for (int j = 0; j <= pieces; ++j)
      for (int i = 0; i <= pieces; ++i)
        surface.points.push_back(point_at(corners, double(i) / pieces, double(j) / pieces));
    for (int j = 0; j < pieces; ++j)
      for (int i = 0; i < pieces; ++i) {
        surface.points.push_back(point_at(corners, (i + 0.5) / pieces, (j + 0.5) / pieces));
        const int a = first + i + row * j, middle = first + middles + i + pieces * j;
        const std::array<int, 4> around = {a, a + 1, a + 1 + row, a + row};
        for (int k = 0; k < 4; ++k) surface.triangles.push_back({around[k], around[(k + 1) % 4], middle});
      }
  }
  return surface;
}

double facet_error(const Frame& frame, const Quads& facets) {
  // In a piece of twist t, uv lies at most 1/16 off its triangles about the middle; a piece has twist/16.
  double largest = 0;
  for (const auto& facet : facets) {
    const Corners x = gather(frame.positions, facet);
    largest = std::max(largest, (x[0] - x[1] + x[2] - x[3]).norm() / (16 * pieces * pieces));
  }
  return largest;
}

Distances distances_to(const SurfaceDistance& other, const Frame& frame, const Quads& facets) {
  Distances result;
  double area = 0;
  for (const auto& facet : facets) {
    const Corners corners = gather(frame.positions, facet);
    for (int j = 0; j < samples; ++j)
      for (int i = 0; i < samples; ++i) {
        const double u = (i + 0.5) / samples, v = (j + 0.5) / samples;
        const double distance = other.from(point_at(corners, u, v)), weight = stretch_at(corners, u, v);
        result.mean += weight * distance;
        result.rms += weight * distance * distance;
        result.max = std::max(result.max, distance);
        area += weight;
      }
    for (int j = 0; j <= samples; ++j)
      for (int i = 0; i <= samples; ++i)
        result.max = std::max(result.max, other.from(point_at(corners, double(i) / samples, double(j) / samples)));
  }
  if (area > 0) result.mean /= area, result.rms = std::sqrt(result.rms / area);
  return result;
}

std::vector<double> node_distances(const Frame& frame, const Frame& other) {
  std::vector<std::optional<double>> values(frame.positions.size());
  for (const auto& side : {basal_facets, apical_facets}) {
    const SurfaceDistance surface(fine_triangles(other, side(other)));
    for (const auto& facet : side(frame))
      for (const NodeId node : facet) values[node.index()] = surface.from(frame.positions[node.index()]);
  }
  fill_between(frame, values);
  std::vector<double> result;
  result.reserve(values.size());
  for (const std::optional<double>& value : values) result.push_back(value.value_or(0));
  return result;
}

}  // namespace plica
