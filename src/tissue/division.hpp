// Cell division as an operation on the tissue: a cell is cut in two, its neighbours' meshes follow.
//
// A wall between cells is a chain of stops (a basal and an apical node each); a cut puts a stop into the middle of two
// walls, for the cell and for the neighbours behind them alike. The quadrilaterals of every cell are then meshed by the
// lines through all stops on its walls; where such a line meets no stop, its node hangs (docs/theory/division.md). So
// neighbours always have their whole common wall in common, every stop is free to move, and it does not matter how
// often or in what pattern cells divide. Rejected: hanging the new nodes on the neighbour's straight edge (they would
// have no freedom), and halving the neighbours as well (cuts would run through the whole tissue).
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

/// One cut, apico-basal, through the middle of two walls. In a grid's cell they are opposite: 0 and 2, or 1 and 3.
struct CellCut {
  CellId cell;
  int first_wall = 0;
  int second_wall = first_wall + 2;  // above the first
};

/// What a division did, for everything that is kept by cell or node. Free nodes keep their numbers and new ones follow;
/// one daughter takes the mother's place among the cells, the other follows at the end.
struct Division {
  std::vector<CellId> origin;                               // cells now; what they were, or were half of
  std::vector<std::array<CellId, 2>> daughters;             // cuts
  std::size_t free_nodes_before = 0;                        // the first new node
  std::vector<NodeMean> new_nodes;                          // where each lies, by nodes before it
  std::map<std::pair<NodeId, NodeId>, NodeId> node_midway;  // of those that split an edge, by its (ordered) ends
};

/// Why cells of this tissue cannot divide, or nothing: cells must begin as one element each, or as polygons split by
/// diagonals, in a single layer.
std::optional<std::string> why_indivisible(const Tissue& tissue);

/// Cuts cells, each at most once, at `time_s`. Daughters get a half of the mother's rest shape each, and her regions
/// and place. No other cell's volume changes, nor the sum of two halves when their mother was one quadrilateral; when
/// not, that differs by as much as her faces are bent, since the daughters are split anew: in the way that is best both
/// at rest and with nodes at `positions` (empty: at rest). The tissue must not be indivisible.
Division divide(Tissue& tissue, std::span<const CellCut> cuts, double time_s, std::span<const Vec3> positions = {});

/// The two parts of a prism, given by its corners, basal and then apical, that such a cut leaves.
std::pair<std::vector<Vec3>, std::vector<Vec3>> halves_of_prism(const CellCut& cut, const std::vector<Vec3>& corners);

/// Gives the cell's elements their parts of its rest shape: after that shape has changed.
void set_element_rest_shapes(Tissue& tissue, CellId cell);

/// The values of cells, handed on to daughters.
template <class Values>
Values inherited(const Division& division, const Values& values) {
  Values result;
  result.reserve(division.origin.size());
  for (const CellId origin : division.origin) result.push_back(values[origin.index()]);
  return result;
}

/// A vector a free node before the division, laid out for the tissue after it, new and hanging nodes placed.
Vectors with_new_nodes(const Tissue& tissue, const Division& division, const Vectors& before);

}  // namespace plica
