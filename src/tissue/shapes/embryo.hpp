// Builders of embryos: the pill (Drosophila), the sphere (Xenopus), a slice of a pill and the flat block.
//
// Pill and sphere are the surface grid of a box of a x b x c cells (2(ab + bc + ca) cells, that many + 2 nodes
// per layer), mapped to a capsule: first by equal angles (and equal arcs along the axis), then smoothed for even cells.
// Nodes of refined elements lie on the same smooth surfaces as the cells' corners.
#pragma once

#include <array>

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

}  // namespace plica
