#include "simulation/exchange_rules.hpp"

#include <algorithm>
#include <limits>
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

// Whether cells part from their neighbours, whatever pulls at their walls: they leave, and their apex and base are both
// much smaller than those of their neighbours.
CellSet dwindled_cells(const Model& model, const State& state, std::span<const ExtrusionRule> rules) {
  constexpr double dwindled = 0.25;  // of the mean area of the neighbours
  const Tissue& tissue = model.tissue;
  CellSet all = leaving_cells(model, state, rules);
  if (std::ranges::count(all, true) == 0) return all;
  const std::vector<double> apical = face_areas(tissue, CellSide::apical, state.positions),
                            basal = face_areas(tissue, CellSide::basal, state.positions);
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (!all[c]) continue;
    double about_apical = 0, about_basal = 0;
    int neighbours = 0;
    for (const Stop& stop : tissue.sheet.cells[c].ring)
      if (const CellId one = tissue.sheet.walls[stop.wall.index()].beyond(CellId(c)); one.valid()) {
        about_apical += apical[one.index()], about_basal += basal[one.index()];
        ++neighbours;
      }
    all[c] = neighbours * apical[c] < dwindled * about_apical && neighbours * basal[c] < dwindled * about_basal;
  }
  return all;
}

bool is_of(const WallTurn& turn, const Sheet& sheet, const Exchanges::Turned& one) {
  const NodeId begin = column(sheet, turn.begin).front(), end = column(sheet, turn.end).front();
  return (one.begin == begin && one.end == end) || (one.begin == end && one.end == begin);
}

// Walls below a length, um, that may turn by topology, cells and earlier turns, with their lengths; the shortest first.
std::vector<std::pair<double, WallTurn>> free_turns(const Model& model, const State& state, const ExchangeRule& rule,
                                                    double below_um) {
  const Tissue& tissue = model.tissue;
  const CellSet& may = tissue.regions.at(rule.region);
  const auto is_recent = [&](const WallTurn& turn) {
    return std::ranges::any_of(state.exchanges.recent, [&](const auto& one) { return is_of(turn, tissue.sheet, one); });
  };
  std::vector<std::pair<double, WallTurn>> found;
  for (const WallTurn& turn : possible_turns(tissue.sheet)) {
    const double length = wall_length(tissue, turn, state.positions);
    const auto is_out = [&](CellId cell) { return cell.valid() && !may[cell.index()]; };
    if (length >= below_um || is_recent(turn) || std::ranges::any_of(turn.cells(), is_out) ||
        !is_free(model, turn.begin) || !is_free(model, turn.end))
      continue;
    found.emplace_back(length, turn);
  }
  std::ranges::stable_sort(found, {}, &std::pair<double, WallTurn>::first);
  return found;
}

// Take the cells of a turn, unless one is taken.
bool take(const WallTurn& turn, CellSet& taken) {
  const std::array cells = turn.cells();
  if (std::ranges::any_of(cells, [&](CellId cell) { return cell.valid() && taken[cell.index()]; })) return false;
  for (const CellId cell : cells)
    if (cell.valid()) taken[cell.index()] = true;
  return true;
}

void count(const ExchangeOutcome& outcome, Exchanges& exchanges) {
  exchanges.count += static_cast<int>(outcome.turns.size());
  exchanges.energy += outcome.energy;
}

// Length of the wall of a cell about to leave after it has turned; `length_um`: before.
double parted_length_um(const ExchangeRule& rule, double length_um) {
  return std::min(rule.new_length_um, 0.5 * length_um);
}

Exchanges::Turned turned_now(const Sheet& sheet, const WallTurn& turn, const State& state) {
  return {column(sheet, turn.begin).front(), column(sheet, turn.end).front(), state.time_s};
}

}  // namespace

CellSet leaving_cells(const Model& model, const State& state, std::span<const ExtrusionRule> rules) {
  CellSet leaving(model.tissue.cells.size(), false);
  if (rules.empty()) return leaving;
  const std::vector<double> apical = face_areas(model.tissue, CellSide::apical, state.positions),
                            basal = face_areas(model.tissue, CellSide::basal, state.positions);
  const auto is_small = [](double area, const std::optional<double>& below) { return !below || area < *below; };
  for (const ExtrusionRule& rule : rules)
    for (std::size_t c = 0; c < leaving.size(); ++c)
      if (model.tissue.regions.at(rule.region)[c] && is_small(apical[c], rule.apical_below_um2) &&
          is_small(basal[c], rule.basal_below_um2))
        leaving[c] = true;
  return leaving;
}

std::vector<WallTurn> due_exchanges(const Model& model, const State& state, const ExchangeRule& rule,
                                    std::span<const ExtrusionRule> extrusions) {
  const CellSet dwindled = dwindled_cells(model, state, extrusions);
  std::vector<WallTurn> due;
  CellSet taken(model.tissue.cells.size(), false);
  for (const auto& [length, turn] : free_turns(model, state, rule, rule.below_um)) {
    const auto gains = [&](CellId cell) { return cell.valid() && dwindled[cell.index()]; };
    if (gains(turn.behind) || gains(turn.ahead) || !(lengthening(model, state, turn) < 0) || !take(turn, taken))
      continue;
    due.push_back(turn);
  }
  return due;
}

std::optional<ExchangeOutcome> make_exchanges(Model& model, State& state, const ExchangeRule& rule,
                                              std::span<const ExtrusionRule> extrusions) {
  state.exchanges.until_s = state.time_s;
  std::erase_if(state.exchanges.recent,
                [&](const Exchanges::Turned& one) { return has_come(one.time_s + rule.again_after_s, state.time_s); });
  const std::vector<WallTurn> due = due_exchanges(model, state, rule, extrusions);
  std::optional<ExchangeOutcome> outcome = exchange_neighbours(model, state, due, rule.new_length_um);
  const Sheet& sheet = model.tissue.sheet;
  for (const WallTurn& turn : due) state.exchanges.recent.push_back(turned_now(sheet, turn, state));
  if (outcome) count(*outcome, state.exchanges);
  return outcome;
}

std::optional<ExchangeOutcome> make_parting(Model& model, State& state, const ExchangeRule& rule,
                                            std::span<const ExtrusionRule> extrusions) {
  const Sheet& sheet = model.tissue.sheet;
  CellSet parting = dwindled_cells(model, state, extrusions);
  for (std::size_t c = 0; c < parting.size(); ++c) parting[c] = parting[c] && sheet.cells[c].ring.size() > 3;
  if (std::ranges::count(parting, true) == 0) return std::nullopt;
  const auto has_turned = [&](VertexId vertex) {
    const NodeId node = column(sheet, vertex).front();
    return std::ranges::any_of(state.exchanges.recent, [&](const Exchanges::Turned& one) {
      return one.time_s == state.time_s && (one.begin == node || one.end == node);
    });
  };
  const auto parts = [&](CellId cell) {
    return cell.valid() && parting[cell.index()] &&
           std::ranges::none_of(sheet.cells[cell.index()].ring, has_turned, &Stop::vertex);
  };
  for (const auto& [length, turn] : free_turns(model, state, rule, std::numeric_limits<double>::infinity())) {
    if (!parts(turn.left) && !parts(turn.right)) continue;
    state.exchanges.recent.push_back(turned_now(sheet, turn, state));
    std::optional<ExchangeOutcome> outcome = part_neighbours(model, state, {turn}, parted_length_um(rule, length));
    if (!outcome) continue;
    count(*outcome, state.exchanges);
    return outcome;
  }
  return std::nullopt;
}

std::optional<ExtrusionOutcome> make_extrusions(Model& model, State& state, std::span<const ExtrusionRule> rules) {
  if (rules.empty()) return std::nullopt;
  const Tissue& tissue = model.tissue;
  const CellSet leaving = leaving_cells(model, state, rules);
  std::vector<CellId> due;
  CellSet taken(tissue.cells.size(), false);
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const CellId cell(c);
    if (!leaving[c] || !can_leave(tissue.sheet, cell)) continue;
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

std::optional<SplitOutcome> make_splits(Model& model, State& state, const ExchangeRule& rule) {
  std::vector<CellId> due = cells_to_split(model, state, model.tissue.regions.at(rule.region));
  if (due.empty()) return std::nullopt;
  SplitOutcome outcome = split_cells(model, state, std::move(due));
  state.exchanges.energy += outcome.energy;
  return outcome;
}

std::optional<ExchangeOutcome> undo_exchanges(Model& model, State& state, const ExchangeRule& rule) {
  const Sheet& sheet = model.tissue.sheet;
  std::vector<WallTurn> turns;
  CellSet taken(model.tissue.cells.size(), false);
  for (const WallTurn& turn : possible_turns(sheet)) {
    const bool has_turned = std::ranges::any_of(state.exchanges.recent, [&](const Exchanges::Turned& one) {
      return one.time_s == state.time_s && is_of(turn, sheet, one);
    });
    // Walls that were judged only are still short.
    const bool is_made = has_turned && wall_length(model.tissue, turn, state.positions) > rule.below_um;
    if (is_made && take(turn, taken)) turns.push_back(turn);
  }
  std::optional<ExchangeOutcome> outcome = part_neighbours(model, state, std::move(turns), rule.new_length_um);
  if (!outcome) return std::nullopt;
  state.exchanges.count -= static_cast<int>(outcome->turns.size());
  state.exchanges.energy += outcome->energy;
  return outcome;
}

RepeatedChange repeated_exchange(const ExchangeOutcome& outcome, const ExchangeRule& rule) {
  return [turns = outcome.turns, length_um = rule.new_length_um](Model& model, State& state) {
    const auto again = part_neighbours(model, state, turns, length_um);
    return again && again->turns.size() == turns.size();
  };
}

RepeatedChange repeated_parting(const ExchangeOutcome& outcome, const ExchangeRule& rule) {
  return [turns = outcome.turns, rule](Model& model, State& state) {
    const double length_um = wall_length(model.tissue, turns.front(), state.positions);
    return part_neighbours(model, state, turns, parted_length_um(rule, length_um)).has_value();
  };
}

RepeatedChange repeated_extrusion(const ExtrusionOutcome& outcome) {
  return [cells = outcome.cells](Model& model, State& state) {
    const auto again = extrude_cells(model, state, cells);
    return again && again->cells.size() == cells.size();
  };
}

RepeatedChange repeated_split(const SplitOutcome& outcome) {
  return [cells = outcome.cells](Model& model, State& state) {
    split_cells(model, state, cells);
    return true;
  };
}

}  // namespace plica
