// Builders of embryos: the pill (Drosophila), the sphere (Xenopus), a slice of a pill and the flat block.
//
// Pill and sphere are the surface grid of a box of a x b x c cells (2(ab + bc + ca) cells, that many + 2 nodes
// per layer), mapped to a capsule: first by equal angles (and equal arcs along the axis), then smoothed for even cells
// (docs/how-to/embryos.md).
// Nodes of refined elements lie on the same smooth surfaces as the cells' corners.
#pragma once

#include <array>
#include <vector>

#include "core/vector.hpp"
#include "tissue/tissue.hpp"

namespace plica {

struct ShellShape {
  double length_um = 460;  // along x; equal to the diameter for a sphere
  double diameter_um = 280;
  double cell_height_um = 40;
  std::array<int, 3> cells = {18, 9, 8};             // along x, y, z
  std::array<int, 3> elements_per_cell = {1, 1, 1};  // along, across, basal to apical
};

/// Build a closed sheet one cell thick: a pill, or a sphere if length and diameter agree. Apical faces outside.
/// Positions are bitwise symmetric about the three planes.
Tissue build_shell(const ShellShape& shape);

/// Build the same cells around a cylinder: `length_um` of its middle, with cells[0] along x, cells[1] each on the
/// ventral and dorsal side, cells[2] on either side. Bitwise symmetric about y = 0.
Tissue build_slice(const ShellShape& shape);

struct BlockShape {
  double length_um = 60;  // x
  double width_um = 20;   // y
  double cell_height_um = 40;
  std::array<int, 3> cells = {3, 1, 1};
  std::array<int, 3> elements_per_cell = {1, 1, 1};
};

/// Build a flat block, centred on the origin, apical faces on top (+z).
Tissue build_block(const BlockShape& shape);

/// Grid on the surface of a box of a x b x c squares: vertices, and quadrilaterals counter-clockwise from outside.
class SurfaceGrid {
 public:
  using Place = std::array<int, 3>;  // i j k of a vertex, at least one of them 0 or at its end

  /// Square of the surface: its origin vertex and two directions u, v with u x v outward.
  struct Square {
    Place origin;
    Place u, v;
    GridPlace grid_place;
  };

  explicit SurfaceGrid(std::array<int, 3> counts);

  [[nodiscard]] std::size_t vertex_count() const { return vertices_.size(); }
  [[nodiscard]] std::size_t index(const Place& place) const;
  [[nodiscard]] const Place& place(std::size_t vertex) const { return vertices_[vertex]; }
  [[nodiscard]] const std::array<int, 3>& counts() const { return counts_; }

  /// Return the vertices of the square, counter-clockwise from outside.
  [[nodiscard]] std::array<std::size_t, 4> corners(const Square& square) const;

  /// Return all squares, face by face: ventral, dorsal, left, right, anterior, posterior.
  [[nodiscard]] std::vector<Square> squares() const;

 private:
  std::array<int, 3> counts_;
  std::vector<Place> vertices_;
};

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
