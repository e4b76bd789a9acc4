// Where the corners of a shell's cells lie: a surface grid laid on the middle surface of the sheet, its squares as even
// as they get. docs/how-to/embryos.md says how even that is.
#pragma once

#include "core/vector.hpp"
#include "tissue/shapes/surface_grid.hpp"

namespace plica {

/// The middle surface of a sheet: a capsule along x, or a sphere.
class MidSurface {
 public:
  /// A place on it: a foot on the axis and a unit normal.
  struct Place {
    double foot_x;
    Vec3 normal;
  };

  MidSurface(double half_axis_um, double radius_um) : half_axis_(half_axis_um), radius_(radius_um) {}

  /// The place nearest to the point.
  [[nodiscard]] Place project(const Vec3& point) const;

  /// The point at `offset` from the surface, outward.
  [[nodiscard]] Vec3 point(const Place& place, double offset = 0) const {
    return Vec3(place.foot_x, 0, 0) + (radius_ + offset) * place.normal;
  }

  /// Equal arcs along the axis, equal angles around it and on the caps. `box` is in [-1, 1]^3, on the box's surface.
  [[nodiscard]] Vec3 by_equal_angles(const Vec3& box) const;

 private:
  double half_axis_, radius_;
};

/// Positions of the grid's vertices on the surface. Symmetric about the three planes to the bit. No square is folded.
Vectors even_positions(const SurfaceGrid& grid, const MidSurface& surface);

/// Positions of the vertices of another grid on the same box: bilinear between the vertices of the coarse one, then
/// projected. Symmetric to the bit.
Vectors refined_positions(const SurfaceGrid& coarse, const Vectors& positions, const SurfaceGrid& fine,
                          const MidSurface& surface);

}  // namespace plica
