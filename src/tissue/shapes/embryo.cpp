// Gradient descent evens out the squares: those larger than the mean contract, smaller ones expand, and every square
// contracts a little (`tension`), which keeps its shape. Contraction alone (Laplacian smoothing) would shrink the eight
// squares at the corners of the box, where three meet.
//
// A sweep moves a vertex by its own squares only, so unevenness over n squares takes of the order of n^2 sweeps, during
// which expanding squares may fold (90 x 45 x 40 did). So a large grid starts with a coarse one of the same
// proportions, fully evened, and is refined by halving the squares: the remaining unevenness is small and local, and a
// few sweeps suffice.
#include "tissue/shapes/embryo.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "core/parallel.hpp"
#include "tissue/hexahedron.hpp"
#include "tissue/lattice.hpp"
#include "tissue/mesher.hpp"

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

using Counts = std::array<int, 3>;

// 300 sweeps settle the meshes of the paper. Weights trade evenness against shape; at the box's corners what a weight
// leaves uneven grows with the logarithm of the number of squares, so that finer grids take less of it.
constexpr int sweeps_of_a_small_grid = 300;
constexpr double tension_of_a_small_grid = 0.1, tension_of_a_finer_grid = 0.05;
constexpr std::size_t most_squares_of_a_small_grid = 2000, fewest_squares_to_begin_with = 500;

std::size_t square_count(const Counts& counts) {
  const auto [a, b, c] =
      std::array<std::size_t, 3>{std::size_t(counts[0]), std::size_t(counts[1]), std::size_t(counts[2])};
  return 2 * (a * b + b * c + c * a);
}

/// Gives every vertex the position of its mirror image among the lower halves of the three axes, reflected: positions
/// are then bitwise symmetric, and exactly 0 on a plane of symmetry.
void make_symmetric(const SurfaceGrid& grid, Vectors& positions) {
  for (std::size_t vertex = 0; vertex < grid.vertex_count(); ++vertex) {
    SurfaceGrid::Place image = grid.place(vertex);
    Vec3 sign;
    for (int axis = 0; axis < 3; ++axis) {
      const int doubled = 2 * image[axis], count = grid.counts()[axis];
      sign[axis] = doubled == count ? 0 : doubled < count ? 1 : -1;
      image[axis] = std::min(image[axis], count - image[axis]);
    }
    // An image comes before its vertex in the grid's order, so it is final already.
    positions[vertex] = sign.cwiseProduct(positions[grid.index(image)]);
  }
}

Vectors equal_angle_positions(const SurfaceGrid& grid, const MidSurface& surface) {
  Vectors positions(grid.vertex_count());
  for (std::size_t vertex = 0; vertex < grid.vertex_count(); ++vertex) {
    Vec3 box;
    for (int axis = 0; axis < 3; ++axis) box[axis] = 2.0 * grid.place(vertex)[axis] / grid.counts()[axis] - 1;
    positions[vertex] = surface.by_equal_angles(box);
  }
  make_symmetric(grid, positions);
  return positions;
}

using Corners = std::array<std::size_t, 4>;

std::vector<Corners> corners_of_squares(const SurfaceGrid& grid) {
  std::vector<Corners> squares;
  for (const SurfaceGrid::Square& square : grid.squares()) squares.push_back(grid.corners(square));
  return squares;
}

std::array<Vec3, 4> points_of(const Corners& corners, const Vectors& positions) {
  return {positions[corners[0]], positions[corners[1]], positions[corners[2]], positions[corners[3]]};
}

void sweep(const SurfaceGrid& grid, const std::vector<Corners>& squares, const MidSurface& surface, int sweeps,
           double tension, Vectors& positions) {
  constexpr double rate = 0.2;
  constexpr double most = 0.5;  // more than that would overshoot
  Vectors moves(positions.size());
  std::vector<double> areas(squares.size());
  for (int done = 0; done < sweeps; ++done) {
    std::fill(moves.begin(), moves.end(), Vec3::Zero());
    double mean_area = 0;
    for (std::size_t s = 0; s < squares.size(); ++s) {
      areas[s] = facet_area(points_of(squares[s], positions));
      mean_area += areas[s] / static_cast<double>(squares.size());
    }
    for (std::size_t s = 0; s < squares.size(); ++s) {
      const auto p = points_of(squares[s], positions);
      const Vec3 centre = (p[0] + p[1] + p[2] + p[3]) / 4;
      const double draw = std::min(areas[s] / mean_area - 1 + tension, most);
      for (int i = 0; i < 4; ++i) moves[squares[s][i]] += rate * draw * (centre - p[i]);
    }
    for (std::size_t vertex = 0; vertex < positions.size(); ++vertex)
      positions[vertex] = surface.point(surface.project(positions[vertex] + moves[vertex]));
    make_symmetric(grid, positions);
  }
}

/// Whether a corner of a square looks inward.
bool is_folded(const std::vector<Corners>& squares, const MidSurface& surface, const Vectors& positions) {
  return std::ranges::any_of(squares, [&](const Corners& corners) {
    const auto p = points_of(corners, positions);
    for (int i = 0; i < 4; ++i) {
      const Vec3 outward = (p[(i + 1) % 4] - p[i]).cross(p[(i + 3) % 4] - p[i]);
      if (!(outward.dot(surface.project(p[i]).normal) > 0)) return true;
    }
    return false;
  });
}

Counts coarsened(const Counts& counts, double factor) {
  Counts coarse;
  for (int axis = 0; axis < 3; ++axis) coarse[axis] = std::max(1, static_cast<int>(std::lround(counts[axis] / factor)));
  return coarse;
}

/// Coarsening factor of the small grid with the nearest proportions; empty if none is near.
std::optional<double> best_coarsening(const Counts& counts) {
  constexpr int fewest_along_an_axis = 3;
  constexpr double largest_deviation = 0.1;
  std::optional<double> best;
  double least_deviation = largest_deviation;
  for (int along = 1; along < counts[0]; ++along) {
    const double factor = static_cast<double>(counts[0]) / along;
    const Counts coarse = coarsened(counts, factor);
    const std::size_t squares = square_count(coarse);
    if (squares < fewest_squares_to_begin_with || squares > most_squares_of_a_small_grid) continue;
    double deviation = 0;
    for (int axis = 0; axis < 3; ++axis) {
      deviation = std::max(deviation, std::abs(coarse[axis] * factor / counts[axis] - 1));
      if (coarse[axis] < std::min(fewest_along_an_axis, counts[axis])) deviation = largest_deviation;
    }
    if (deviation < least_deviation) least_deviation = deviation, best = factor;
  }
  return best;
}

/// The grids to even one after the other, coarse to fine; the last one has these counts.
std::vector<Counts> grids_to(const Counts& counts) {
  std::vector<Counts> grids;
  if (square_count(counts) > most_squares_of_a_small_grid)
    if (const std::optional<double> factor = best_coarsening(counts))
      for (double rest = *factor; rest > 1 + 1e-9; rest /= 2) grids.push_back(coarsened(counts, rest));
  if (grids.empty() || grids.back() != counts) grids.push_back(counts);
  return grids;
}

/// Fewer on larger grids, where less is left to do and each takes longer.
int sweeps_of(std::size_t squares) {
  constexpr std::size_t sweeps_times_squares = 3'000'000, fewest = 10;
  return static_cast<int>(std::clamp<std::size_t>(sweeps_times_squares / squares, fewest, sweeps_of_a_small_grid));
}

std::vector<CellLattice> shell_lattices(const SurfaceGrid& coarse, const SurfaceGrid& fine,
                                        std::array<int, 3> elements) {
  const std::array<int, 3> ratio = {elements[0], elements[1], elements[1]};  // of the fine grid, an axis
  std::vector<CellLattice> lattices;
  for (const SurfaceGrid::Square& square : coarse.squares()) {
    CellLattice lattice;
    lattice.grid_place = square.grid_place;
    const auto count = [&](const SurfaceGrid::Place& direction) {
      for (int axis = 0; axis < 3; ++axis)
        if (direction[axis] != 0) return ratio[axis];
      return 1;
    };
    lattice.elements = {count(square.u), count(square.v), elements[2]};
    lattice.add_nodes([&](int u, int v, int w) {
      SurfaceGrid::Place place{};
      for (int axis = 0; axis < 3; ++axis)
        place[axis] = square.origin[axis] * ratio[axis] + u * square.u[axis] + v * square.v[axis];
      return w * fine.vertex_count() + fine.index(place);
    });
    lattices.push_back(std::move(lattice));
  }
  return lattices;
}

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

MidSurface::Place MidSurface::project(const Vec3& point) const {
  const double foot_x = std::clamp(point.x(), -half_axis_, half_axis_);
  return {foot_x, Vec3(point.x() - foot_x, point.y(), point.z()).normalized()};
}

Vec3 MidSurface::by_equal_angles(const Vec3& box) const {
  constexpr double quarter = std::numbers::pi / 4;
  const double arc = box.x() * (half_axis_ + radius_ * quarter);
  const double foot_x = std::clamp(arc, -half_axis_, half_axis_);
  const Vec3 direction(std::tan((arc - foot_x) / radius_), std::tan(box.y() * quarter), std::tan(box.z() * quarter));
  return point({foot_x, direction.normalized()});
}

Vectors even_positions(const SurfaceGrid& grid, const MidSurface& surface) {
  std::optional<SurfaceGrid> coarser;
  Vectors positions;
  for (const Counts& counts : grids_to(grid.counts())) {
    SurfaceGrid present(counts);
    const std::vector<Corners> squares = corners_of_squares(present);
    if (coarser) {
      positions = refined_positions(*coarser, positions, present, surface);
      sweep(present, squares, surface, sweeps_of(squares.size()), tension_of_a_finer_grid, positions);
    } else {
      positions = equal_angle_positions(present, surface);
      sweep(present, squares, surface, sweeps_of(squares.size()), tension_of_a_small_grid, positions);
    }
    coarser = std::move(present);
  }
  // Squares that are far longer than wide may fold all the same. Equal angles never do.
  if (is_folded(corners_of_squares(grid), surface, positions)) return equal_angle_positions(grid, surface);
  return positions;
}

Vectors refined_positions(const SurfaceGrid& coarse, const Vectors& corners, const SurfaceGrid& fine,
                          const MidSurface& surface) {
  Vectors positions(fine.vertex_count());
  parallel_for(fine.vertex_count(), [&](std::size_t vertex) {
    SurfaceGrid::Place low{}, high{};
    Vec3 part;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t coarse_count = coarse.counts()[axis], fine_count = fine.counts()[axis];
      const std::int64_t at = fine.place(vertex)[axis] * coarse_count;
      low[axis] = static_cast<int>(at / fine_count);
      high[axis] = std::min(low[axis] + 1, coarse.counts()[axis]);
      part[axis] = static_cast<double>(at % fine_count) / static_cast<double>(fine_count);
    }
    // Trilinear over the box of corners; one of the three parts is 0, since the vertex lies on the box's surface.
    Vec3 sum = Vec3::Zero();
    for (int corner = 0; corner < 8; ++corner) {
      SurfaceGrid::Place place{};
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) {
        const bool upper = (corner >> axis) & 1;
        place[axis] = upper ? high[axis] : low[axis];
        weight *= upper ? part[axis] : 1 - part[axis];
      }
      if (weight > 0) sum += weight * corners[coarse.index(place)];
    }
    positions[vertex] = surface.point(surface.project(sum));
  });
  make_symmetric(fine, positions);
  return positions;
}

Tissue build_shell(const ShellShape& shape) {
  const double half_axis = (shape.length_um - shape.diameter_um) / 2;
  const MidSurface surface(half_axis, (shape.diameter_um - shape.cell_height_um) / 2);
  const SurfaceGrid coarse(shape.cells);
  const auto [along, across, layers] = shape.elements_per_cell;
  const SurfaceGrid fine({shape.cells[0] * along, shape.cells[1] * across, shape.cells[2] * across});
  const Vectors mid = refined_positions(coarse, even_positions(coarse, surface), fine, surface);

  Vectors positions(mid.size() * (layers + 1));
  for (int w = 0; w <= layers; ++w) {
    const double offset = shape.cell_height_um * (static_cast<double>(w) / layers - 0.5);
    for (std::size_t vertex = 0; vertex < mid.size(); ++vertex)
      positions[w * mid.size() + vertex] = surface.point(surface.project(mid[vertex]), offset);
  }
  const std::vector<CellLattice> lattices = shell_lattices(coarse, fine, shape.elements_per_cell);
  Tissue tissue = tissue_from_lattices(lattices, std::move(positions));
  if (along * across * layers > 1) number_as_elements_come(tissue);
  tissue.outer_shape = Capsule{half_axis, shape.diameter_um / 2};
  return tissue;
}

Tissue build_slice(const ShellShape& shape) {
  const auto [along, belly, side] = shape.cells;
  const auto [nu, nv, nw] = shape.elements_per_cell;
  const int around = 2 * (belly + side), x_nodes = along * nu + 1, y_nodes = around * nv;
  Vectors positions;
  positions.reserve(static_cast<std::size_t>(x_nodes) * y_nodes * (nw + 1));
  for (int k = 0; k <= nw; ++k) {
    const double radius = shape.diameter_um / 2 - shape.cell_height_um * (nw - k) / nw;
    for (int j = 0; j < y_nodes; ++j) {
      // From the middle of the belly, in both ways alike.
      const int half_steps = 2 * j - belly * nv, whole = 2 * y_nodes;
      const double angle = 2 * std::numbers::pi * (half_steps > whole / 2 ? half_steps - whole : half_steps) / whole;
      const double sine = 2 * half_steps == whole ? 0 : std::sin(angle);
      for (int i = 0; i < x_nodes; ++i)
        positions.emplace_back(shape.length_um * (2.0 * i - (x_nodes - 1)) / (2.0 * (x_nodes - 1)), -radius * sine,
                               -radius * std::cos(angle));
    }
  }
  using enum GridPlace::Face;
  std::vector<CellLattice> lattices;
  for (int j = 0; j < around; ++j)
    for (int i = 0; i < along; ++i) {
      CellLattice lattice;
      lattice.elements = shape.elements_per_cell;
      const int begins[] = {0, belly, belly + side,
                            2 * belly + side};  // of the faces, from right to left round the belly
      const GridPlace::Face faces[] = {ventral, left, dorsal, right};
      int face = 3;
      while (j < begins[face]) --face;
      lattice.grid_place = GridPlace{faces[face], {i, j - begins[face]}, {along, face % 2 == 0 ? belly : side}};
      lattice.add_nodes(
          [&](int u, int v, int w) { return (i * nu + u) + x_nodes * ((j * nv + v) % y_nodes + y_nodes * w); });
      lattices.push_back(std::move(lattice));
    }
  Tissue tissue = tissue_from_lattices(lattices, std::move(positions));
  tissue.outer_shape = Capsule{shape.length_um / 2, shape.diameter_um / 2};
  tissue.is_endless = true;
  return tissue;
}

Tissue build_block(const BlockShape& shape) {
  const auto [a, b, c] = shape.cells;
  const auto [nu, nv, nw] = shape.elements_per_cell;
  const int x_nodes = a * nu + 1, y_nodes = b * nv + 1, z_nodes = c * nw + 1;
  const Vec3 size(shape.length_um, shape.width_um, shape.cell_height_um * c);
  Vectors positions;
  positions.reserve(static_cast<std::size_t>(x_nodes) * y_nodes * z_nodes);
  // (2 i - n) / 2n instead of i/n - 1/2: bitwise symmetric.
  const auto centred = [](int i, int nodes) { return (2.0 * i - (nodes - 1)) / (2.0 * (nodes - 1)); };
  for (int k = 0; k < z_nodes; ++k)
    for (int j = 0; j < y_nodes; ++j)
      for (int i = 0; i < x_nodes; ++i)
        positions.push_back(size.cwiseProduct(Vec3(centred(i, x_nodes), centred(j, y_nodes), centred(k, z_nodes))));

  std::vector<CellLattice> lattices;
  for (int k = 0; k < c; ++k)
    for (int j = 0; j < b; ++j)
      for (int i = 0; i < a; ++i) {
        CellLattice lattice;
        lattice.elements = shape.elements_per_cell;
        lattice.has_basal = k == 0;
        lattice.has_apical = k == c - 1;
        if (lattice.has_apical) lattice.grid_place = GridPlace{GridPlace::Face::dorsal, {i, j}, {a, b}};
        lattice.add_nodes(
            [&](int u, int v, int w) { return (i * nu + u) + x_nodes * ((j * nv + v) + y_nodes * (k * nw + w)); });
        lattices.push_back(std::move(lattice));
      }
  return tissue_from_lattices(lattices, std::move(positions));
}

}  // namespace plica
