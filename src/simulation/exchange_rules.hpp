// Exchange and extrusion rules of a scenario: which walls may turn after a step, which cells leave.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mechanics/division.hpp"
#include "mechanics/exchange.hpp"

namespace plica {

struct ExchangeRule {
  std::string region;
  double below_um = 0;       // mean length of a wall at base and apex that may turn
  double new_length_um = 0;  // after that
  double again_after_s = 0;
};

struct ExtrusionRule {
  std::string region;
  std::optional<double> apical_below_um2, basal_below_um2;  // areas of a cell that leaves; empty: any
};

/// Cells that leave: in the region of a rule, with smaller faces than it says.
CellSet leaving_cells(const Model& model, const State& state, std::span<const ExtrusionRule> rules);

/// Walls due at the time of the state, the shortest first: shorter than the rule says and shrinking, between cells of
/// its region, with free columns, and not among `State::exchanges.recent`. No two share a cell. Cells
/// about to leave gain no neighbour.
std::vector<WallTurn> due_exchanges(const Model& model, const State& state, const ExchangeRule& rule,
                                    std::span<const ExtrusionRule> extrusions = {});

/// Turn the walls due that forces then lengthen, and count them; empty: none.
std::optional<ExchangeOutcome> make_exchanges(Model& model, State& state, const ExchangeRule& rule,
                                              std::span<const ExtrusionRule> extrusions = {});

/// Turn the shortest wall of a cell about to leave, with more than three walls, whatever the forces; empty: none.
/// Called again, it takes the next of these cells: each turns one wall at a time.
std::optional<ExchangeOutcome> make_parting(Model& model, State& state, const ExchangeRule& rule,
                                            std::span<const ExtrusionRule> extrusions);

/// Take out the cells of these regions that are small and have come down to three walls, and count them; empty: none.
std::optional<ExtrusionOutcome> make_extrusions(Model& model, State& state, std::span<const ExtrusionRule> rules);

/// Split cells of the exchange rule's region again whose elements have become bad, where that helps; empty: none.
std::optional<SplitOutcome> make_splits(Model& model, State& state, const ExchangeRule& rule);

/// Turn the walls back that have turned at the time of the state, and count them no more; empty: none.
std::optional<ExchangeOutcome> undo_exchanges(Model& model, State& state, const ExchangeRule& rule);

/// Return what makes these changes again.
RepeatedChange repeated_exchange(const ExchangeOutcome& outcome, const ExchangeRule& rule);
RepeatedChange repeated_parting(const ExchangeOutcome& outcome, const ExchangeRule& rule);
RepeatedChange repeated_extrusion(const ExtrusionOutcome& outcome);
RepeatedChange repeated_split(const SplitOutcome& outcome);

}  // namespace plica
