// Boundary surface of a snapshot (outer facets and outlines of cells), and sections by a plane.
#pragma once

#include <array>
#include <vector>

#include "tissue/files/frame_file.hpp"

namespace plica {

inline constexpr int apical_face = 5;  // of an element, in the order of hex_faces

struct BoundaryFacet {
  std::array<NodeId, 4> nodes;  // counter-clockwise, seen from outside
  std::size_t element = 0;
  int face = 0;  // of the element, in the order of hex_faces: 4 basal, 5 apical_face
};

/// Facets of a single element, and their edges that separate two cells or two faces of one cell. (Lateral faces of
/// neighbours that are divided differently count as boundary; they lie inside the sheet, hidden from view.)
struct BoundarySurface {
  std::vector<BoundaryFacet> facets;
  std::vector<std::array<NodeId, 2>> outlines;
};

/// Extract the boundary surface. Throws FileError without `cell_id`, MeshError for an inconsistent mesh.
BoundarySurface boundary_surface_of(const Frame& frame);

/// Section of an element by a plane: polygon, ordered around its centre.
struct CutPolygon {
  std::size_t element = 0;
  /// Corner between two nodes: (1 - part) * first + part * second.
  struct Corner {
    NodeId first, second;
    double part = 0;

    /// Interpolate values of nodes.
    template <class Value>
    [[nodiscard]] Value of(const std::vector<Value>& nodes) const {
      return (1 - part) * nodes[first.index()] + part * nodes[second.index()];
    }
  };
  std::vector<Corner> corners;
};

/// Sections of the elements by the plane `axis` = `at_um`, and those of the apical surface: two corners per facet.
std::vector<CutPolygon> cut_by_plane(const Frame& frame, int axis, double at_um);
std::vector<CutPolygon> cut_apical_surface(const Frame& frame, int axis, double at_um);

}  // namespace plica
