#include "mechanics/division.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "tissue/mesher.hpp"
#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

// Growth of each daughter; cells by their index before the cut.
struct FinalShape {
  std::vector<Vec3> rest_to;
  double target_to;
  bool cuts_bend = false;
};

// Final shape of a mother cell: the target of its growth, or its present shape.
FinalShape final_shape(const Model& model, CellId cell) {
  const bool bends = cuts_bend(model.tissue, cell);
  for (const Growth& growth : model.growths)
    if (growth.cell == cell) return {growth.rest_to, growth.target_to, bends};
  return {model.tissue.cells[cell.index()].rest_shape, model.volumes.targets()[cell.index()], bends};
}

double prism_volume(const PrismCorners& corners) {
  double volume = 0;
  for (const OutlineQuad& kite : split_into_kites(corners_of_polygon(corners.apical.size())))
    volume += hex_volume(part_over(corners, kite));
  return volume;
}

// Part of the final shape of a grid mother, of width `ratio`, on the side of the daughter.
std::vector<Vec3> part_of_hexahedron(int first_wall, bool is_low, const std::vector<Vec3>& mother, double ratio) {
  const Vec3 across = Vec3::Unit(first_wall);
  const HexPoints whole = hexahedron(mother);
  const HexPoints part = is_low ? hex_part(whole, Vec3::Zero(), Vec3::Ones() - (1 - ratio) * across)
                                : hex_part(whole, (1 - ratio) * across, Vec3::Ones());
  return {part.begin(), part.end()};
}

// Part of any other mother: its half, stretched away from the cut to `ratio` of its volume.
std::vector<Vec3> stretched_half(const CellCut& cut, bool is_low, const FinalShape& of_mother, double ratio) {
  const std::vector<Vec3>& mother = of_mother.rest_to;
  auto [low, high] = halves_of_prism(cut, mother, of_mother.cuts_bend);
  std::vector<Vec3> half = is_low ? std::move(low) : std::move(high);
  const PrismCorners whole = prism_of(mother);
  const OutlinePlace first{cut.first_wall, cut.first_at}, second{cut.second_wall, cut.second_at};
  const Vec3 basal = place_in(whole.basal, first), apical = place_in(whole.apical, first),
             along = place_in(whole.basal, second) - basal + place_in(whole.apical, second) - apical;
  const Vec3 up = place_in(whole.apical, {}) - place_in(whole.basal, {});
  const Vec3 across = along.cross(up).normalized(), origin = 0.5 * (basal + apical);
  const double stretch = ratio * prism_volume(whole) / prism_volume(prism_of(half));
  for (Vec3& corner : half) corner += (stretch - 1) * across.dot(corner - origin) * across;
  return half;
}

std::array<Growth, 2> growths_of(const PlannedDivision& plan, const std::array<CellId, 2>& daughters,
                                 const FinalShape& mother, const Tissue& tissue, const Vectors& positions,
                                 double time_s) {
  std::array<Growth, 2> growths;
  const bool is_hexahedron = !mother.cuts_bend && mother.rest_to.size() == 8 &&
                             plan.cut.second_wall == plan.cut.first_wall + 2 && plan.cut.is_through_middles();
  for (const int i : {0, 1}) {
    Growth& growth = growths[i];
    const Cell& daughter = tissue.cells[daughters[i].index()];
    growth.cell = daughters[i];
    growth.rest_from = daughter.rest_shape;
    growth.rest_to = is_hexahedron ? part_of_hexahedron(plan.cut.first_wall, i == 0, mother.rest_to, plan.volume_ratio)
                                   : stretched_half(plan.cut, i == 0, mother, plan.volume_ratio);
    growth.target_from = cell_volume(tissue, daughter, positions);
    growth.target_to = plan.volume_ratio * mother.target_to;
    growth.start_s = time_s;
    growth.end_s = time_s + plan.growth_s;
  }
  return growths;
}

void divide_laws(Model& model, State& state, const TissueChange& change, const Vectors& before) {
  state.internals.resize(model.laws.size());
  for (std::size_t l = 0; l < model.laws.size(); ++l) {
    state.internals[l] =
        model.laws[l]->internal_after_change(state.internals[l], model.tissue, change, {before, state.positions});
    std::unique_ptr<Law> law = model.laws[l]->after_change(model.tissue, change, state.positions);
    law->set_label(model.laws[l]->label());
    model.laws[l] = std::move(law);
  }
}

void divide_constraints(Model& model, State& state, const TissueChange& change) {
  state.multipliers = multipliers_after(model, state.multipliers, change);
  model.volumes = model.volumes.divided(model.tissue, change);
  for (auto& constraint : model.constraints)
    constraint = constraint->after_change(model.tissue, change, state.positions);
}

// Held nodes stay held; a new one is where all nodes that it lies between are.
void divide_holds(Model& model, const TissueChange& change) {
  std::vector<std::array<bool, 3>> before = std::move(model.held);
  model.held.clear();
  for (const NodeId node : change.node_origin) model.held.push_back(before[node.index()]);
  for (const NodeMean& place : change.new_nodes) {
    std::array<bool, 3> held = {true, true, true};
    for (const auto& [node, weight] : place)
      for (int axis = 0; axis < 3; ++axis) held[axis] = held[axis] && model.held[node.index()][axis];
    model.held.push_back(held);
  }
  model.held.resize(model.tissue.node_count(), {false, false, false});
}

// New nodes begin without contact: the midpoint of two nodes lies inside the shell. On a bent face, which is blended
// from its edges, a node may lie outside; the next step projects it back.
void divide_obstacles(Model& model, State& state, const TissueChange& change) {
  std::vector<double> forces;
  std::vector<char> on_obstacle;
  std::size_t first = 0;  // of the obstacle's contacts before
  for (auto& obstacle : model.obstacles) {
    std::map<NodeId, std::size_t> place;
    for (const NodeId node : obstacle->nodes()) place[node] = first++;
    obstacle = obstacle->after_change(model.tissue, change);
    for (const NodeId node : obstacle->nodes()) {
      const auto known = place.find(node.index() < change.kept_nodes() ? change.node_origin[node.index()] : node);
      forces.push_back(known == place.end() ? 0 : state.obstacle_forces[known->second]);
      on_obstacle.push_back(known == place.end() ? 0 : state.on_obstacle[known->second]);
    }
  }
  state.obstacle_forces = std::move(forces);
  state.on_obstacle = std::move(on_obstacle);
}

Vec3 momentum(const Model& model, const Vectors& velocities) {
  Vec3 sum = Vec3::Zero();
  const std::span<const double> masses = model.masses();
  for (std::size_t n = 0; n < masses.size(); ++n) sum += masses[n] * velocities[n];
  return sum;
}

// Halves of unequal mass, moving as their mother did, would have another momentum: new nodes make up for it, where they
// can move.
void restore_momentum(const Model& model, const TissueChange& change, const Vec3& before, Vectors& velocities) {
  if (change.new_nodes.empty()) return;
  Vectors unit(model.tissue.node_count(), Vec3::Zero());
  for (std::size_t n = change.kept_nodes(); n < model.tissue.free_node_count(); ++n)
    for (int axis = 0; axis < 3; ++axis) unit[n][axis] = model.held[n][axis] ? 0 : 1;
  model.tissue.place_hanging(unit);
  const Vec3 mass = momentum(model, unit);
  Vec3 missing = before - momentum(model, velocities);
  for (int axis = 0; axis < 3; ++axis) missing[axis] = mass[axis] > 0 ? missing[axis] / mass[axis] : 0;
  for (std::size_t n = 0; n < velocities.size(); ++n) velocities[n] += unit[n].cwiseProduct(missing);
}

}  // namespace

TissueChange divide_cells(Model& model, State& state, std::span<const PlannedDivision> planned) {
  if (const auto why = why_indivisible(model.tissue)) throw std::logic_error("cells cannot divide: " + *why);
  settle_growth(model, state);

  const Vec3 momentum_before = momentum(model, state.velocities);
  std::vector<CellCut> cuts;
  std::vector<FinalShape> final_shapes;
  for (const PlannedDivision& plan : planned) {
    cuts.push_back(plan.cut);
    final_shapes.push_back(final_shape(model, plan.cut.cell));
    std::erase_if(model.growths, [&](const Growth& growth) { return growth.cell == plan.cut.cell; });
  }

  TissueChange change = divide(model.tissue, cuts, state.time_s, state.positions);
  const Vectors before = std::move(state.positions);
  state.positions = with_new_nodes(model.tissue, change, before);
  state.velocities = with_new_nodes(model.tissue, change, state.velocities);
  state.trend = {};

  for (std::size_t i = 0; i < planned.size(); ++i)
    for (const Growth& growth :
         growths_of(planned[i], change.daughters[i], final_shapes[i], model.tissue, state.positions, state.time_s)) {
      model.tissue.cells[growth.cell.index()].target_volume = growth.target_from;
      model.growths.push_back(growth);
    }

  follow_change(model, state, change, before);
  if (!model.masses().empty()) restore_momentum(model, change, momentum_before, state.velocities);
  return change;
}

void follow_change(Model& model, State& state, const TissueChange& change, const Vectors& before) {
  const std::vector<double> volumes_before = model.volumes.volumes(before);
  divide_constraints(model, state, change);
  divide_laws(model, state, change, before);
  model.signals = model.signals.after(model.tissue, change);
  state.signals = inherited_signals(change, volumes_before, model.volumes.volumes(state.positions), state.signals);
  divide_holds(model, change);
  divide_obstacles(model, state, change);
  model.revision = ++Model::revisions;
}

std::vector<double> multipliers_after(const Model& model, std::span<const double> multipliers,
                                      const TissueChange& change) {
  std::vector<double> after;
  for (std::size_t place = 0; place < model.constraint_count(); ++place) {
    const Constraint& constraint = model.constraint(place);
    const auto own = constraint.multipliers_after_division(multipliers.first(constraint.count()), change);
    after.insert(after.end(), own.begin(), own.end());
    multipliers = multipliers.subspan(constraint.count());
  }
  return after;
}

void settle_growth(Model& model, const State& state) {
  if (std::optional<Model> now = grown(model, model, state.internals, state.time_s)) model = std::move(*now);
  std::erase_if(model.growths, [&](const Growth& growth) { return growth.end_s <= state.time_s; });
}

}  // namespace plica
