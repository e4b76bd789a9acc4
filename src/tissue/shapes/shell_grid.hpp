// Corners of the cells of a shell: a surface grid mapped to the middle surface of the sheet, with squares as even as
// possible (docs/how-to/embryos.md).
#pragma once

#include "core/vector.hpp"
#include "tissue/shapes/surface_grid.hpp"

namespace plica {

/// Middle surface of a sheet: a capsule along x, or a sphere.
class MidSurface {
 public:
  /// Place on it: a foot on the axis and a unit normal.
  struct Place {
    double foot_x;
    Vec3 normal;
  };

  MidSurface(double half_axis_um, double radius_um) : half_axis_(half_axis_um), radius_(radius_um) {}

  /// Return the place nearest to the point.
  [[nodiscard]] Place project(const Vec3& point) const;

  /// Return the point at `offset` outward from the surface.
  [[nodiscard]] Vec3 point(const Place& place, double offset = 0) const {
    return Vec3(place.foot_x, 0, 0) + (radius_ + offset) * place.normal;
  }

  /// Map a point of the surface of the box [-1, 1]^3 by equal arcs along the axis and equal angles around it and on the
  /// caps.
  [[nodiscard]] Vec3 by_equal_angles(const Vec3& box) const;

 private:
  double half_axis_, radius_;
};

/// Return the positions of the vertices of the grid on the surface. Bitwise symmetric about the three planes. No square
/// is folded.
Vectors even_positions(const SurfaceGrid& grid, const MidSurface& surface);

/// Return positions for another grid on the same box: bilinear between the vertices of the coarse one, then projected.
/// Bitwise symmetric.
Vectors refined_positions(const SurfaceGrid& coarse, const Vectors& positions, const SurfaceGrid& fine,
                          const MidSurface& surface);

}  // namespace plica
