// Surfaces of polygons that others have made: checked, and mended where that is safe.
#pragma once

#include <string>
#include <vector>

#include "tissue/shapes/polygon_mending.hpp"

namespace plica {

struct MendedSurface {
  std::vector<std::string> remarks;  // what was done, one a line
  bool is_closed = false;
};

/// Makes one sheet of `surface` in which neighbours share vertices and all faces look outward. Vertices that no face
/// uses are dropped. With `mend`, vertices in one place become one, faces that wind the other way than most are turned
/// (all, where they look inward), vertices along a wall between two faces, or a rim that is straight or bent inward
/// a little there, are dropped, short edges are lengthened and wide angles sharpened, as `options` say.
///
/// MeshError, which names a face and its place, when a vertex is no point, a face has fewer than three corners, one of
/// them twice, or no area, is not convex or far from flat; when an edge has more than two faces, the surface touches
/// itself at a vertex, has one side only or is more than one piece; or when mending is needed and `mend` is false.
/// Where more or fewer than three faces meet at a vertex, that is fine.
MendedSurface check_and_mend(PolygonSurface& surface, bool mend, const PolygonOptions& options = {});

/// Corners of a face may lie so far out of its plane: the angle between it and the triangles about the face's middle.
inline constexpr double largest_warp_deg = 40;

}  // namespace plica
