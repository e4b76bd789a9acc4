// External polygon surfaces: checked, and repaired where that is safe.
#pragma once

#include <string>
#include <vector>

#include "tissue/shapes/polygon_surface.hpp"

namespace plica {

struct MendedSurface {
  std::vector<std::string> remarks;  // repairs, one per line
  bool is_closed = false;
  std::vector<std::size_t> kept;  // former numbers of the faces
};

/// Make one sheet of `surface` in which neighbours share vertices and all faces look outward. Unused vertices are
/// dropped, and repeated corners of a face. With `keep_largest`, only the largest piece stays. With `mend`, coincident
/// vertices are merged; faces wound against the majority are reversed (all, if they look inward); vertices along an
/// edge between two faces, or on a straight or slightly concave boundary, are dropped; short edges are lengthened and
/// wide angles sharpened, by `options`.
///
/// MeshError, naming a face and its place, if a vertex is not finite; a face has fewer than three corners, passes a
/// corner twice, has no area, or is not convex or far from flat; an edge has more than two faces; the surface touches
/// itself at a vertex, is one-sided or disconnected; or a repair is needed but `mend` is false. More or fewer than
/// three faces may meet at a vertex.
MendedSurface check_and_mend(PolygonSurface& surface, bool mend, const PolygonOptions& options = {},
                             bool keep_largest = false);

/// Largest angle between the plane of a face and the triangles about its middle, which limits warping.
inline constexpr double largest_warp_deg = 40;

}  // namespace plica
