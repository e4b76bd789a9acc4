// Which cells divide now, and across which walls: the rules of a scenario, asked after every step.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mechanics/division.hpp"
#include "scenario/scenario.hpp"

namespace plica {

struct DivisionRule {
  std::string region;
  DivisionTrigger trigger = DivisionTrigger::time;
  double threshold = 0;  // s; or what a cell has to exceed: um^2, um^3, longer over shorter side
  DivisionPlane plane = DivisionPlane::transverse;
  double growth_s = 0;
  double volume_ratio = 1;
  int max_generation = 1;  // a division after which daughters would be of a later generation is not made
};

/// Where a plane cuts the cell, at current positions: of a grid, across the side that lies nearest to the plane's
/// normal; a polygon, between the walls whose middles lie best for that and for two halves.
CellCut cut_by(DivisionPlane plane, const Tissue& tissue, CellId cell, const Vectors& positions);

/// The divisions due at the state's time. Rules at a time that has come since `State::divided_until_s` apply to every
/// cell of their region; thresholds to cells that are not growing. A cell divides once at a time, by the first rule
/// that says so.
std::vector<PlannedDivision> due_divisions(const Model& model, const State& state, std::span<const DivisionRule> rules);

}  // namespace plica
