#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "show/boundary_surface.hpp"
#include "show/picture_layout.hpp"

namespace plica {
namespace {

// Triangulate a polygon about its centre, which preserves symmetry. Without a normal, it is that of a facet.
void add_polygon(const Frame& frame, const ColourField& field, const std::vector<double>& values,
                 const CutPolygon& polygon, const std::optional<Vec3>& normal, Scene& scene) {
  const auto count = static_cast<double>(polygon.corners.size());
  Vectors places;
  std::vector<double> at_places;
  Vec3 middle = Vec3::Zero();
  double mean = 0;
  for (const CutPolygon::Corner& corner : polygon.corners) {
    places.push_back(corner.of(frame.positions));
    at_places.push_back(field.on_nodes ? corner.of(values) : values[polygon.element]);
    middle += places.back() / count, mean += at_places.back() / count;
  }
  const Vec3 seen = normal ? *normal : (places[2] - places[0]).cross(places[3] - places[1]).normalized();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t next = (i + 1) % places.size();
    scene.corners.insert(scene.corners.end(), {places[i], places[next], middle});
    scene.values.insert(scene.values.end(), {at_places[i], at_places[next], mean});
    scene.normals.insert(scene.normals.end(), 3, seen);
  }
}

void add_surface(const Frame& frame, const ColourField& field, Scene& scene) {
  const std::vector<double> values = field_values(frame, field);
  const BoundarySurface boundary = boundary_surface_of(frame);
  for (const BoundaryFacet& facet : boundary.facets) {
    CutPolygon polygon{facet.element, {}};
    for (const NodeId node : facet.nodes) polygon.corners.push_back({node, node, 0});
    add_polygon(frame, field, values, polygon, {}, scene);
  }
  for (const auto& [first, second] : boundary.outlines)
    scene.outlines.push_back({frame.positions[first.index()], frame.positions[second.index()]});
}

// Section of the cells, and its outlines: edges of polygons, except those between two elements of one cell.
void add_section(const Frame& frame, const ColourField& field, const View& view, Scene& scene) {
  const std::vector<double> values = field_values(frame, field);
  const std::vector<double>& cells = values_in(frame.element_scalars, "cell_id");
  using CutEdge = std::pair<NodeId, NodeId>;  // mesh edge on which a corner lies
  const auto edge_of = [](const CutPolygon::Corner& corner) {
    return CutEdge(std::minmax(corner.first, corner.second));
  };
  struct Side {
    Segment segment;
    std::vector<double> cells;
  };
  std::map<std::pair<CutEdge, CutEdge>, Side> sides;
  for (const CutPolygon& polygon : cut_by_plane(frame, *view.cut_axis, view.cut_um)) {
    add_polygon(frame, field, values, polygon, -view.sight.normalized(), scene);
    for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
      const auto &first = polygon.corners[i], &second = polygon.corners[(i + 1) % polygon.corners.size()];
      Side& side = sides[std::minmax(edge_of(first), edge_of(second))];
      if (side.cells.empty()) side.segment = {first.of(frame.positions), second.of(frame.positions)};
      side.cells.push_back(cells[polygon.element]);
    }
  }
  for (const auto& [edges, side] : sides)
    if (side.cells.size() != 2 || side.cells[0] != side.cells[1]) scene.outlines.push_back(side.segment);
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
    if (picture.rest && !picture.shell)
      for (const CutPolygon& cut : cut_apical_surface(*picture.rest, *view.cut_axis, view.cut_um))
        scene.rest.push_back({cut.corners[0].of(picture.rest->positions), cut.corners[1].of(picture.rest->positions)});
  } else {
    add_surface(column.frame, picture.field, scene);
  }
  if (!picture.edges) scene.outlines.clear();
  if (picture.shell) scene.shell = shell_band(*picture.shell, view, band_um);
  return scene;
}

}  // namespace plica
