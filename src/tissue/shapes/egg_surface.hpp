// Egg shape from a few lengths: an ellipsoid whose dorsal side is flatter than its ventral side.
//
// With d the direction in coordinates scaled by the half-axes, and s = d_x, the scaled radius is
//   1 + even s^2 (1 - s^2) + odd d_z s^2 (1 - s^2 / 2).
// The even term raises the shoulders on all sides and makes the poles blunter. The odd term raises the dorsal
// and lowers the ventral shoulders, and tilts the poles dorsally, like bending the axis. Both keep the middle section.
// (Two blended half-axes c would not flatten both sides; a bent axis is not a function of direction.)
#pragma once

#include <optional>

#include "tissue/shapes/star_surface.hpp"

namespace plica {

struct EggShape {
  double length_um = 500;  // along x
  double width_um = 180;   // along y
  double height_um = 180;  // along z; ventral at -z
  // Sags: distance of the outline in the plane y = 0, at its middle, from its chord from 20 to 80 % of the length. Both
  // or none; default: an ellipsoid, with sags of a tenth of its height. Measured embryo: 17 and 7.
  std::optional<double> belly_sag_um, back_sag_um;
};

/// Make the surface. MeshError if a length is not positive, or no such surface has these sags: each may be about 4 to
/// 17 % of the height; smaller ones would make the dorsal side concave.
StarSurface egg_surface(const EggShape& shape);

}  // namespace plica
