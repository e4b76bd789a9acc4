#include "tissue/shapes/surface_grid.hpp"

namespace plica {
namespace {

// A face of the box: the directions u and v of its squares (as axes, with sign) and the axis and side it lies on.
struct BoxFace {
  GridPlace::Face face;
  int axis;     // normal
  bool at_end;  // on the high side of that axis
  int u_axis;
  int v_axis;
  int v_sign;  // u always runs upward; v as u x v outward wants it
};

constexpr std::array<BoxFace, 6> box_faces = {{{GridPlace::Face::ventral, 2, false, 0, 1, -1},
                                               {GridPlace::Face::dorsal, 2, true, 0, 1, 1},
                                               {GridPlace::Face::left, 1, false, 0, 2, 1},
                                               {GridPlace::Face::right, 1, true, 0, 2, -1},
                                               {GridPlace::Face::anterior, 0, false, 1, 2, -1},
                                               {GridPlace::Face::posterior, 0, true, 1, 2, 1}}};

}  // namespace

SurfaceGrid::SurfaceGrid(std::array<int, 3> counts) : counts_(counts) {
  const auto [a, b, c] = counts_;
  for (int k = 0; k <= c; ++k)
    for (int j = 0; j <= b; ++j)
      for (int i = 0; i <= a; ++i)
        if (i == 0 || i == a || j == 0 || j == b || k == 0 || k == c) vertices_.push_back({i, j, k});
}

std::size_t SurfaceGrid::index(const Place& place) const {
  // In the order of the constructor: the full bottom, rings, the full top; a ring is a row, pairs of ends, a row.
  const auto [a, b, c] = counts_;
  const auto [i, j, k] = place;
  const std::size_t full = static_cast<std::size_t>(a + 1) * (b + 1), ring = 2 * static_cast<std::size_t>(a + b);
  const std::size_t row = static_cast<std::size_t>(i) + static_cast<std::size_t>(a + 1) * j;
  if (k == 0) return row;
  const std::size_t before = full + (k - 1) * ring;
  if (k == c) return before + row;
  if (j == 0) return before + i;
  const std::size_t pairs_before = 2 * static_cast<std::size_t>(j - 1);
  if (j == b) return before + (a + 1) + pairs_before + i;
  return before + (a + 1) + pairs_before + (i == a ? 1 : 0);
}

std::array<std::size_t, 4> SurfaceGrid::corners(const Square& square) const {
  const auto at = [&](int u, int v) {
    Place place = square.origin;
    for (int axis = 0; axis < 3; ++axis) place[axis] += u * square.u[axis] + v * square.v[axis];
    return index(place);
  };
  return {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
}

std::vector<SurfaceGrid::Square> SurfaceGrid::squares() const {
  std::vector<Square> squares;
  for (const BoxFace& face : box_faces) {
    const int columns = counts_[face.u_axis], rows = counts_[face.v_axis];
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        Square square{{}, {}, {}, {face.face, {column, row}, {columns, rows}}};
        square.origin[face.axis] = face.at_end ? counts_[face.axis] : 0;
        square.origin[face.u_axis] = column;
        square.origin[face.v_axis] = face.v_sign > 0 ? row : row + 1;
        square.u[face.u_axis] = 1;
        square.v[face.v_axis] = face.v_sign;
        squares.push_back(square);
      }
  }
  return squares;
}

}  // namespace plica
