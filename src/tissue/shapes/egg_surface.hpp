// The shape of an egg by a few lengths: an ellipsoid whose back is flatter than its belly.
//
// With d the direction in coordinates scaled by the half-axes, and s = d_x, the scaled radius is
//   1 + even s^2 (1 - s^2) + odd d_z s^2 (1 - s^2 / 2).
// The even term raises the shoulders on all sides and makes the poles blunter. The odd term raises those of the back
// and lowers those of the belly, and tilts the poles towards the back, as bending the axis does. Both leave the section
// in the middle as it is. (Two half-axes c, blended, would not flatten both sides; a bent axis is no function of
// direction.)
#pragma once

#include <optional>

#include "tissue/shapes/star_surface.hpp"

namespace plica {

struct EggShape {
  double length_um = 500;  // along x
  double width_um = 180;   // along y
  double height_um = 180;  // along z; the belly is at -z
  // How far the outline in the plane y = 0 lies, in the middle, beyond its chord from 20 to 80 % of the length. Both or
  // none: without them an ellipsoid, whose sags are a tenth of its height. A measured embryo's: 17 and 7.
  std::optional<double> belly_sag_um, back_sag_um;
};

/// MeshError when a length is not positive, or no such surface has these sags: each may be from some 4 to 17 % of the
/// height, smaller ones would make the back hollow.
StarSurface egg_surface(const EggShape& shape);

}  // namespace plica
