#include "simulation/exchange_rules.hpp"

#include <algorithm>
#include <utility>

#include "core/clock.hpp"

namespace plica {
namespace {

// Rate of the sum of its lengths at base and apex, um/s.
double lengthening(const Model& model, const State& state, const WallTurn& turn) {
  const auto &begin = column(model.tissue.sheet, turn.begin), &end = column(model.tissue.sheet, turn.end);
  double rate = 0;
  for (const std::size_t level : {std::size_t{0}, begin.size() - 1})
    rate += wall_vector(model.tissue, turn, level, state.positions)
                .normalized()
                .dot(state.velocities[end[level].index()] - state.velocities[begin[level].index()]);
  return rate;
}

bool is_free(const Model& model, VertexId vertex) {
  return std::ranges::all_of(column(model.tissue.sheet, vertex),
                             [&](NodeId node) { return std::ranges::count(model.held[node.index()], true) == 0; });
}

}  // namespace

std::vector<WallTurn> due_exchanges(const Model& model, const State& state, const ExchangeRule& rule) {
  const Tissue& tissue = model.tissue;
  CellSet may = tissue.regions.at(rule.region);
  for (const Growth& growth : model.growths)
    if (!has_come(growth.end_s, state.time_s)) may[growth.cell.index()] = false;
  const auto is_recent = [&](const WallTurn& turn) {
    const NodeId begin = column(tissue.sheet, turn.begin).front(), end = column(tissue.sheet, turn.end).front();
    return std::ranges::any_of(state.exchanges.recent, [&](const Exchanges::Turned& one) {
      return (one.begin == begin && one.end == end) || (one.begin == end && one.end == begin);
    });
  };
  std::vector<std::pair<double, WallTurn>> found;
  for (const WallTurn& turn : possible_turns(tissue.sheet)) {
    const double length = wall_length(tissue, turn, state.positions);
    if (length >= rule.below_um || !(lengthening(model, state, turn) < 0) || is_recent(turn)) continue;
    const auto is_out = [&](CellId cell) { return cell.valid() && !may[cell.index()]; };
    if (std::ranges::any_of(turn.cells(), is_out) || !is_free(model, turn.begin) || !is_free(model, turn.end)) continue;
    found.emplace_back(length, turn);
  }
  std::ranges::stable_sort(found, {}, &std::pair<double, WallTurn>::first);
  std::vector<WallTurn> due;
  CellSet taken(tissue.cells.size(), false);
  for (const auto& [length, turn] : found) {
    const auto is_taken = [&](CellId cell) { return cell.valid() && taken[cell.index()]; };
    if (std::ranges::any_of(turn.cells(), is_taken)) continue;
    for (const CellId cell : turn.cells())
      if (cell.valid()) taken[cell.index()] = true;
    due.push_back(turn);
  }
  return due;
}

std::optional<ExchangeOutcome> make_exchanges(Model& model, State& state, const ExchangeRule& rule) {
  state.exchanges.until_s = state.time_s;
  std::erase_if(state.exchanges.recent,
                [&](const Exchanges::Turned& one) { return has_come(one.time_s + rule.again_after_s, state.time_s); });
  const std::vector<WallTurn> due = due_exchanges(model, state, rule);
  std::optional<ExchangeOutcome> outcome = exchange_neighbours(model, state, due, rule.new_length_um);
  const Sheet& sheet = model.tissue.sheet;
  for (const WallTurn& turn : due)
    state.exchanges.recent.push_back(
        {column(sheet, turn.begin).front(), column(sheet, turn.end).front(), state.time_s});
  if (!outcome) return std::nullopt;
  state.exchanges.count += static_cast<int>(outcome->turns.size());
  state.exchanges.energy += outcome->energy;
  return outcome;
}

std::optional<ExtrusionOutcome> make_extrusions(Model& model, State& state, std::span<const ExtrusionRule> rules) {
  if (rules.empty()) return std::nullopt;
  const Tissue& tissue = model.tissue;
  const std::vector<double> areas = face_areas(tissue, CellSide::apical, state.positions);
  std::vector<CellId> due;
  CellSet taken(tissue.cells.size(), false);
  for (const ExtrusionRule& rule : rules)
    for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
      const CellId cell(c);
      if (!tissue.regions.at(rule.region)[c] || !(areas[c] < rule.below_um2) || !can_leave(tissue.sheet, cell))
        continue;
      std::vector<CellId> about = {cell};
      bool is_held = false;
      for (const Stop& stop : tissue.sheet.cells[c].ring) {
        about.push_back(tissue.sheet.walls[stop.wall.index()].beyond(cell));
        is_held |= !is_free(model, stop.vertex);
      }
      if (is_held || std::ranges::any_of(about, [&](CellId one) { return taken[one.index()]; })) continue;
      for (const CellId one : about) taken[one.index()] = true;
      due.push_back(cell);
    }
  std::optional<ExtrusionOutcome> outcome = extrude_cells(model, state, std::move(due));
  if (!outcome) return std::nullopt;
  state.exchanges.extruded += outcome->count;
  state.exchanges.extruded_um3 += outcome->volume_um3;
  return outcome;
}

}  // namespace plica
