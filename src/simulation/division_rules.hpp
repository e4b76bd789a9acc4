// Division rules of a scenario: which cells divide after a step, and in which plane.
#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

#include "mechanics/division.hpp"
#include "scenario/scenario.hpp"
#include "simulation/exchange_rules.hpp"

namespace plica {

struct DivisionRule {
  std::string region;
  DivisionTrigger trigger = DivisionTrigger::time;
  double threshold = 0;  // time, s; or value to exceed: um^2, um^3, aspect ratio
  DivisionPlane plane = DivisionPlane::transverse;
  double growth_s = 0;
  double volume_ratio = 1;
  double every_s = 0;      // thresholds: interval between checks; 0: after every step
  int max_generation = 1;  // no division whose daughters would be of a later generation
};

/// Ends of cuts that are made at the same time: stops, and walls cut in their middle.
struct CutEnds {
  std::set<VertexId> stops;
  std::set<WallId> walls;
};

/// Cut by a plane, at current positions. Grid cell: across the side nearest to the plane's normal. Polygon: between the
/// middles of walls that fit the plane and equal halves best. No more than three cells meet at its ends: it avoids
/// those taken, and joins them.
CellCut cut_by(DivisionPlane plane, const Tissue& tissue, CellId cell, const Vectors& positions, CutEnds& taken);

/// Divisions due at the time of the state. Rules with a time since `State::divided_until_s` apply to every cell of
/// their region; thresholds to cells that are not growing. A cell divides once per call, by the first rule that
/// applies; none divides that leaves by an extrusion.
std::vector<PlannedDivision> due_divisions(const Model& model, const State& state, std::span<const DivisionRule> rules,
                                           std::span<const ExtrusionRule> extrusions = {});

}  // namespace plica
