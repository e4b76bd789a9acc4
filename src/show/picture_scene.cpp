#include "show/picture_scene.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "show/boundary_surface.hpp"

namespace plica {
namespace {

Vec3 place_of(const Frame& frame, const CutPolygon::Corner& corner) {
  return (1 - corner.part) * frame.positions[corner.first.index()] +
         corner.part * frame.positions[corner.second.index()];
}

// Triangulate a polygon about its centre, which preserves symmetry.
void add_fan(const Vectors& polygon, const std::vector<double>& values, const Vec3& normal, Scene& scene) {
  Vec3 middle = Vec3::Zero();
  double mean = 0;
  const auto count = static_cast<double>(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) middle += polygon[i] / count, mean += values[i] / count;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    scene.corners.insert(scene.corners.end(), {polygon[i], polygon[next], middle});
    scene.values.insert(scene.values.end(), {values[i], values[next], mean});
    scene.normals.insert(scene.normals.end(), 3, normal);
  }
}

void add_surface(const Frame& frame, const ColourField& field, Scene& scene) {
  const std::vector<double> values = field_values(frame, field);
  const BoundarySurface boundary = boundary_surface_of(frame);
  for (const BoundaryFacet& facet : boundary.facets) {
    Vectors corners;
    std::vector<double> at_corners;
    for (const NodeId node : facet.nodes) {
      corners.push_back(frame.positions[node.index()]);
      at_corners.push_back(field.on_nodes ? values[node.index()] : values[facet.element]);
    }
    const Vec3 normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalized();
    add_fan(corners, at_corners, normal, scene);
  }
  for (const auto& [first, second] : boundary.outlines)
    scene.outlines.push_back({frame.positions[first.index()], frame.positions[second.index()]});
}

// Edges of the polygons, except those between two elements of one cell.
void add_cut_outlines(const Frame& frame, const std::vector<CutPolygon>& polygons, Scene& scene) {
  using CutEdge = std::pair<NodeId, NodeId>;  // mesh edge on which a corner lies
  struct Side {
    Segment segment;
    double cell = 0;
    int times = 0;  // occurrences in this cell
  };
  std::map<std::pair<CutEdge, CutEdge>, std::vector<Side>> sides;
  const auto edge_of = [](const CutPolygon::Corner& corner) { return std::minmax(corner.first, corner.second); };
  const std::vector<double>& cells = frame.element_scalars.at("cell_id");
  for (const CutPolygon& polygon : polygons)
    for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
      const auto &first = polygon.corners[i], &second = polygon.corners[(i + 1) % polygon.corners.size()];
      const CutEdge a = edge_of(first), b = edge_of(second);
      std::vector<Side>& here = sides[std::minmax(a, b)];
      const double cell = cells[polygon.element];
      if (!here.empty() && here.back().cell == cell)
        ++here.back().times;
      else
        here.push_back({{place_of(frame, first), place_of(frame, second)}, cell, 1});
    }
  for (const auto& [edges, here] : sides)
    if (here.size() > 1 || here.front().times == 1) scene.outlines.push_back(here.front().segment);
}

void add_section(const Frame& frame, const ColourField& field, const View& view, Scene& scene) {
  const std::vector<double> values = field_values(frame, field);
  const std::vector<CutPolygon> polygons = cut_by_plane(frame, *view.cut_axis, view.cut_um);
  for (const CutPolygon& polygon : polygons) {
    Vectors corners;
    std::vector<double> at_corners;
    for (const CutPolygon::Corner& corner : polygon.corners) {
      corners.push_back(place_of(frame, corner));
      at_corners.push_back(field.on_nodes ? (1 - corner.part) * values[corner.first.index()] +
                                                corner.part * values[corner.second.index()]
                                          : values[polygon.element]);
    }
    add_fan(corners, at_corners, -view.sight.normalized(), scene);
  }
  add_cut_outlines(frame, polygons, scene);
}

// Section of the boundary surface by the plane of a view.
std::vector<Segment> cut_outer_side(const Frame& frame, int axis, double at_um) {
  std::vector<Segment> segments;
  for (const BoundaryFacet& facet : boundary_surface_of(frame).facets) {
    if (facet.face != apical_face) continue;
    Vectors crossings;
    for (int i = 0; i < 4; ++i) {
      const Vec3 &from = frame.positions[facet.nodes[i].index()],
                 &to = frame.positions[facet.nodes[(i + 1) % 4].index()];
      const double before = from[axis] - at_um, after = to[axis] - at_um;
      if ((before < 0) != (after < 0)) crossings.push_back(from + before / (before - after) * (to - from));
    }
    if (crossings.size() == 2) segments.push_back({crossings[0], crossings[1]});
  }
  return segments;
}

// Band along the outline of the shell in a view: two half circles about the projected ends of its axis.
Vectors shell_band(const Capsule& shell, const View& view, double band_um) {
  constexpr int pieces = 180;  // of each half circle
  const auto [right, up] = screenwise(view);
  const std::array<double, 2> end = {shell.half_axis_um * right.x(), shell.half_axis_um * up.x()};
  const double turn = std::atan2(end[1], end[0]);
  Vectors inner, outer;
  for (int i = 0; i <= 2 * pieces + 1; ++i) {
    const bool back = i > pieces;  // around the other end
    const double angle = turn - std::numbers::pi / 2 + std::numbers::pi * (back ? i - 1 : i) / pieces;
    const Vec3 direction = std::cos(angle) * right + std::sin(angle) * up;
    const Vec3 centre = (back ? -1 : 1) * (end[0] * right + end[1] * up);
    inner.push_back(centre + shell.radius_um * direction);
    outer.push_back(centre + (shell.radius_um + band_um) * direction);
  }
  Vectors triangles;
  for (std::size_t i = 0; i < inner.size(); ++i) {
    const std::size_t next = (i + 1) % inner.size();
    triangles.insert(triangles.end(), {inner[i], outer[i], outer[next], inner[i], outer[next], inner[next]});
  }
  return triangles;
}

}  // namespace

Screenwise screenwise(const View& view) {
  const Vec3 sight = view.sight.normalized(), right = sight.cross(view.up).normalized();
  return {right, right.cross(sight)};
}

std::array<double, 2> half_size_um(const Vectors& positions, const View& view) {
  const auto [right, up] = screenwise(view);
  std::array<double, 2> half = {0, 0};
  for (const Vec3& position : positions) {
    half[0] = std::max(half[0], std::abs(position.dot(right)));
    half[1] = std::max(half[1], std::abs(position.dot(up)));
  }
  return half;
}

Scene make_scene(const Picture& picture, const PictureColumn& column, const View& view, double band_um) {
  Scene scene;
  if (view.cut_axis) {
    scene.lit = false;
    add_section(column.frame, picture.field, view, scene);
    if (picture.rest && !picture.shell) scene.rest = cut_outer_side(*picture.rest, *view.cut_axis, view.cut_um);
  } else {
    add_surface(column.frame, picture.field, scene);
  }
  if (!picture.edges) scene.outlines.clear();
  if (picture.shell) scene.shell = shell_band(*picture.shell, view, band_um);
  return scene;
}

}  // namespace plica
