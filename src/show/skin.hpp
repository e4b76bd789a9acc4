// What is seen of a frame from outside: its outer facets, and the outlines of cells on them; and what a plane shows of
// its inside.
#pragma once

#include <array>
#include <vector>

#include "tissue/files/frame_file.hpp"

namespace plica {

inline constexpr int apical_face = 5;  // of an element, in the order of hex_faces

struct SkinFacet {
  std::array<NodeId, 4> nodes;  // counter-clockwise, seen from outside
  std::size_t element = 0;
  int face = 0;  // of the element, in the order of hex_faces: 4 basal, 5 apical_face
};

/// The facets that no two elements share, and those of their edges that part two cells or two faces of one.
/// (Where neighbours are cut differently, walls between them that do not match count as outer, too. They lie inside the
/// sheet, where nobody sees them.)
struct Skin {
  std::vector<SkinFacet> facets;
  std::vector<std::array<NodeId, 2>> outlines;
};

/// FileError when the frame has no `cell_id`; MeshError when its elements do not fit together.
Skin skin_of(const Frame& frame);

/// Where a plane cuts an element: a polygon around its middle.
struct CutPolygon {
  std::size_t element = 0;
  /// A corner lies between two nodes: (1 - part) * first + part * second.
  struct Corner {
    NodeId first, second;
    double part = 0;
  };
  std::vector<Corner> corners;
};

/// The elements that the plane `axis` = `at_um` cuts.
std::vector<CutPolygon> cut_by_plane(const Frame& frame, int axis, double at_um);

}  // namespace plica
