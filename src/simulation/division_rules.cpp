#include "simulation/division_rules.hpp"

#include <algorithm>

#include "core/clock.hpp"

namespace plica {
namespace {

// Mean vector of the cell's edges along u (first_wall 0) or v (1), basal and apical.
Vec3 mean_side(const Cell& cell, int first_wall, const Vectors& positions) {
  Vec3 sum = Vec3::Zero();
  for (const int wall : {first_wall, first_wall + 2}) {
    const WallStop &from = cell.walls[wall].front(), &to = cell.walls[wall].back();
    sum += positions[to.basal.index()] - positions[from.basal.index()];
    sum += positions[to.apical.index()] - positions[from.apical.index()];
  }
  return sum / 4;
}

double elongation(const Cell& cell, const Vectors& positions) {
  const double u = mean_side(cell, 0, positions).norm(), v = mean_side(cell, 1, positions).norm();
  return std::max(u, v) / std::min(u, v);
}

// What the rule's threshold is about, of every cell.
std::vector<double> measured(DivisionTrigger trigger, const Model& model, const State& state) {
  switch (trigger) {
    case DivisionTrigger::apical_area:
      return apical_areas(model.tissue, state.positions);
    case DivisionTrigger::volume:
      return model.volumes().volumes(state.positions);
    case DivisionTrigger::elongation: {
      std::vector<double> values;
      for (const Cell& cell : model.tissue.cells) values.push_back(elongation(cell, state.positions));
      return values;
    }
    case DivisionTrigger::time:
      break;
  }
  return {};
}

}  // namespace

CellCut cut_by(DivisionPlane plane, const Tissue& tissue, CellId id, const Vectors& positions) {
  const Cell& cell = tissue.cells[id.index()];
  const Vec3 u = mean_side(cell, 0, positions), v = mean_side(cell, 1, positions);
  double along_u = u.norm(), along_v = v.norm();
  if (plane != DivisionPlane::longest_axis) {
    const int axis = plane == DivisionPlane::transverse ? 0 : 1;
    along_u = std::abs(u[axis]) / along_u;
    along_v = std::abs(v[axis]) / along_v;
  }
  // A tie must not be decided by rounding: mirror images divide alike.
  return {id, along_u >= along_v * (1 - 1e-9) ? 0 : 1};
}

std::vector<PlannedDivision> due_divisions(const Model& model, const State& state,
                                           std::span<const DivisionRule> rules) {
  std::vector<PlannedDivision> due;
  std::vector<char> growing(model.tissue.cells.size(), 0), chosen(model.tissue.cells.size(), 0);
  for (const Growth& growth : model.growths) growing[growth.cell.index()] = !has_come(growth.end_s, state.time_s);
  for (const DivisionRule& rule : rules) {
    const bool at_a_time = rule.trigger == DivisionTrigger::time;
    if (at_a_time && (has_come(rule.threshold, state.divided_until_s) || !has_come(rule.threshold, state.time_s)))
      continue;
    const std::vector<double> values = measured(rule.trigger, model, state);
    const CellSet& region = model.tissue.regions.at(rule.region);
    for (std::size_t c = 0; c < region.size(); ++c) {
      if (!region[c] || chosen[c] || model.tissue.cells[c].lineage.generation >= rule.max_generation) continue;
      if (!at_a_time && (growing[c] || !(values[c] > rule.threshold))) continue;
      chosen[c] = 1;
      due.push_back({cut_by(rule.plane, model.tissue, CellId(c), state.positions), rule.growth_s, rule.volume_ratio});
    }
  }
  return due;
}

}  // namespace plica
