#include "record/polygon_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "core/errors.hpp"
#include "record/csv.hpp"

namespace plica {
namespace {

/// Polygons stored in the frame, or the element faces if every cell is one element.
FramePolygons polygons_of(const Frame& frame) {
  if (!frame.polygons.empty()) return frame.polygons;
  const auto ids = frame.element_scalars.find("cell_id");
  if (ids == frame.element_scalars.end() ||
      std::set(ids->second.begin(), ids->second.end()).size() < frame.elements.size())
    throw FileError("the snapshot has no cell polygons (written by an older version of plica); repeat the run");
  FramePolygons polygons;
  for (std::size_t e = 0; e < frame.elements.size(); ++e) {
    for (int i = 0; i < 4; ++i) {
      polygons.basal.push_back(frame.elements[e][i].number());
      polygons.apical.push_back(frame.elements[e][i + 4].number());
    }
    polygons.ends.push_back(static_cast<int>(polygons.apical.size()));
    polygons.elements.push_back(static_cast<int>(e));
  }
  return polygons;
}

void check(const FramePolygons& polygons, const Frame& frame) {
  const auto below = [](const std::vector<int>& values, std::size_t count) {
    return std::ranges::all_of(values,
                               [&](int value) { return value >= 0 && static_cast<std::size_t>(value) < count; });
  };
  const std::size_t corners = polygons.apical.size();
  int before = 0;
  bool is_sound = polygons.basal.size() == corners && polygons.elements.size() == polygons.ends.size() &&
                  static_cast<std::size_t>(polygons.ends.back()) == corners &&
                  below(polygons.apical, frame.positions.size()) && below(polygons.basal, frame.positions.size()) &&
                  below(polygons.elements, frame.elements.size());
  for (const int end : polygons.ends) is_sound = is_sound && end - std::exchange(before, end) > 2;
  if (!is_sound) throw FileError("the polygons of the snapshot are damaged");
}

}  // namespace

SurfaceMesh surface_of(const Frame& frame, bool apical) {
  const FramePolygons polygons = polygons_of(frame);
  check(polygons, frame);
  const std::vector<int>& nodes = apical ? polygons.apical : polygons.basal;
  SurfaceMesh surface{
      .points = {}, .ends = polygons.ends, .corners = {}, .scalars = {}, .vectors = {}, .time_s = frame.time_s};
  std::vector<int> point(frame.positions.size(), -1), used;  // points by node, nodes by point
  for (const int node : nodes) {
    if (point[node] < 0) {
      point[node] = static_cast<int>(used.size());
      used.push_back(node);
    }
    surface.corners.push_back(point[node]);
  }
  const auto of_points = [&](const Vectors& of_nodes) {
    Vectors values;
    for (const int node : used) values.push_back(of_nodes[node]);
    return values;
  };
  surface.points = of_points(frame.positions);
  for (const auto& [name, vectors] : frame.node_vectors) surface.vectors.emplace_back(name, of_points(vectors));
  for (const auto& [name, values] : frame.element_scalars) {
    std::vector<double> of_cells;
    for (const int element : polygons.elements) of_cells.push_back(values[element]);
    surface.scalars.emplace_back(name, std::move(of_cells));
  }
  return surface;
}

PolygonTables tables_of(const SurfaceMesh& surface) {
  std::vector<double> vertices, edges, faces;
  const auto add = [](std::vector<double>& rows, std::initializer_list<double> values) {
    rows.insert(rows.end(), values);
  };
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    const Vec3& x = surface.points[v];
    add(vertices, {static_cast<double>(v), x.x(), x.y(), x.z()});
  }
  const auto for_edges = [&](const auto& take) {
    int first = 0;
    for (std::size_t f = 0; f < surface.ends.size(); ++f) {
      const int end = surface.ends[f];
      for (int i = first; i < end; ++i)
        take(static_cast<int>(f), surface.corners[i], surface.corners[i + 1 < end ? i + 1 : first]);
      first = end;
    }
  };
  std::map<std::pair<int, int>, int> number;  // of half-edges, by their ends
  for_edges([&](int, int from, int to) { number.emplace(std::pair(from, to), static_cast<int>(number.size())); });
  std::vector<double> perimeters(surface.ends.size(), 0.0);
  int edge = 0;
  for_edges([&](int face, int from, int to) {
    const Vec3 along = surface.points[to] - surface.points[from];
    const auto opposite = number.find({to, from});
    perimeters[face] += along.norm();
    add(edges,
        {static_cast<double>(edge++), static_cast<double>(from), static_cast<double>(to), static_cast<double>(face),
         opposite == number.end() ? -1.0 : opposite->second, along.x(), along.y(), along.z(), along.norm()});
  });
  int first = 0;
  for (std::size_t f = 0; f < surface.ends.size(); ++f) {
    const std::span<const int> corners = std::span(surface.corners).subspan(first, surface.ends[f] - first);
    first = surface.ends[f];
    Vec3 middle = Vec3::Zero();
    for (const int corner : corners) middle += surface.points[corner];
    middle /= static_cast<double>(corners.size());
    double area = 0;  // of the triangles about the middle
    for (std::size_t i = 0; i < corners.size(); ++i)
      area += 0.5 * (surface.points[corners[i]] - middle)
                        .cross(surface.points[corners[(i + 1) % corners.size()]] - middle)
                        .norm();
    add(faces, {static_cast<double>(f), middle.x(), middle.y(), middle.z(), static_cast<double>(corners.size()), area,
                perimeters[f]});
    for (const auto& [name, values] : surface.scalars) faces.push_back(values[f]);
  }
  const auto table = [](const std::string& columns, const std::vector<double>& rows) {
    return columns + '\n' + csv_rows(rows, static_cast<std::size_t>(std::ranges::count(columns, ',')) + 1) + '\n';
  };
  std::string of_faces = "face,x,y,z,num_sides,area,perimeter";
  for (const auto& [name, values] : surface.scalars) of_faces += ',' + name;
  return {table("vert,x,y,z", vertices), table("edge,srce,trgt,face,opposite,dx,dy,dz,length", edges),
          table(of_faces, faces)};
}

}  // namespace plica
