// Cell division as an operation on the tissue: a cell is cut in two, and the meshes of its neighbours are adapted.
//
// A lateral face between cells is a chain of stops (a basal and an apical node each); a cut inserts a stop in the
// middle of two faces, for the cell and its neighbours alike. The quadrilaterals of every cell are then meshed by the
// lines through all stops on its faces; where such a line meets no stop, its node hangs (docs/theory/division.md).
// Neighbours thus always share their whole common face, every stop moves freely, and cells may divide repeatedly in any
// pattern. Rejected: hanging the new nodes on the straight edge of the neighbour (no freedom), and halving the
// neighbours as well (cuts would run through the whole tissue).
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Apico-basal cut through the middle of two lateral faces; in a grid cell opposite ones: 0 and 2, or 1 and 3.
struct CellCut {
  CellId cell;
  int first_wall = 0;
  int second_wall = first_wall + 2;  // above the first
};

/// Result of a division, for data stored by cell or node. Free nodes keep their numbers and new ones follow; one
/// daughter takes the place of the mother among the cells, the other follows at the end.
struct Division {
  std::vector<CellId> origin;                               // cells now; the former cell of each
  std::vector<std::array<CellId, 2>> daughters;             // cuts
  std::size_t free_nodes_before = 0;                        // the first new node
  std::vector<NodeMean> new_nodes;                          // position of each, by nodes before it
  std::map<std::pair<NodeId, NodeId>, NodeId> node_midway;  // nodes that split an edge, by its ordered ends
};

/// Returns the reason why cells cannot divide, or nothing: cells must start as one element each, or as polygons split
/// by diagonals, in a single layer.
std::optional<std::string> why_indivisible(const Tissue& tissue);

/// Cuts cells, each at most once, at `time_s`. Each daughter gets half of the rest shape of the mother, and its regions
/// and place. The volumes of other cells do not change, nor does the sum of two halves of a quadrilateral mother;
/// otherwise the sum changes with the bending of its faces, since daughters are split again: in the best way both in
/// the reference state and with nodes at `positions` (default: reference). The tissue must be divisible.
Division divide(Tissue& tissue, std::span<const CellCut> cuts, double time_s, std::span<const Vec3> positions = {});

/// Completes a tissue whose cells have changed as `division` says (origins): the mesh follows from walls,
/// quadrilaterals and rest shapes of the cells and from the free nodes, regions and arrays from those before.
void complete(Tissue& tissue, const Division& division);

/// Whether walls, quadrilaterals and rest shape of a cell are consistent, with these free nodes.
bool is_consistent(const Cell& cell, std::size_t free_nodes);

/// Returns the number of elements of a consistent cell in its mesh.
std::size_t element_count(const Cell& cell);

/// Returns both parts of a prism, given by its basal and then apical corners, after such a cut.
std::pair<std::vector<Vec3>, std::vector<Vec3>> halves_of_prism(const CellCut& cut, const std::vector<Vec3>& corners);

/// Sets the rest shapes of the elements of a cell from that of the cell, after that has changed.
void set_element_rest_shapes(Tissue& tissue, CellId cell);

/// Returns values per cell, inherited by daughters.
template <class Values>
Values inherited(const Division& division, const Values& values) {
  Values result;
  result.reserve(division.origin.size());
  for (const CellId origin : division.origin) result.push_back(values[origin.index()]);
  return result;
}

/// Returns vectors per free node before the division, laid out for the tissue after it, with new and hanging nodes
/// placed.
Vectors with_new_nodes(const Tissue& tissue, const Division& division, const Vectors& before);

}  // namespace plica
