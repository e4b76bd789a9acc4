// Exchange of neighbours between steps: walls turn where forces then lengthen them. Topology: tissue/exchange.hpp.
// Theory: docs/theory/exchange.md.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/model.hpp"
#include "tissue/exchange.hpp"

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

}  // namespace plica
