// Exchange of neighbours and extrusion between steps: walls turn where forces then lengthen them, cells leave; cells
// whose elements have become bad meanwhile are split again.
// Topology: tissue/exchange.hpp, tissue/extrusion.hpp. Theory: docs/theory/exchange.md.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/model.hpp"
#include "tissue/exchange.hpp"
#include "tissue/extrusion.hpp"

namespace plica {

struct ExchangeOutcome {
  TissueChange change;
  std::vector<WallTurn> turns;  // as they were before
  double energy = 0;            // nN um: its change; volumes that have changed count by the cells' pressures
};

/// Turn those of the walls, of which no two share a cell, whose columns forces then pull apart; empty: none. Energy
/// falls: if it does not, the walls with the least force stay.
/// Rest shapes of the cells about them keep the mean elastic stretch, and have not flowed. Volumes change by some
/// percent; the next step restores them.
std::optional<ExchangeOutcome> exchange_neighbours(Model& model, State& state, std::vector<WallTurn> turns,
                                                   double length_um);

/// Turn those of the walls, of which no two share a cell, whose cells get good elements, to this length, um, whatever
/// the forces; empty: none.
std::optional<ExchangeOutcome> part_neighbours(Model& model, State& state, std::vector<WallTurn> turns,
                                               double length_um);

struct ExtrusionOutcome {
  TissueChange change;
  std::vector<CellId> cells;  // that have left; their numbers before
  int count = 0;
  double volume_um3 = 0;  // of the cells that have left
};

/// Take out those of the cells, which can leave and share no neighbour, whose neighbours get good elements; empty:
/// none. The neighbours fill the place in the next step; their rest shapes are as after an exchange.
std::optional<ExtrusionOutcome> extrude_cells(Model& model, State& state, std::vector<CellId> cells);

struct SplitOutcome {
  TissueChange change;
  std::vector<CellId> cells;
  double energy = 0;  // nN um: its change
};

/// Return the cells of a set that have a bad element, which becomes better if they are split again.
std::vector<CellId> cells_to_split(const Model& model, const State& state, const CellSet& among);

/// Split cells again. Shapes, volumes and velocities stay; rest shapes are as after an exchange.
SplitOutcome split_cells(Model& model, State& state, std::vector<CellId> cells);

}  // namespace plica
