// Cell division as an operation on the tissue: a cell is cut in two, and the meshes of its neighbours are adapted.
//
// The side of a cell is a chain of stops, which its neighbours share (sheet.hpp); a cut inserts a stop in two sides,
// for the cell and its neighbours alike. The quadrilaterals of every cell are then meshed by the lines through all
// stops on its sides; where such a line meets no stop, its node hangs (docs/theory/division.md). Neighbours thus always
// share their whole common face, every stop moves freely, and cells may divide repeatedly in any pattern. Rejected:
// hanging the new nodes on the straight edge of the neighbour (no freedom), and halving the neighbours as well (cuts
// would run through the whole tissue).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tissue/tissue_change.hpp"

namespace plica {

/// Apico-basal cut between two sides; in a grid cell between the middles of opposite ones: 0 and 2, or 1 and 3.
struct CellCut {
  CellId cell;
  int first_wall = 0;
  int second_wall = first_wall + 2;        // above the first
  double first_at = 0.5, second_at = 0.5;  // places on these sides, which halving leads to

  [[nodiscard]] bool is_through_middles() const { return first_at == 0.5 && second_at == 0.5; }
};

/// Returns the reason why the topology cannot change, or nothing: cells must be polygons with a split, or grid cells
/// with one element along and across, in a single layer.
std::optional<std::string> why_unchangeable(const Tissue& tissue);

/// Returns the reason why cells cannot divide, or nothing: the topology must be changeable, without periods.
std::optional<std::string> why_indivisible(const Tissue& tissue);

/// Cuts cells, each at most once, at `time_s`. Each daughter gets half of the rest shape of the mother, and its regions
/// and place. The volumes of other cells do not change, nor does the sum of two halves of a quadrilateral mother;
/// otherwise the sum changes with the bending of its faces, since daughters are split again: in the best way both in
/// the reference state and with nodes at `positions` (default: reference). The tissue must be divisible.
TissueChange divide(Tissue& tissue, std::span<const CellCut> cuts, double time_s, std::span<const Vec3> positions = {});

/// Returns the worst scaled Jacobian of the daughters' elements, in the reference state and at `positions`, if no other
/// cell divides.
double quality_of_daughters(const Tissue& tissue, const CellCut& cut, std::span<const Vec3> positions);

/// Completes a tissue whose cells have changed as `change` says (origins): the mesh follows from the sheet,
/// rest shapes of the cells and the free nodes, regions and arrays from those before.
void complete(Tissue& tissue, const TissueChange& change);

/// Returns both parts of a prism, given by its basal and then apical corners, after such a cut; one that `bends` goes
/// through the mean of the corners.
std::pair<std::vector<Vec3>, std::vector<Vec3>> halves_of_prism(const CellCut& cut, const std::vector<Vec3>& corners,
                                                                bool bends = false);

/// Whether a cut of the cell bends at a node in its middle, which the daughters get as a corner.
bool cuts_bend(const Tissue& tissue, CellId cell);

}  // namespace plica
