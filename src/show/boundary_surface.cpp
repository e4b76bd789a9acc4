#include "show/boundary_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "show/looks.hpp"
#include "tissue/hexahedron.hpp"
#include "tissue/mesh_faces.hpp"

namespace plica {
namespace {

// Sort corners around their centre, as seen along the axis.
void sort_around_middle(const Frame& frame, int axis, std::vector<CutPolygon::Corner>& corners) {
  const int across = (axis + 1) % 3, up = (axis + 2) % 3;
  Vec3 middle = Vec3::Zero();
  for (const auto& corner : corners) middle += corner.of(frame.positions) / static_cast<double>(corners.size());
  std::ranges::sort(corners, {}, [&](const auto& corner) {
    const Vec3 from_middle = corner.of(frame.positions) - middle;
    return std::atan2(from_middle[up], from_middle[across]);
  });
}

// Add a corner where the plane cuts an edge.
void cut_edge(const Frame& frame, NodeId first, NodeId second, int axis, double at_um, CutPolygon& polygon) {
  const double before = frame.positions[first.index()][axis] - at_um;
  const double after = frame.positions[second.index()][axis] - at_um;
  if ((before < 0) != (after < 0)) polygon.corners.push_back({first, second, before / (before - after)});
}

}  // namespace

BoundarySurface boundary_surface_of(const Frame& frame) {
  const std::vector<double>& ids = values_in(frame.element_scalars, "cell_id");
  BoundarySurface boundary;
  for (const CellFace& face : MeshFaces(frame.elements).surface())
    boundary.facets.push_back({face_nodes(frame.elements[face.cell], face.face), face.cell, face.face});
  // An edge between two facets of one face of one cell is inside that face.
  using Place = std::pair<double, int>;
  std::map<std::array<NodeId, 2>, std::vector<Place>> edges;
  for (const BoundaryFacet& facet : boundary.facets)
    for (int i = 0; i < 4; ++i) {
      std::array<NodeId, 2> edge = {facet.nodes[i], facet.nodes[(i + 1) % 4]};
      if (edge[1] < edge[0]) std::swap(edge[0], edge[1]);
      edges[edge].emplace_back(ids[facet.element], facet.face);
    }
  for (const auto& [edge, places] : edges)
    if (places.size() != 2 || places[0] != places[1]) boundary.outlines.push_back(edge);
  return boundary;
}

std::vector<CutPolygon> cut_by_plane(const Frame& frame, int axis, double at_um) {
  std::vector<CutPolygon> polygons;
  for (std::size_t e = 0; e < frame.elements.size(); ++e) {
    CutPolygon polygon{e, {}};
    for (const auto& [a, b] : hex_edges)
      cut_edge(frame, frame.elements[e][a], frame.elements[e][b], axis, at_um, polygon);
    if (polygon.corners.size() < 3) continue;
    sort_around_middle(frame, axis, polygon.corners);
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

std::vector<CutPolygon> cut_apical_surface(const Frame& frame, int axis, double at_um) {
  std::vector<CutPolygon> cuts;
  for (const CellFace& face : MeshFaces(frame.elements).surface()) {
    if (face.face != apical_face) continue;
    const auto nodes = face_nodes(frame.elements[face.cell], face.face);
    CutPolygon cut{face.cell, {}};
    for (int i = 0; i < 4; ++i) cut_edge(frame, nodes[i], nodes[(i + 1) % 4], axis, at_um, cut);
    if (cut.corners.size() == 2) cuts.push_back(std::move(cut));
  }
  return cuts;
}

}  // namespace plica
