// A side of a symmetric tissue is the whole, and a period is the endless tissue.
#include "simulation/full_model.hpp"

#include <set>
#include <tuple>

#include "core/threads.hpp"
#include "measure/self_intersections.hpp"
#include "mechanics/active/cortex.hpp"
#include "mechanics/contact/self_contact.hpp"
#include "support/models.hpp"
#include "support/ran.hpp"
#include "support/resumed.hpp"
#include "support/scenarios.hpp"
#include "tissue/shapes/polygon_sheet.hpp"

namespace {

// A belly that is drawn in, with every law that a mirror goes with.
const std::string furrow = small_furrow + R"([contraction.net]
region = "belly"
stiffness_nN_per_um = 0.01
diagonals = true
damping_nN_s_per_um = 0.1
delay = { speed_um_per_s = 5 }
[cortex.all-walls]
region = "all"
faces = "lateral"
tension_mN_per_m = 0.01
stiffness_mN_per_m = 0.02
relaxation_min = 6
crowding_mN_per_m = 0.001
follow = { measure = "height_ratio", from = 0.9, to = 1.1 }
[pressure.belly]
region = "belly"
pressure_Pa = 3
)";

Scenario second_order(const std::string& text, std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(), "time.integrator=bdf2");
  return load_scenario({"furrow", "furrow.toml", text}, overrides);
}

const std::string compliant = "enclosed.yolk.bulk_modulus_Pa=50000";
const std::vector<std::string> planes = {"embryo.mirror=[\"y\"]", "embryo.mirror=[\"x\",\"y\"]"};

// How a quantity of a whole must be twice, or four times, that of a side.
void expect_times(double times, double of_side, double of_whole, const std::string& what) {
  EXPECT_NEAR(of_whole, times * of_side, 1e-9 * std::abs(of_whole) + 1e-12) << what;
}

// Forces on nodes of the whole are those on the side: on a plane its own share, without what is held there.
void expect_same_forces(const Mirror& mirror, const Tissue& side, const Vectors& of_side, const Vectors& of_whole,
                        const std::string& what) {
  const double size = largest(of_whole);
  double apart = 0;
  for (std::size_t n = 0; n < of_whole.size(); ++n) {
    const auto [node, signs] = mirror.nodes[n];
    Vec3 force = signs.cwiseProduct(of_side[node.index()]) / side.side_share({&node, 1});
    for (int axis = 0; axis < 3; ++axis)
      if (side.is_mirrored[axis] && side.rest_positions[node.index()][axis] == 0) force[axis] = 0;
    apart = std::max(apart, (force - of_whole[n]).norm());
  }
  EXPECT_LE(apart, 1e-9 * size + 1e-13) << what;
}

TEST(FullModel, EachLawOfASideIsThatOfAHalfOrAQuarter) {
  const std::string slice = "base = \"furrow-slice\"";
  const std::string on_foundations = furrow + R"([foundation.outside]
region = "belly"
faces = "apical"
stiffness_nN_per_um3 = 0.01
drag_Pa_s_per_um = 3
resists = "normal"
[foundation.inside]
region = "all"
stiffness_nN_per_um3 = 0.01
resists = "one-sided"
[matrix.base]
region = "all"
young_modulus_Pa = 20000
thickness_um = 0.2
relaxation_s = 1
)";
  std::set<std::string> laws;
  for (const auto& [text, overrides] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {furrow, {planes[0], "enclosed.yolk.volume=compliant", compliant}},
           {on_foundations, {planes[1], "enclosed.yolk.volume=held"}},
           {furrow,
            {planes[1], "embryo.elements_per_cell=[2,1,2]", "dynamics.density_kg_per_m3=1000",
             "time.integrator=backward-euler", "elasticity.model=shape-memory"}},
           {slice, {planes[0]}}}) {
    const Scenario scenario = second_order(text, overrides);
    const auto whole = make_model(scenario);
    const auto solved = make_solved_side(scenario, *whole);
    ASSERT_TRUE(solved);
    const auto& [side, mirror] = *solved;
    const double times = scenario.embryo.mirror.size() == 2 ? 4 : 2;
    ASSERT_EQ(side->laws.size(), whole->laws.size());

    // Two steps of random motion, so that laws remember something.
    Random random(7);
    const auto moved = [&](const Vectors& from, double size) {
      Vectors positions = from;
      for (std::size_t n = 0; n < positions.size(); ++n)
        for (int axis = 0; axis < 3; ++axis)
          if (const double way = random.number(size); !side->held[n][axis]) positions[n][axis] += way;
      return positions;
    };
    const Vectors x0 = moved(side->tissue.rest_positions, 0.5), x1 = moved(x0, 1), x2 = moved(x1, 1);
    const Vectors w0 = mirror.full_vectors(x0), w1 = mirror.full_vectors(x1), w2 = mirror.full_vectors(x2);
    const Vectors still(x0.size(), Vec3::Zero()), whole_still(w0.size(), Vec3::Zero());
    std::vector<std::vector<double>> internals, whole_internals;
    for (const auto& law : side->laws) internals.push_back(law->first_internal(side->tissue));
    for (const auto& law : whole->laws) whole_internals.push_back(law->first_internal(whole->tissue));
    Step step{x1, x0, still, 0.7, 30}, whole_step{w1, w0, whole_still, 0.7, 30};
    step.internals = internals, whole_step.internals = whole_internals;
    const auto next = next_internals(*side, step), whole_next = next_internals(*whole, whole_step);
    step = {x2, x1, still, 0.7, 31}, whole_step = {w2, w1, whole_still, 0.7, 31};

    for (std::size_t l = 0; l < side->laws.size(); ++l) {
      const std::string name(side->laws[l]->name());
      SCOPED_TRACE(name);
      laws.insert(name);
      step.internal = next[l], whole_step.internal = whole_next[l];
      expect_times(times, side->laws[l]->energy(step), whole->laws[l]->energy(whole_step), "energy");
      expect_same_forces(mirror, side->tissue, forces_of(*side->laws[l], step), forces_of(*whole->laws[l], whole_step),
                         "forces");
      const Vectors direction = moved(still, 1), whole_direction = mirror.full_vectors(direction);
      Vectors product = still, whole_product = whole_still;
      side->laws[l]->add_tangent_product(step, direction, product);
      whole->laws[l]->add_tangent_product(whole_step, whole_direction, whole_product);
      expect_same_forces(mirror, side->tissue, product, whole_product, "products");
    }
    for (std::size_t k = 0; k < side->constraints.size(); ++k) {
      double volume = 0, whole_volume = 0;
      side->constraints[k]->values(x2, {&volume, 1});
      whole->constraints[k]->values(w2, {&whole_volume, 1});
      expect_times(times, volume, whole_volume, "volume");
      expect_times(times, side->constraints[k]->targets()[0], whole->constraints[k]->targets()[0], "its target");
      Vectors forces = still, whole_forces = whole_still;
      side->constraints[k]->add_forces(x2, std::array{0.3}, forces);
      whole->constraints[k]->add_forces(w2, std::array{0.3}, whole_forces);
      expect_same_forces(mirror, side->tissue, forces, whole_forces, "forces of a volume");
    }
  }
  EXPECT_EQ(laws, (std::set<std::string>{"contraction", "corner barrier", "cortex", "dilatation", "drag", "elasticity",
                                         "enclosed volume", "foundation", "inertia", "matrix", "pressure",
                                         "self-contact", "shape memory", "ties"}));
}

// Of two runs to the same time, the columns that say where they are.
void expect_same_end(const Simulation& a, const Simulation& b, double length_um) {
  const Observation one = a.measures(), other = b.measures();
  const std::pair<double, std::vector<const char*>> tolerances[] = {
      {length_um,
       {"furrow_depth_um", "furrow_depth_below_lips_um", "vml_height_um", "vml_displacement_um",
        "vce_displacement_um"}},
      {2 * length_um, {"lip_distance_um"}},
      {0.002, {"vml_apical_area_ratio", "min_apical_area_ratio"}},
      {0.01, {"min_corner_jacobian_ratio"}},
      {1e-6, {"enclosed_volume_ratio"}},
      {0.1, {"yolk_pressure_Pa"}},
      {0.02, {"closed_length_ratio"}},
      {0.0005, {"flank_volume_ratio"}},
      {0, {"cells", "lips_closed"}}};
  for (const auto& [tolerance, columns] : tolerances)
    for (const char* column : columns) {
      SCOPED_TRACE(column);
      ASSERT_EQ(one[column].has_value(), other[column].has_value());
      EXPECT_NEAR(one[column].value_or(0), other[column].value_or(0), tolerance);
    }
  EXPECT_LE(*other["max_volume_error"], 1e-9);
  EXPECT_EQ(*other["self_intersections"], 0);
}

// When lips are closed for the first time; and where the run ends.
double closes_at_s(Simulation& simulation) {
  double closed_s = 0;
  while (simulation.step())
    if (closed_s == 0 && simulation.measures()["lips_closed"].value_or(0) > 0) closed_s = simulation.time_s();
  EXPECT_EQ(simulation.status(), RunStatus::end_time) << simulation.failure();
  return closed_s;
}

const std::vector<std::string> fine_steps = {"time.tolerance_um=0.01", "output.cells_csv=false"};

std::vector<std::string> with(std::vector<std::string> overrides, const std::string& one) {
  overrides.push_back(one);
  return overrides;
}

// Until lips have met. From then on corners that press on corners slip aside, by 0.3 um at 20 min, which beside a plane
// they cannot (docs/theory/mirror.md).
TEST(FullModel, AFurrowClosesAsItDoesWithoutPlanes) {
  const std::vector<std::string> upright = with(fine_steps, "time.end_min=15");
  Simulation plain(load_scenario(find_scenario("furrow-slice"), upright));
  Simulation mirrored(load_scenario(find_scenario("furrow-slice"), with(upright, planes[0])));
  const double plain_s = closes_at_s(plain), mirrored_s = closes_at_s(mirrored);
  EXPECT_NEAR(plain_s, mirrored_s, 10);
  EXPECT_GT(mirrored_s, 800);
  expect_same_end(plain, mirrored, 0.01);
  EXPECT_EQ(mirrored.state().positions.size(), plain.state().positions.size());
  EXPECT_EQ(2 * mirrored.memory().state.multipliers.size(), plain.state().multipliers.size());

  EXPECT_EQ(*mirrored.measures()["contact_pairs"], *plain.measures()["contact_pairs"]);
}

// Where pairs are apart: those that overlap depend on what was known of them. And where they are not aslant: sections
// of a slice are alike, so a place on one side of a section is as near as that on the other, and rounding decides.
TEST(FullModel, PairsOfASideAndTheirImagesAreThoseOfTheWhole) {
  using Found = std::tuple<bool, std::set<std::size_t>, double, double>;
  for (const std::string& plane : planes) {
    SCOPED_TRACE(plane);
    Simulation mirrored(
        load_scenario(find_scenario("furrow-slice"), {"embryo.cells=[2,20,20]", "time.end_min=15", plane}));
    ASSERT_EQ(mirrored.run(), RunStatus::end_time) << mirrored.failure();
    const auto law = std::ranges::find_if(mirrored.model().laws, [](const auto& one) { return one->self_contact(); });
    const auto l = static_cast<std::size_t>(law - mirrored.model().laws.begin());
    const auto apart = [](std::span<const ContactPair> pairs) {
      std::vector<Found> found;
      for (const ContactPair& pair : pairs) {
        if (pair.first_gap < 0.1 || std::abs(pair.normal.x()) > 0.1) continue;
        std::set<std::size_t> nodes;
        for (const NodeId node : pair.p.all_nodes()) nodes.insert(node.index());
        found.emplace_back(pair.is_of_edges(), nodes, pair.first_gap, pair.area);
      }
      std::ranges::sort(found);
      return found;
    };
    const std::vector<Found> implied = apart(SelfContact::pairs_of(mirrored.state().internals[l])),
                             searched = apart((*law)->self_contact()->pairs(mirrored.state().positions));
    ASSERT_EQ(implied.size(), searched.size());
    EXPECT_GT(implied.size(), 100U);
    for (std::size_t i = 0; i < implied.size(); ++i) {
      EXPECT_EQ(std::get<1>(implied[i]), std::get<1>(searched[i]));
      EXPECT_NEAR(std::get<2>(implied[i]), std::get<2>(searched[i]), 1e-9);
      EXPECT_NEAR(std::get<3>(implied[i]), std::get<3>(searched[i]), 1e-9);
    }
  }
}

TEST(FullModel, AFurrowBetweenTwoPlanesIsThatOfTheWhole) {
  const std::vector<std::string> fine = {"time.tolerance_um=0.01", "enclosed.yolk.volume=compliant", compliant};
  Simulation plain(second_order(furrow, fine));
  ASSERT_EQ(plain.run(), RunStatus::end_time) << plain.failure();
  for (const std::string& plane : planes) {
    SCOPED_TRACE(plane);
    Simulation mirrored(second_order(furrow, with(fine, plane)));
    ASSERT_EQ(mirrored.run(), RunStatus::end_time) << mirrored.failure();
    expect_same_end(plain, mirrored, 0.02);
    EXPECT_LT(largest_distance(plain.state().positions, mirrored.state().positions), 0.05);
    const std::vector<double>&forces = mirrored.state().obstacle_forces, &plain_forces = plain.state().obstacle_forces;
    double sum = 0, plain_sum = 0;
    for (std::size_t k = 0; k < forces.size(); ++k) sum += forces[k], plain_sum += plain_forces[k];
    EXPECT_NEAR(sum, plain_sum, 0.01 * plain_sum);
  }
}

// Without contact the lips pass through the plane, and so through each other.
TEST(FullModel, ACrossingOfThePlaneIsSeen) {
  Simulation simulation(load_scenario(find_scenario("furrow-slice"), {planes[0], "self_contact.surface=none"}));
  while (simulation.step() && *simulation.measures()["self_intersections"] == 0) continue;
  EXPECT_GT(*simulation.measures()["self_intersections"], 0);
  EXPECT_GT(self_intersections(simulation.model().tissue, simulation.state().positions), 0);
}

TEST(FullModel, GoesOnToTheSameBitsOnAnyNumberOfThreads) {
  const Scenario scenario = second_order(furrow, {planes[1], "enclosed.yolk.volume=compliant", compliant});
  std::optional<RunMemory> kept;
  std::optional<Simulation> fork;
  const auto run = [&](int threads) {
    const ThreadCount so_many(threads);
    Simulation simulation(scenario);
    while (simulation.step())
      if (simulation.steps() == 9) {
        kept = simulation.memory();
        fork.emplace(simulation);
      }
    return simulation;
  };
  const Simulation whole = run(1);
  const Simulation on_three = run(3);
  EXPECT_EQ(whole.state().positions, on_three.state().positions);
  EXPECT_EQ(whole.state().internals, on_three.state().internals);
  ASSERT_TRUE(kept);

  Simulation resumed(scenario);
  go_on_by_bytes(resumed, *kept);
  for (Simulation* rest : {&resumed, &*fork}) {
    EXPECT_EQ(rest->run(), whole.status());
    EXPECT_EQ(rest->steps(), whole.steps());
    expect_same(rest->state(), whole.state());
    EXPECT_EQ(rest->measures().values, whole.measures().values);
  }

  RunMemory of_another = *kept;
  of_another.whole_internals.clear();
  EXPECT_THROW(Simulation(scenario).go_on_from(of_another), UnfitMemory);
}

constexpr double length = 40, width = 60;
const SheetShape sheet{length, width, {0, 0}, {true, true}};
const Rectangle rectangle{{length, width}, {true, true}};

// How far each cell has moved when a stripe along x has contracted for a while.
Vectors moves(const SheetShape& shape, const Vectors& points, LinearMethod method = LinearMethod::automatic) {
  Model model(build_sheet(shape, points, {10, PolygonSplit::diagonals, 1}));
  const Tissue& tissue = model.tissue;
  CellSet stripe(points.size());
  for (std::size_t c = 0; c < points.size(); ++c) stripe[c] = std::abs(points[c].y()) < 8;
  add_elasticity(model);
  add_contraction(model, stripe, {.stiffness = 3, .across_ratio = 0.4});
  model.laws.push_back(std::make_unique<Cortex>(tissue, CellSet(points.size(), true),
                                                CortexRule{.side = CellSide::lateral, .tension = 0.3}));
  add_drag(model);
  RunControls controls{
      .scheme = {.linear_method = method}, .fixed_step_s = 2, .end_s = 20, .stop_at_equilibrium = false};
  const Simulation simulation = ran(std::move(model), controls);
  EXPECT_EQ(simulation.status(), RunStatus::end_time) << simulation.failure();
  Vectors result;
  const Tissue& after = simulation.model().tissue;
  for (const Cell& cell : after.cells)
    result.push_back(cell_centre(cell, simulation.state().positions) - cell_centre(cell, after.rest_positions));
  return result;
}

// The middle of a longer sheet is the same, when that is endless, too.
TEST(PeriodicRun, TwoPeriodsDoWhatOneDoes) {
  const Vectors points = even_points(rectangle, 70, 1);
  Vectors twice;
  for (const double shift : {-length / 2, length / 2})
    for (const Vec3& x : points) twice.push_back(x + shift * Vec3::UnitX());
  const Vectors one = moves(sheet, points), both = moves({2 * length, width, {0, 0}, {true, true}}, twice);
  for (const std::size_t first : {std::size_t{0}, points.size()}) {
    const double difference = largest_distance(one, std::span(both).subspan(first, points.size()));
    std::printf("%.1e um apart\n", difference);
    EXPECT_LT(difference, 1e-9);
  }
}

TEST(PeriodicRun, IsTheSameWithEveryLinearSolver) {
  const Vectors points = even_points(rectangle, 70, 1), expected = moves(sheet, points, LinearMethod::direct);
  for (const LinearMethod method : {LinearMethod::cholesky, LinearMethod::multigrid})
    EXPECT_LT(largest_distance(expected, moves(sheet, points, method)), 1e-6);
}

// With contact and second order in time; so many cells that threads share loops.
TEST(PeriodicRun, GoesOnToTheSameBitsOnAnyNumberOfThreads) {
  const Scenario scenario =
      load_scenario({"test", "test.toml", "format = 1\n" + sheet_table(60, 80, 10, 240) + R"(periodic = ["x"]
rim = "held"
[region.stripe]
y_um = [-7, 7]
[cortex.apical]
region = "stripe"
tension_mN_per_m = 1
[self_contact]
surface = "apical"
[time]
end_s = 8
integrator = "bdf2"
[stop]
at_equilibrium = false
)"});
  Simulation whole(scenario);
  for (int step = 0; step < 5; ++step) ASSERT_TRUE(whole.step()) << whole.failure();
  Simulation resumed(scenario), fork = whole;
  go_on_by_bytes(resumed, whole.memory());
  ASSERT_EQ(whole.run(), RunStatus::end_time) << whole.failure();
  ASSERT_EQ(resumed.run(), RunStatus::end_time) << resumed.failure();
  const ThreadCount two(2);
  ASSERT_EQ(fork.run(), RunStatus::end_time) << fork.failure();
  for (const Simulation* other : {&resumed, &fork}) expect_same(other->state(), whole.state());
  // Images have stayed where they belong, but for rounding.
  const Tissue& tissue = whole.model().tissue;
  Vectors placed = whole.state().positions;
  tissue.place_hanging_positions(placed);
  EXPECT_LT(largest_distance(placed, whole.state().positions), 1e-10);
}

}  // namespace
