// Grid on the surface of a box of a x b x c squares: vertices, and quadrilaterals counter-clockwise from outside.
#pragma once

#include <array>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

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

}  // namespace plica
