#include "tissue/shapes/embryo.hpp"

#include <cmath>
#include <numbers>

#include "tissue/lattice.hpp"
#include "tissue/shapes/shell_grid.hpp"

namespace plica {
namespace {

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
  std::vector<CellLattice> lattices = shell_lattices(coarse, fine, shape.elements_per_cell);
  if (along * across * layers > 1) number_as_elements_come(lattices, positions);
  Tissue tissue = tissue_from_lattices(lattices, std::move(positions));
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
