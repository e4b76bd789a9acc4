#include "mechanics/exchange.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <numeric>

#include "mechanics/cells_apart.hpp"
#include "mechanics/division.hpp"
#include "mechanics/elasticity/turning_elements.hpp"
#include "mechanics/energy.hpp"

namespace plica {
namespace {

// Inverse of the cell's mean elastic stretch V, without its change of volume.
Mat3 unstretch(const Model& model, const State& state, CellId id) {
  const Cell& cell = model.tissue.cells[id.index()];
  std::vector<ElementId> elements;
  for (int e = 0; e < cell.element_count; ++e) elements.emplace_back(cell.first_element.index() + e);
  for (std::size_t l = 0; l < model.laws.size(); ++l) {
    const auto b = model.laws[l]->elastic_stretch(state.internals[l], state.positions, elements);
    if (!b) continue;
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(*b);
    const Vec3 stretches = axes.eigenvalues().cwiseSqrt();
    const Vec3 inverse = std::cbrt(stretches.prod()) * stretches.cwiseInverse();
    return axes.eigenvectors() * inverse.asDiagonal() * axes.eigenvectors().transpose();
  }
  return Mat3::Identity();
}

// Energy of the laws less the work of pressures on the volumes: what remains of the energy once volumes are restored,
// to first order.
double energy_of(const Model& model, const State& state) {
  double sum = 0;
  for_laws(model, motionless(state, state.velocities),
           [&](const Law& law, const Step& step) { sum += law.energy(step); });
  const std::vector<double> volumes = model.volumes.volumes(state.positions);
  for (std::size_t c = 0; c < volumes.size(); ++c) sum -= state.multipliers[c] * volumes[c];
  return sum;
}

Vectors forces_of(const Model& model, const State& state) {
  Vectors forces(model.tissue.node_count(), Vec3::Zero());
  for_laws(model, motionless(state, state.velocities),
           [&](const Law& law, const Step& step) { law.add_forces(step, forces); });
  for_held_constraints(model, [&](const Constraint& constraint, std::size_t first, std::size_t) {
    constraint.add_forces(state.positions, std::span(state.multipliers).subspan(first, constraint.count()), forces);
  });
  model.tissue.carry_hanging(forces);
  return forces;
}

// Force by which the columns of the turned wall are pulled apart, nN: mean of base and apex.
double opening_force(const Model& model, const WallTurn& turn, const Vectors& positions, const Vectors& forces) {
  const auto &begin = column(model.tissue.sheet, turn.begin), &end = column(model.tissue.sheet, turn.end);
  double sum = 0;
  for (const std::size_t level : {std::size_t{0}, begin.size() - 1}) {
    const Vec3 way = wall_vector(model.tissue, turn, level, positions).normalized();
    sum += 0.5 * way.dot(forces[end[level].index()] - forces[begin[level].index()]);
  }
  return sum;
}

// Both columns of a wall take their mean velocity, without acceleration; pressures of remeshed cells are taken as
// constant.
void follow_trend(const Model& model, const TissueChange& change, std::span<const WallTurn> turns, State& state) {
  State::Trend& trend = state.trend;
  for (const WallTurn& turn : turns) {
    const auto &begin = column(model.tissue.sheet, turn.begin), &end = column(model.tissue.sheet, turn.end);
    for (std::size_t level = 0; level < begin.size(); ++level) {
      for (Vectors* velocities : {&state.velocities, &trend.mean_velocities}) {
        if (velocities->empty()) continue;
        Vec3 &one = (*velocities)[begin[level].index()], &other = (*velocities)[end[level].index()];
        one = other = 0.5 * (one + other);
      }
      for (const NodeId node : {begin[level], end[level]})
        if (!trend.accelerations.empty()) trend.accelerations[node.index()].setZero();
    }
  }
  if (!trend.multiplier_rates.empty())
    for (std::size_t c = 0; c < change.remeshed.size(); ++c)
      if (change.remeshed[c]) trend.multiplier_rates[c] = 0;
  for (Vectors* vectors : {&state.velocities, &trend.mean_velocities, &trend.accelerations})
    if (!vectors->empty()) *vectors = with_new_nodes(model.tissue, change, *vectors);
}

// Number of a former free node; invalid where it is no more.
NodeId now(const TissueChange& change, NodeId before) {
  const auto found = std::ranges::lower_bound(change.node_origin, before);
  return found == change.node_origin.end() || *found != before
             ? NodeId()
             : NodeId(static_cast<std::size_t>(found - change.node_origin.begin()));
}

// The column that is left of a cell takes the mean velocity.
void join_velocities(const Sheet& sheet, CellId cell, Vectors& velocities) {
  const std::vector<Stop>& ring = sheet.cells[cell.index()].ring;
  const std::vector<NodeId>& kept = column(sheet, ring[0].vertex);
  for (std::size_t level = 0; level < kept.size(); ++level) {
    Vec3 sum = Vec3::Zero();
    for (const Stop& stop : ring) sum += velocities[column(sheet, stop.vertex)[level].index()] / 3;
    velocities[kept[level].index()] = sum;
  }
}

// What is known by numbers of cells and nodes.
void renumber(const TissueChange& change, Model& model, Exchanges& exchanges) {
  std::erase_if(model.growths, [&](Growth& growth) {
    const auto found = std::ranges::lower_bound(change.origin, growth.cell);
    if (found == change.origin.end() || *found != growth.cell) return true;
    growth.cell = CellId(static_cast<std::size_t>(found - change.origin.begin()));
    return false;
  });
  std::erase_if(exchanges.recent, [&](Exchanges::Turned& one) {
    one.begin = now(change, one.begin), one.end = now(change, one.end);
    return !one.begin.valid() || !one.end.valid();
  });
}

// Sum of the products of points' distances from their means.
Mat3 moments_of(std::span<const Vec3> ones, std::span<const Vec3> others) {
  const auto mean = [](std::span<const Vec3> points) {
    return Vec3(std::accumulate(points.begin(), points.end(), Vec3(Vec3::Zero())) / static_cast<double>(points.size()));
  };
  const Vec3 middle = mean(ones), other_middle = mean(others);
  Mat3 sum = Mat3::Zero();
  for (std::size_t i = 0; i < ones.size(); ++i) sum += (ones[i] - middle) * (others[i] - other_middle).transpose();
  return sum;
}

// What daughters still have to grow: by cell, the map from its present to its final rest shape, both turned as it is.
std::map<CellId, Mat3> growth_ahead(const Model& settled, const State& state) {
  std::map<CellId, Mat3> ahead;
  for (const Growth& growth : settled.growths) {
    const Cell& cell = settled.tissue.cells[growth.cell.index()];
    std::vector<Vec3> now;
    for (const NodeId corner : cell.corners) now.push_back(state.positions[corner.index()]);
    const Mat3 inverse = moments_of(cell.rest_shape, cell.rest_shape).inverse();
    Mat3 turn, stretch;
    polar(moments_of(now, cell.rest_shape) * inverse, turn, stretch);
    ahead[growth.cell] = turn * moments_of(growth.rest_to, cell.rest_shape) * inverse * turn.transpose();
  }
  return ahead;
}

// Daughters with other corners grow on from the rest shapes that they have now.
void continue_growth(const TissueChange& change, const std::map<CellId, Mat3>& ahead, double time_s, Model& model) {
  for (Growth& growth : model.growths) {
    if (!change.is_remeshed(growth.cell)) continue;
    const Cell& cell = model.tissue.cells[growth.cell.index()];
    growth.rest_from = growth.rest_to = cell.rest_shape;
    for (Vec3& corner : growth.rest_to) corner = ahead.at(change.origin[growth.cell.index()]) * corner;
    growth.target_from = *cell.target_volume;
    growth.start_s = time_s;
  }
}

// Mesh cells again by `make`, which leaves the walls that turn.
TissueChange remesh(Model& model, State& state, std::span<const CellId> cells, const std::vector<WallTurn>& turns,
                    const std::function<TissueChange(const Unstretch&)>& make) {
  std::map<CellId, Mat3> inverse;
  for (const CellId cell : cells) inverse[cell] = unstretch(model, state, cell);
  const std::map<CellId, Mat3> ahead = growth_ahead(model, state);
  const Vectors before = state.positions;
  TissueChange change = make([&](CellId cell) { return inverse.at(cell); });
  continue_growth(change, ahead, state.time_s, model);
  follow_trend(model, change, turns, state);
  follow_change(model, state, change, before);
  return change;
}

TissueChange turn(Model& model, State& state, std::vector<WallTurn>& turns, double length_um) {
  std::vector<CellId> cells;
  for (const WallTurn& one : turns) std::ranges::copy_if(one.cells(), std::back_inserter(cells), &CellId::valid);
  return remesh(model, state, cells, turns, [&](const Unstretch& unstretched) {
    return turn_walls(model.tissue, turns, length_um, state.positions, unstretched);
  });
}

enum class Turning { by_forces, always };

// Leave those of the walls that turn, tried on copies of a model with shapes of the present; return the change of
// energy.
double judge(const Model& before, const State& state, std::vector<WallTurn>& turns, double length_um, Turning turning) {
  while (!turns.empty()) {
    Model turned(before);
    State then = state;
    turn(turned, then, turns, length_um);
    const Vectors forces = forces_of(turned, then);
    const auto opening = [&](const WallTurn& one) { return opening_force(turned, one, then.positions, forces); };
    if (turning == Turning::by_forces && std::erase_if(turns, [&](const auto& one) { return !(opening(one) > 0); }) > 0)
      continue;
    if (turns.empty()) break;
    const double energy = energy_of(turned, then) - energy_of(before, state);
    if (turning == Turning::always || energy < 0) return energy;
    turns.erase(std::ranges::min_element(turns, {}, opening));
  }
  return 0;
}

// Cells about walls, and their neighbours: no other cell exerts forces on the columns of the walls or changes its
// energy if they turn.
CellSet cells_about(const Sheet& sheet, std::span<const WallTurn> turns) {
  CellSet about(sheet.cells.size(), false);
  for (const WallTurn& turn : turns)
    for (const CellId cell : turn.cells()) {
      if (!cell.valid()) continue;
      about[cell.index()] = true;
      for (const Stop& stop : sheet.cells[cell.index()].ring)
        if (const CellId one = sheet.walls[stop.wall.index()].beyond(cell); one.valid()) about[one.index()] = true;
    }
  return about;
}

bool joins_distant_cells(const Model& model) {
  return std::ranges::any_of(model.laws, [](const auto& law) { return law->self_contact() || law->enclosed_fluid(); });
}

// The same on a part of the tissue where laws join near cells only.
double judge_in_part(const Model& present, const State& state, std::vector<WallTurn>& turns, double length_um,
                     Turning turning) {
  if (joins_distant_cells(present)) return judge(present, state, turns, length_um, turning);
  const CellsApart part(present, state.positions, cells_about(present.tissue.sheet, turns));
  std::vector<WallTurn> of_part = turns;
  for (WallTurn& turn : of_part)
    for (CellId* cell : {&turn.left, &turn.right, &turn.behind, &turn.ahead}) *cell = part.number_of(*cell);
  const double energy = judge(part.model(), part.state(present, state), of_part, length_um, turning);
  std::erase_if(turns, [&](const WallTurn& turn) {
    return std::ranges::find(of_part, turn.wall, &WallTurn::wall) == of_part.end();
  });
  return energy;
}

std::optional<ExchangeOutcome> change_neighbours(Model& model, State& state, std::vector<WallTurn> turns,
                                                 double length_um, Turning turning) {
  if (turns.empty()) return std::nullopt;
  const std::optional<Model> now = grown(model, model, state.internals, state.time_s);
  const double energy = judge_in_part(now ? *now : model, state, turns, length_um, turning);
  if (turns.empty()) return std::nullopt;
  settle_growth(model, state);
  TissueChange change = turn(model, state, turns, length_um);
  return ExchangeOutcome{std::move(change), std::move(turns), energy};
}

}  // namespace

std::optional<ExchangeOutcome> exchange_neighbours(Model& model, State& state, std::vector<WallTurn> turns,
                                                   double length_um) {
  return change_neighbours(model, state, std::move(turns), length_um, Turning::by_forces);
}

std::optional<ExchangeOutcome> part_neighbours(Model& model, State& state, std::vector<WallTurn> turns,
                                               double length_um) {
  return change_neighbours(model, state, std::move(turns), length_um, Turning::always);
}

std::vector<CellId> cells_to_split(const Model& model, const State& state, const CellSet& among) {
  std::vector<CellId> cells = badly_split(model.tissue, state.positions);
  std::erase_if(cells, [&](CellId cell) { return !among[cell.index()]; });
  if (cells.empty()) return cells;
  const std::optional<Model> now = grown(model, model, state.internals, state.time_s);
  const auto of_now = [&](CellId cell) { return unstretch(now ? *now : model, state, cell); };
  std::erase_if(cells, [&](CellId cell) { return !gains_by_split(model.tissue, cell, state.positions, of_now); });
  return cells;
}

SplitOutcome split_cells(Model& model, State& state, std::vector<CellId> cells) {
  settle_growth(model, state);
  const double before = energy_of(model, state);
  TissueChange change = remesh(model, state, cells, {}, [&](const Unstretch& unstretched) {
    return split_again(model.tissue, cells, state.positions, unstretched);
  });
  return {std::move(change), std::move(cells), energy_of(model, state) - before};
}

std::optional<ExtrusionOutcome> extrude_cells(Model& model, State& state, std::vector<CellId> cells) {
  if (cells.empty()) return std::nullopt;
  Model without(model);
  State then = state;
  settle_growth(without, state);
  std::vector<Mat3> inverse;
  for (std::size_t c = 0; c < without.tissue.cells.size(); ++c) inverse.push_back(unstretch(without, state, CellId(c)));
  const std::vector<double> volumes = without.volumes.volumes(state.positions);
  const std::map<CellId, Mat3> ahead = growth_ahead(without, state);
  const Sheet before = without.tissue.sheet;
  ExtrusionOutcome outcome;
  outcome.change = take_out(without.tissue, cells, then.positions, [&](CellId cell) { return inverse[cell.index()]; });
  if (cells.empty()) return std::nullopt;
  for (const CellId cell : cells) {
    join_velocities(before, cell, then.velocities);
    outcome.volume_um3 += volumes[cell.index()];
  }
  outcome.count = static_cast<int>(cells.size());
  outcome.cells = std::move(cells);
  then.velocities = with_new_nodes(without.tissue, outcome.change, then.velocities);
  then.trend = {};
  renumber(outcome.change, without, then.exchanges);
  continue_growth(outcome.change, ahead, state.time_s, without);
  follow_change(without, then, outcome.change, state.positions);
  model = std::move(without);
  state = std::move(then);
  return outcome;
}

}  // namespace plica
