#include "show/boundary_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/errors.hpp"
#include "tissue/hexahedron.hpp"
#include "tissue/mesh_faces.hpp"

namespace plica {
namespace {

// Sort corners around their centre, as seen along the axis.
void sort_around_middle(const Frame& frame, int axis, std::vector<CutPolygon::Corner>& corners) {
  const int across = (axis + 1) % 3, up = (axis + 2) % 3;
  const auto place = [&](const CutPolygon::Corner& corner) -> Vec3 {
    return (1 - corner.part) * frame.positions[corner.first.index()] +
           corner.part * frame.positions[corner.second.index()];
  };
  Vec3 middle = Vec3::Zero();
  for (const auto& corner : corners) middle += place(corner) / static_cast<double>(corners.size());
  std::ranges::sort(corners, {}, [&](const auto& corner) {
    const Vec3 from_middle = place(corner) - middle;
    return std::atan2(from_middle[up], from_middle[across]);
  });
}

}  // namespace

BoundarySurface boundary_surface_of(const Frame& frame) {
  const auto ids = frame.element_scalars.find("cell_id");
  if (ids == frame.element_scalars.end())
    throw FileError("the snapshot has no array cell_id; give one written by plica");
  BoundarySurface boundary;
  for (const CellFace& face : MeshFaces(frame.elements).surface()) {
    BoundaryFacet facet{{}, face.cell, face.face};
    for (int i = 0; i < 4; ++i) facet.nodes[i] = frame.elements[face.cell][hex_faces[face.face][i]];
    boundary.facets.push_back(facet);
  }
  // An edge between two facets of one face of one cell is inside that face.
  using Place = std::pair<double, int>;
  std::map<std::array<NodeId, 2>, std::vector<Place>> edges;
  for (const BoundaryFacet& facet : boundary.facets)
    for (int i = 0; i < 4; ++i) {
      std::array<NodeId, 2> edge = {facet.nodes[i], facet.nodes[(i + 1) % 4]};
      if (edge[1] < edge[0]) std::swap(edge[0], edge[1]);
      edges[edge].emplace_back(ids->second[facet.element], facet.face);
    }
  for (const auto& [edge, places] : edges)
    if (places.size() != 2 || places[0] != places[1]) boundary.outlines.push_back(edge);
  return boundary;
}

std::vector<CutPolygon> cut_by_plane(const Frame& frame, int axis, double at_um) {
  std::vector<CutPolygon> polygons;
  for (std::size_t e = 0; e < frame.elements.size(); ++e) {
    CutPolygon polygon{e, {}};
    for (const auto& [a, b] : hex_edges) {
      const NodeId first = frame.elements[e][a], second = frame.elements[e][b];
      const double before = frame.positions[first.index()][axis] - at_um;
      const double after = frame.positions[second.index()][axis] - at_um;
      if ((before < 0) != (after < 0)) polygon.corners.push_back({first, second, before / (before - after)});
    }
    if (polygon.corners.size() < 3) continue;
    sort_around_middle(frame, axis, polygon.corners);
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

}  // namespace plica
