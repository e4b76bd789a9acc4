#include "tissue/embryo.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.hpp"
#include "tissue/lattice.hpp"
#include "tissue/surface_grid.hpp"

namespace plica {
namespace {

/// The mid-surface of the sheet: every vertex of a surface grid is a foot on the axis and a unit normal.
struct ShellPoint {
  double foot_x;
  Vec3 normal;
};

class MidSurface {
 public:
  explicit MidSurface(const ShellShape& shape)
      : half_axis_((shape.length_um - shape.diameter_um) / 2),
        radius_((shape.diameter_um - shape.cell_height_um) / 2) {}

  [[nodiscard]] ShellPoint project(const Vec3& point) const {
    const double foot_x = std::clamp(point.x(), -half_axis_, half_axis_);
    return {foot_x, Vec3(point.x() - foot_x, point.y(), point.z()).normalized()};
  }
  [[nodiscard]] Vec3 point(const ShellPoint& p, double offset = 0) const {
    return Vec3(p.foot_x, 0, 0) + (radius_ + offset) * p.normal;
  }

  /// Equal arcs along the axis, equal angles around it and on the caps. `box` is in [-1, 1]^3, on the box's surface.
  [[nodiscard]] Vec3 by_equal_angles(const Vec3& box) const {
    constexpr double quarter = std::numbers::pi / 4;
    const double arc = box.x() * (half_axis_ + radius_ * quarter);
    const double foot_x = std::clamp(arc, -half_axis_, half_axis_);
    const Vec3 direction(std::tan((arc - foot_x) / radius_), std::tan(box.y() * quarter), std::tan(box.z() * quarter));
    return point({foot_x, direction.normalized()});
  }

 private:
  double half_axis_;
  double radius_;
};

/// Gives every vertex the position of its mirror image among the lower halves of the three axes, reflected: positions
/// are then symmetric to the bit, and exactly 0 on a plane of symmetry.
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

/// Makes the squares more alike: gradient descent, kept on the surface, in which a square larger than the mean draws
/// its corners in and a smaller one pushes them out, and every square draws a little (`tension`) so that it stays well
/// shaped. Drawing alone, the usual Laplacian smoothing, would shrink the eight squares at the box's corners, where
/// three meet. 300 sweeps settle the meshes of the paper (docs/embryos.md). A square that pushes out is unstable on its
/// own scale, which many sweeps over many small squares bring out (90 x 45 x 40 turned inside out): a larger grid gets
/// fewer, and keeps more of the even start that it is given.
void smooth(const SurfaceGrid& grid, const MidSurface& surface, Vectors& positions) {
  constexpr std::size_t most_sweeps = 300, most_sweeps_times_squares = 600'000;
  constexpr double tension = 0.1, rate = 0.2;
  std::vector<std::array<std::size_t, 4>> squares;
  for (const SurfaceGrid::Square& square : grid.squares()) squares.push_back(grid.corners(square));
  const std::size_t sweeps = std::min(most_sweeps, most_sweeps_times_squares / squares.size());
  Vectors moves(positions.size());
  std::vector<double> areas(squares.size());
  const auto points = [&](std::size_t s) {
    const auto& c = squares[s];
    return std::array<Vec3, 4>{positions[c[0]], positions[c[1]], positions[c[2]], positions[c[3]]};
  };
  for (std::size_t sweep = 0; sweep < sweeps; ++sweep) {
    std::fill(moves.begin(), moves.end(), Vec3::Zero());
    double mean_area = 0;
    for (std::size_t s = 0; s < squares.size(); ++s) {
      areas[s] = facet_area(points(s));
      mean_area += areas[s] / static_cast<double>(squares.size());
    }
    for (std::size_t s = 0; s < squares.size(); ++s) {
      const auto p = points(s);
      const Vec3 centre = (p[0] + p[1] + p[2] + p[3]) / 4;
      const double draw = areas[s] / mean_area - 1 + tension;
      for (int i = 0; i < 4; ++i) moves[squares[s][i]] += rate * draw * (centre - p[i]);
    }
    for (std::size_t vertex = 0; vertex < positions.size(); ++vertex)
      positions[vertex] = surface.point(surface.project(positions[vertex] + moves[vertex]));
    make_symmetric(grid, positions);
  }
}

/// Mid-surface positions of the cells' corners.
Vectors place_corners(const SurfaceGrid& grid, const MidSurface& surface) {
  Vectors positions(grid.vertex_count());
  for (std::size_t vertex = 0; vertex < grid.vertex_count(); ++vertex) {
    Vec3 box;
    for (int axis = 0; axis < 3; ++axis) box[axis] = 2.0 * grid.place(vertex)[axis] / grid.counts()[axis] - 1;
    positions[vertex] = surface.by_equal_angles(box);
  }
  make_symmetric(grid, positions);
  smooth(grid, surface, positions);
  return positions;
}

/// Mid-surface positions of the nodes of refined elements: bilinear between the corners of their cell, then projected.
Vectors refine(const SurfaceGrid& coarse, const Vectors& corners, const SurfaceGrid& fine, const MidSurface& surface) {
  Vectors positions(fine.vertex_count());
  parallel_for(fine.vertex_count(), [&](std::size_t vertex) {
    SurfaceGrid::Place low{}, high{};
    Vec3 part;
    for (int axis = 0; axis < 3; ++axis) {
      const int ratio = fine.counts()[axis] / coarse.counts()[axis], at = fine.place(vertex)[axis];
      low[axis] = at / ratio;
      high[axis] = std::min(low[axis] + 1, coarse.counts()[axis]);
      part[axis] = static_cast<double>(at % ratio) / ratio;
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
    for (int w = 0; w <= elements[2]; ++w)
      for (int v = 0; v <= lattice.elements[1]; ++v)
        for (int u = 0; u <= lattice.elements[0]; ++u) {
          SurfaceGrid::Place place{};
          for (int axis = 0; axis < 3; ++axis)
            place[axis] = square.origin[axis] * ratio[axis] + u * square.u[axis] + v * square.v[axis];
          lattice.nodes.emplace_back(w * fine.vertex_count() + fine.index(place));
        }
    lattices.push_back(std::move(lattice));
  }
  return lattices;
}

}  // namespace

Tissue build_shell(const ShellShape& shape) {
  const MidSurface surface(shape);
  const SurfaceGrid coarse(shape.cells);
  const auto [along, across, layers] = shape.elements_per_cell;
  const SurfaceGrid fine({shape.cells[0] * along, shape.cells[1] * across, shape.cells[2] * across});
  const Vectors mid = refine(coarse, place_corners(coarse, surface), fine, surface);

  Vectors positions(mid.size() * (layers + 1));
  for (int w = 0; w <= layers; ++w) {
    const double offset = shape.cell_height_um * (static_cast<double>(w) / layers - 0.5);
    for (std::size_t vertex = 0; vertex < mid.size(); ++vertex)
      positions[w * mid.size() + vertex] = surface.point(surface.project(mid[vertex]), offset);
  }
  Tissue tissue = tissue_from_lattices(shell_lattices(coarse, fine, shape.elements_per_cell), std::move(positions));
  tissue.outer_shape = Capsule{(shape.length_um - shape.diameter_um) / 2, shape.diameter_um / 2};
  return tissue;
}

Tissue build_block(const BlockShape& shape) {
  const auto [a, b, c] = shape.cells;
  const auto [nu, nv, nw] = shape.elements_per_cell;
  const int x_nodes = a * nu + 1, y_nodes = b * nv + 1, z_nodes = c * nw + 1;
  const Vec3 size(shape.length_um, shape.width_um, shape.cell_height_um * c);
  Vectors positions;
  positions.reserve(static_cast<std::size_t>(x_nodes) * y_nodes * z_nodes);
  // (2 i - n) / 2n instead of i/n - 1/2: symmetric to the bit.
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
        for (int w = 0; w <= nw; ++w)
          for (int v = 0; v <= nv; ++v)
            for (int u = 0; u <= nu; ++u)
              lattice.nodes.emplace_back((i * nu + u) + x_nodes * ((j * nv + v) + y_nodes * (k * nw + w)));
        lattices.push_back(std::move(lattice));
      }
  return tissue_from_lattices(lattices, std::move(positions));
}

}  // namespace plica
