// Exchange of neighbours by forces: one event, and runs with many.
#include "mechanics/exchange.hpp"

#include "measure/cells.hpp"
#include "measure/neighbours.hpp"
#include "mechanics/active/cortex.hpp"
#include "mechanics/contact/self_contact.hpp"
#include "mechanics/elasticity/corner_barrier.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "mechanics/energy.hpp"
#include "mechanics/foundation.hpp"
#include "mechanics/model_memory.hpp"
#include "support/divided.hpp"
#include "support/prisms.hpp"
#include "support/ran.hpp"
#include "tissue/mesh_quality.hpp"

namespace {

constexpr double relaxation_s = 60;

CellSet every_cell(const Tissue& tissue) { return CellSet(tissue.cells.size(), true); }

// Soft cells that flow, whose lateral faces pull, and whose other faces hold the sheet flat.
Model foam(Tissue tissue, double lateral_stiffness = 0) {
  Model model(std::move(tissue));
  const Tissue& t = model.tissue;
  model.stiffness_scale = 0.1;
  model.laws.push_back(
      std::make_unique<NeoHookean>(t, std::vector<NeoHookeanMaterial>(t.elements.size(), {0.05, relaxation_s})));
  model.laws.push_back(std::make_unique<CornerBarrier>(t, 0.03));
  CortexRule lateral{.side = CellSide::lateral, .tension = 0.5, .stiffness = lateral_stiffness};
  if (lateral_stiffness > 0) lateral.relaxation_s = relaxation_s;
  model.laws.push_back(std::make_unique<Cortex>(t, every_cell(t), lateral));
  for (const CellSide side : {CellSide::apical, CellSide::basal})
    model.laws.push_back(std::make_unique<Cortex>(t, every_cell(t), CortexRule{.side = side, .tension = 0.42}));
  add_drag(model);
  return model;
}

// A sheet of 36 cells whose shapes are far from even.
Tissue uneven_sheet(unsigned seed = 3, double size = 0.15) {
  return tissue_from_prisms(irregular_polygons(6, 6, 3.5, 10, size, seed), PolygonSplit::diagonals, 1);
}

State flowed_state(const Model& model) {
  State state = rest_state(model);
  Random random(5);
  for (Vec3& x : state.positions) x += random.vector(0.1);
  model.tissue.place_hanging(state.positions);
  Step step{.positions = state.positions,
            .previous_positions = state.positions,
            .previous_velocities = state.velocities,
            .rate_s = 30,
            .internals = state.internals};
  state.internals = next_internals(model, step);
  return state;
}

// The shortest of the walls that may turn by forces.
std::optional<ExchangeOutcome> shortest_turned(Model& model, State& state) {
  std::vector<WallTurn> turns = possible_turns(model.tissue.sheet);
  std::ranges::sort(turns, {}, [&](const WallTurn& turn) { return wall_length(model.tissue, turn, state.positions); });
  for (const WallTurn& turn : turns)
    if (auto outcome = exchange_neighbours(model, state, {turn}, 0.5)) return outcome;
  return std::nullopt;
}

Mat3 without_volume(const Mat3& b) { return b / std::cbrt(b.determinant()); }

Mat3 stretch_of(const Model& model, const State& state, CellId id) {
  const Cell& cell = model.tissue.cells[id.index()];
  std::vector<ElementId> elements;
  for (int e = 0; e < cell.element_count; ++e) elements.emplace_back(cell.first_element.index() + e);
  return without_volume(*model.laws[0]->elastic_stretch(state.internals[0], state.positions, elements));
}

TEST(ExchangeOfCells, KeepsTheirMeanElasticStretch) {
  Model model = foam(uneven_sheet());
  State state = flowed_state(model);
  const Model before(model);
  const State then = state;
  const auto outcome = shortest_turned(model, state);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(state.multipliers, then.multipliers);
  for (std::size_t c = 0; c < model.tissue.cells.size(); ++c) {
    const Mat3 was = stretch_of(before, then, CellId(c)), is = stretch_of(model, state, CellId(c));
    EXPECT_LE((was - is).norm(), 1e-9) << c;
    if (outcome->change.is_remeshed(CellId(c)))
      EXPECT_GT((was - Mat3::Identity()).norm(), 1e-3);
    else
      EXPECT_EQ(model.tissue.cells[c].rest_shape, before.tissue.cells[c].rest_shape);
  }
}

TEST(ExchangeOfCells, LeavesCorticesWhatTheyAre) {
  Model model = foam(uneven_sheet(), 0.2);
  State state = flowed_state(model);
  const Model before(model);
  const State then = state;
  const auto outcome = shortest_turned(model, state);
  ASSERT_TRUE(outcome);
  // Tension beyond the constant 0.5 is elastic: that of the new face is 0, that of others as it was, unless a column
  // moved.
  const auto tensions_of = [](const Model& of, const State& at) {
    const auto& law = dynamic_cast<const Cortex&>(*of.laws[2]);
    Step step = motionless(at, at.velocities);
    step.internal = at.internals[2];
    std::map<std::pair<CellId, CellId>, double> tensions;
    const std::vector<double> all = law.tensions(step);
    for (std::size_t f = 0; f < all.size(); ++f)
      tensions[std::minmax(law.faces()[f].cell, law.faces()[f].beyond.value_or(CellId()))] = all[f] - 0.5;
    return tensions;
  };
  const auto was = tensions_of(before, then), is = tensions_of(model, state);
  const auto met = std::minmax(outcome->turns[0].behind, outcome->turns[0].ahead);
  EXPECT_FALSE(was.contains(met));
  EXPECT_NEAR(is.at(met), 0, 1e-9);
  int same = 0;
  for (const auto& [cells, tension] : is) {
    if (outcome->change.is_remeshed(cells.first) || outcome->change.is_remeshed(cells.second)) continue;
    if (!cells.first.valid() || !cells.second.valid()) continue;
    EXPECT_NEAR(tension, was.at(cells), 1e-9);
    ++same;
  }
  EXPECT_GT(same, 20);
}

// A wall that has turned grows by its new direction.
TEST(ExchangeOfCells, LeavesAWallThatGrowsAsItLies) {
  Model model = foam(tissue_from_prisms(honeycomb(5, 5, 3.5, 10), PolygonSplit::diagonals, 1), 0.2);
  State state = rest_state(model);
  std::vector<WallTurn> turns = possible_turns(model.tissue.sheet);
  const WallTurn turned = turns.front();
  turns = {turned};
  const Vectors before = state.positions;
  const TissueChange change =
      turn_walls(model.tissue, turns, 3.5, state.positions, [](CellId) { return Mat3(Mat3::Identity()); });
  ASSERT_EQ(turns.size(), 1u);
  follow_change(model, state, change, before);
  std::vector<GrowthTensor> tensors(model.tissue.cells.size());
  for (GrowthTensor& tensor : tensors) tensor = {Vec3(1.5, 1, 1).asDiagonal(), 1.5};
  const auto& law = dynamic_cast<const Cortex&>(*model.laws[2]);
  const std::unique_ptr<Law> later = law.grown(model.tissue, {}, tensors);
  const std::vector<double> was = law.past(), is = later->past();
  int checked = 0;
  for (std::size_t f = 0; f < law.faces().size(); ++f) {
    const Face& face = law.faces()[f];
    if (!change.is_remeshed(face.cell) || !face.beyond || !change.is_remeshed(*face.beyond)) continue;
    const Vec3 normal = facet_area_vector(gather(state.positions, face.nodes)).normalized();
    EXPECT_NEAR(is[f] / was[f], std::hypot(normal.x(), 1.5 * normal.y()), 1e-9);
    ++checked;
  }
  EXPECT_GE(checked, 5);
}

// After some exchanges, nodes of a face may lie on one line of the reference state, where it has no area then.
TEST(ExchangeOfCells, LeavesReferenceAreasThatDaughtersShare) {
  Model model = foam(tissue_from_prisms(honeycomb(5, 5, 3.5, 10), PolygonSplit::diagonals, 1));
  State state = rest_state(model);
  std::vector<WallTurn> turns = {possible_turns(model.tissue.sheet).front()};
  const WallTurn turned = turns.front();
  const Vectors before = state.positions;
  const TissueChange change =
      turn_walls(model.tissue, turns, 3.5, state.positions, [](CellId) { return Mat3(Mat3::Identity()); });
  ASSERT_EQ(turns.size(), 1u);
  follow_change(model, state, change, before);
  for (const NodeId corner : model.tissue.cells[turned.behind.index()].corners)
    model.tissue.rest_positions[corner.index()].y() = 0;
  model.tissue.place_hanging_positions(model.tissue.rest_positions);
  const auto areas_of = [](const Model& of, const Law& law, std::span<const CellId> origin) {
    const auto& cortex = dynamic_cast<const Cortex&>(law);
    const std::vector<double> past = cortex.past();
    std::vector<double> sums(of.tissue.cells.size(), 0.0);
    for (std::size_t f = 0; f < cortex.faces().size(); ++f) {
      EXPECT_GT(past[f], 0);
      sums[origin[cortex.faces()[f].cell.index()].index()] += past[f];
    }
    return sums;
  };
  const std::vector<double> was = areas_of(model, *model.laws[3], no_change(model.tissue).origin);
  Model after(model);
  const TissueChange division =
      divide_cells(after, state, std::vector<PlannedDivision>{{.cut = {turned.left, 0, 2}, .volume_ratio = 0.5}});
  const std::vector<double> is = areas_of(after, *after.laws[3], division.origin);
  for (std::size_t c = 0; c < was.size(); ++c) EXPECT_NEAR(is[c], was[c], 1e-9) << c;
  // The law of a resumed run has them, too.
  const std::vector<double> past = after.laws[3]->past();
  const auto again = model.laws[3]->restored(after.tissue, division, after.tissue.rest_positions, past);
  EXPECT_EQ(again->past(), past);
}

TEST(ExchangeOfCells, IsLeftUndoneWhereForcesWouldCloseTheNewFace) {
  Model model = foam(uneven_sheet());
  State state = rest_state(model);
  std::vector<WallTurn> turns = possible_turns(model.tissue.sheet);
  // A long face: the new one would be drawn together at once.
  std::ranges::sort(turns, std::greater(),
                    [&](const WallTurn& turn) { return wall_length(model.tissue, turn, state.positions); });
  turns.resize(1);
  const std::uint64_t revision = model.revision;
  EXPECT_FALSE(exchange_neighbours(model, state, turns, 4));
  EXPECT_EQ(model.revision, revision);
  EXPECT_EQ(state.positions, model.tissue.rest_positions);
}

// Contact, of which there is none here, may join distant cells: the whole sheet is changed to judge then.
TEST(ExchangeOfCells, IsJudgedByCellsAboutTheWallAsByTheWholeSheet) {
  Model part = foam(uneven_sheet(), 0.2);
  part.laws.push_back(
      std::make_unique<Foundation>(part.tissue, every_cell(part.tissue), FoundationRule{.stiffness = 0.02}));
  State of_part = flowed_state(part);
  Model whole(part);
  State of_whole = of_part;
  whole.laws.push_back(std::make_unique<SelfContact>(whole.tissue, SelfContactRule{.distance = 0.01, .search = 0.02}));
  of_whole.internals.push_back(whole.laws.back()->first_internal(whole.tissue));
  const auto expect_same = [&](const auto& change) {
    const std::optional<ExchangeOutcome> one = change(part, of_part), other = change(whole, of_whole);
    ASSERT_TRUE(one && other);
    EXPECT_NEAR(one->energy, other->energy, 1e-9 * std::abs(other->energy));
    EXPECT_EQ(of_part.positions, of_whole.positions);
  };
  Model of_one(part);
  State then = of_part;
  const auto chosen = shortest_turned(of_one, then);
  ASSERT_TRUE(chosen);
  expect_same([&](Model& model, State& state) { return exchange_neighbours(model, state, chosen->turns, 0.5); });
  for (const std::size_t place : {std::size_t{0}, std::size_t{20}})
    expect_same([&](Model& model, State& state) {
      return part_neighbours(model, state, {possible_turns(model.tissue.sheet)[place]}, 2);
    });
}

// A judgement costs a change of the cells about the walls.
TEST(ExchangeOfCells, IsNotTriedAgainAtOnce) {
  Model model = foam(uneven_sheet());
  State state = rest_state(model);
  for (std::size_t n = 0; n < state.positions.size(); ++n) state.velocities[n] = -0.01 * state.positions[n];
  const ExchangeRule rule{"all", 100, 4, 5};
  std::set<std::pair<NodeId, NodeId>> tried;
  const auto columns = [&](const WallTurn& turn) {
    return std::minmax(column(model.tissue.sheet, turn.begin).front(), column(model.tissue.sheet, turn.end).front());
  };
  int rounds = 0;
  for (std::vector<WallTurn> due; !(due = due_exchanges(model, state, rule)).empty(); ++rounds) {
    for (const WallTurn& turn : due) EXPECT_TRUE(tried.insert(columns(turn)).second);
    make_exchanges(model, state, rule);
  }
  EXPECT_GT(rounds, 2);
  EXPECT_LT(state.exchanges.count, static_cast<int>(tried.size()));
  state.time_s = 6;
  make_exchanges(model, state, rule);
  EXPECT_LT(state.exchanges.recent.size(), tried.size());
}

RunControls controls_until(double end_s, double below_um) {
  RunControls controls;
  controls.end_s = end_s;
  controls.max_step_s = 10;
  controls.stop_at_equilibrium = false;
  controls.frame_every_s = 0;
  controls.scheme.order = TimeOrder::first;
  controls.exchange = ExchangeRule{"all", below_um, 1.7 * below_um, 5};
  return controls;
}

// Looks at every event and at every step.
struct Watch final : SimulationListener {
  explicit Watch(const Simulation& of) : run(of) {}
  void step_accepted(const AcceptedStep& step, const Observation& /*measures*/) override {
    const Model& model = run.model();
    volume = std::max(volume, max_volume_error(model, step.state.positions));
    for (const auto& element : model.tissue.elements)
      least = std::min(least, hex_scaled_jacobian(gather(step.state.positions, element)));
  }
  void cells_divided(const TissueChange& change) override {
    ++batches;
    const double energy = run.state().exchanges.energy;
    highest = std::max(highest, energy - last);
    last = energy;
    EXPECT_GE(std::ranges::count(change.remeshed, true), 3);
    Tissue again = run.model().tissue;
    again.sheet.connect();
    EXPECT_EQ(wall_neighbours(again), wall_neighbours(run.model().tissue));
    EXPECT_NEAR(volume_of_cells(again, run.state().positions) / volume_inside_boundary(again, run.state().positions), 1,
                1e-12);
  }
  const Simulation& run;
  int batches = 0;
  double volume = 0, least = 1, last = 0, highest = -std::numeric_limits<double>::infinity();
};

// A foam that only relaxes: energy falls at each exchange, to first order in the volumes that it disturbs.
TEST(ExchangeOfCells, LosesEnergyInASheetThatRelaxes) {
  int events = 0;
  for (const auto& [seed, size] : {std::pair(1u, 0.2), {2u, 0.2}, {1u, 0.3}, {2u, 0.3}}) {
    Simulation simulation({std::make_unique<Model>(foam(uneven_sheet(seed, size))), controls_until(300, 1.6)});
    Watch watch(simulation);
    simulation.listen(watch);
    EXPECT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
    simulation.stop_listening(watch);
    events += simulation.state().exchanges.count;
    EXPECT_TRUE(watch.batches == 0 || watch.highest < 0);
    EXPECT_LE(watch.volume, 1e-9);
    EXPECT_GT(watch.least, 0);
    std::cout << simulation.state().exchanges.count << " exchanges in " << simulation.steps() << " steps, "
              << simulation.state().exchanges.energy << " nN um in all, " << watch.highest
              << " at most; worst scaled Jacobian " << watch.least << "\n";
  }
  EXPECT_GE(events, 4);
}

// A cell that walls have been turned away from leaves; state and laws continue without it.
// Move a column of the sheet so that a corner of an element is almost straight, as cells that flow do; the cell, if it
// can be split in a better way.
CellId straighten_a_corner(const Model& model, State& state) {
  const Tissue& tissue = model.tissue;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c)
    for (int i = 0; i < 4; ++i) {
      const Vectors before = state.positions;
      const auto& nodes = tissue.elements[tissue.cells[c].first_element.index()];
      for (const int level : {0, 4}) {
        Vec3& x = state.positions[nodes[level + i].index()];
        const Vec3 from = state.positions[nodes[level + (i + 3) % 4].index()],
                   to = state.positions[nodes[level + (i + 1) % 4].index()];
        x = 0.5 * (from + to) + 0.01 * (x - 0.5 * (from + to));
      }
      tissue.place_hanging(state.positions);
      if (cells_to_split(model, state, every_cell(tissue)) == std::vector{CellId(c)}) return CellId(c);
      state.positions = before;
    }
  return {};
}

TEST(CellsSplitAgain, GetBetterElementsAndKeepWhatTheyAre) {
  Model model = foam(uneven_sheet());
  State state = flowed_state(model);
  EXPECT_TRUE(cells_to_split(model, state, every_cell(model.tissue)).empty());
  const CellId cell = straighten_a_corner(model, state);
  ASSERT_TRUE(cell.valid());
  EXPECT_TRUE(cells_to_split(model, state, CellSet(model.tissue.cells.size(), false)).empty());
  const Model before(model);
  const State then = state;
  const SplitOutcome outcome = split_cells(model, state, {cell});
  EXPECT_GE(min_scaled_jacobian(model.tissue, state.positions), 2 * min_scaled_jacobian(before.tissue, then.positions));
  EXPECT_TRUE(cells_to_split(model, state, every_cell(model.tissue)).empty());
  EXPECT_EQ(state.positions, then.positions);
  EXPECT_EQ(state.velocities, then.velocities);
  EXPECT_EQ(state.multipliers, then.multipliers);
  EXPECT_LE((stretch_of(before, then, cell) - stretch_of(model, state, cell)).norm(), 1e-9);
  EXPECT_NEAR(rest_volume(model.tissue, model.tissue.cells[cell.index()]),
              rest_volume(before.tissue, before.tissue.cells[cell.index()]), 1e-9);
  for (std::size_t c = 0; c < model.tissue.cells.size(); ++c)
    EXPECT_EQ(outcome.change.is_remeshed(CellId(c)), CellId(c) == cell);
}

TEST(ExtrusionOfCells, LeavesItsPlaceToItsNeighbours) {
  Model model = foam(tissue_from_prisms(honeycomb(7, 7, 3.5, 10), PolygonSplit::diagonals, 1), 0.2);
  State state = rest_state(model);
  constexpr std::size_t cell = 24;
  for (int turn = 0; turn < 3; ++turn) {
    std::vector<WallTurn> turns = possible_turns(model.tissue.sheet);
    std::erase_if(turns, [&](const WallTurn& one) { return one.left != CellId(cell) && one.right != CellId(cell); });
    ASSERT_FALSE(turns.empty());
    turns.resize(1);
    const Vectors before = state.positions;
    const TissueChange change =
        turn_walls(model.tissue, turns, 1, state.positions, [](CellId) { return Mat3(Mat3::Identity()); });
    ASSERT_EQ(turns.size(), 1u);
    state.velocities = with_new_nodes(model.tissue, change, state.velocities);
    follow_change(model, state, change, before);
  }
  ASSERT_EQ(model.tissue.cells[cell].sides(), 3u);
  state.multipliers[cell + 1] = 0.125;
  state.velocities[10] = Vec3(1, 2, 3);
  const double volume = model.volumes.volumes(state.positions)[cell];
  const Model before(model);
  const auto outcome = extrude_cells(model, state, {CellId(cell)});
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->count, 1);
  EXPECT_NEAR(outcome->volume_um3, volume, 1e-12);
  EXPECT_EQ(model.tissue.cells.size(), 48u);
  EXPECT_EQ(state.multipliers.size(), 48u);
  EXPECT_EQ(state.multipliers[cell], 0.125);
  EXPECT_EQ(state.positions.size(), model.tissue.node_count());
  EXPECT_EQ(model.held.size(), model.tissue.node_count());
  const auto place = std::ranges::find(outcome->change.node_origin, NodeId(10)) - outcome->change.node_origin.begin();
  EXPECT_EQ(state.velocities[static_cast<std::size_t>(place)], Vec3(1, 2, 3));
  EXPECT_EQ(model.volumes.targets()[0], before.volumes.targets()[0]);
  // The elastic tension of faces far from it is as it was.
  const auto& law = dynamic_cast<const Cortex&>(*model.laws[2]);
  Step step = motionless(state, state.velocities);
  step.internal = state.internals[2];
  for (const double tension : law.tensions(step)) EXPECT_TRUE(std::isfinite(tension));
}

// Parts a cell from so many neighbours, none of which is `kept`.
void part(CellId cell, std::size_t count, std::optional<CellId> kept, Model& model, State& state) {
  for (std::size_t parted = 0; parted < count; ++parted) {
    std::vector<WallTurn> turns = possible_turns(model.tissue.sheet);
    std::erase_if(turns, [&](const WallTurn& one) {
      const CellId other = one.left == cell ? one.right : one.left;
      return (one.left != cell && one.right != cell) || other == kept;
    });
    ASSERT_FALSE(turns.empty());
    ASSERT_TRUE(part_neighbours(model, state, {turns.front()}, 1));
  }
}

// Rest and target volumes of cells at the end of all growth, by their ids.
std::map<int, std::pair<double, double>> final_volumes(const Model& model) {
  const std::optional<Model> later = grown(model, model, {}, 100);
  const Model& at_end = later ? *later : model;
  std::map<int, std::pair<double, double>> volumes;
  for (std::size_t c = 0; c < at_end.tissue.cells.size(); ++c) {
    const Cell& cell = at_end.tissue.cells[c];
    volumes[cell.lineage.id] = {rest_volume(at_end.tissue, cell), at_end.volumes.targets()[c]};
  }
  return volumes;
}

// Daughters that grow lose neighbours, by exchange and by extrusion: they become as large as they would have.
TEST(ExchangeOfCells, LeavesDaughtersTheirFinalSize) {
  constexpr CellId mother(24), neighbour(25);
  std::map<int, Vec3> final_corner;
  for (const Mat3& turn : {Mat3(Mat3::Identity()), Mat3(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()))}) {
    Model model = foam(tissue_from_prisms(honeycomb(7, 7, 3.5, 10), PolygonSplit::diagonals, 1));
    const Model initial(model);
    State state = rest_state(model);
    for (Vec3& x : state.positions) x = turn * x;
    const std::vector<PlannedDivision> cut = {{.cut = {mother, 0, 3}, .growth_s = 10, .volume_ratio = 1}};
    std::vector<CellId> origin = divide_cells(model, state, cut).origin;
    const auto expected = final_volumes(model);
    state.time_s = 4;
    part(mother, 1, neighbour, model, state);
    state.time_s = 6;
    part(neighbour, model.tissue.cells[neighbour.index()].sides() - 3, mother, model, state);
    state.time_s = 8;
    const auto outcome = extrude_cells(model, state, {neighbour});
    ASSERT_TRUE(outcome);
    int grow = 0;
    for (const Growth& growth : model.growths) {
      const int id = model.tissue.cells[growth.cell.index()].lineage.id;
      const auto [corner, is_first] = final_corner.emplace(id, growth.rest_to.front());
      EXPECT_LE((growth.rest_to.front() - turn * corner->second).norm(), 1e-9);
      grow += growth.start_s == 8 ? 1 : 0;
    }
    EXPECT_GE(grow, 1);
    for (const auto& [id, volumes] : final_volumes(model)) {
      EXPECT_NEAR(volumes.first / expected.at(id).first, 1, 1e-9) << id;
      EXPECT_NEAR(volumes.second / expected.at(id).second, 1, 1e-9) << id;
    }
    const ModelMemory memory = memory_of(model, inherited(outcome->change, origin));
    EXPECT_EQ(final_volumes(restored(initial, memory, model.tissue.node_count())), final_volumes(model));
  }
}

// A homogeneous stretch is all by shape, and the sum of both parts is that of the tissue.
TEST(Neighbours, ShearByShapeIsThatOfAHomogeneousStretch) {
  const Tissue tissue = tissue_from_prisms(honeycomb(6, 6, 4, 10), PolygonSplit::diagonals, 1);
  const CellSet& all = tissue.regions.at("all");
  const double before = shape_shear(tissue, all, tissue.rest_positions);
  EXPECT_NEAR(before, 0, 1e-12);
  Vectors positions = tissue.rest_positions;
  double sum = 0;
  constexpr int steps = 200;
  for (int step = 0; step < steps; ++step) {
    Vectors next = positions;
    for (Vec3& x : next) x = Vec3(x.x() * std::exp(0.3 / steps), x.y() * std::exp(-0.2 / steps), x.z());
    sum += shear_between(tissue, all, positions, next);
    positions = next;
  }
  EXPECT_NEAR(sum, 0.25, 1e-6);
  EXPECT_NEAR(shape_shear(tissue, all, positions), 0.25, 1e-9);
}

// Cells on the right are stretched, those on the left are not, and each set of cells has its own shear.
TEST(Neighbours, ShearIsThatOfTheChosenCells) {
  const Tissue tissue = tissue_from_prisms(honeycomb(8, 6, 4, 10), PolygonSplit::diagonals, 1);
  Vectors after = tissue.rest_positions;
  double middle = 0;
  for (const Vec3& x : after) middle += x.x() / static_cast<double>(after.size());
  for (Vec3& x : after) x.x() += 0.02 * std::max(0.0, x.x() - middle);
  CellSet left, right;
  for (const Cell& cell : tissue.cells) {
    const auto [low, high] =
        std::ranges::minmax(cell.corners, {}, [&](NodeId node) { return tissue.rest_positions[node.index()].x(); });
    left.push_back(tissue.rest_positions[high.index()].x() < middle);
    right.push_back(tissue.rest_positions[low.index()].x() > middle);
  }
  EXPECT_NEAR(shear_between(tissue, left, tissue.rest_positions, after), 0, 1e-12);
  EXPECT_NEAR(shear_between(tissue, right, tissue.rest_positions, after), 0.5 * 0.02 / 1.01, 1e-12);
  EXPECT_NEAR(shape_shear(tissue, left, after), 0, 1e-12);
  EXPECT_NEAR(shape_shear(tissue, right, after), 0.5 * std::log(1.02), 1e-9);
}

}  // namespace
