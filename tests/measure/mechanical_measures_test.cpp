// Measures of whole tissues: motion, energy norm, static forces, error of bending, self-intersections.
#include "measure/bending_error.hpp"
#include "measure/cells.hpp"
#include "measure/energy_norm.hpp"
#include "measure/monitor.hpp"
#include "measure/self_intersections.hpp"
#include "mechanics/active/cortex.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "support/divided.hpp"
#include "support/elements.hpp"
#include "support/forces_of_cells.hpp"
#include "support/law_checks.hpp"

namespace {

TEST(WholeTissue, IsMeasuredByDisplacementHeightAndVolume) {
  const Model model(support::distorted_block({60, 40, 12, {3, 2, 1}, {1, 1, 2}}, 0, 1));
  Vectors positions = model.tissue.rest_positions;
  EXPECT_EQ(max_displacement(model.tissue, positions), 0);
  EXPECT_NEAR(mean_height(model.tissue, positions), 12, 1e-9);
  EXPECT_NEAR(tissue_volume(model, positions), 60 * 40 * 12, 1e-6);
  for (Vec3& position : positions) position = Vec3(position.x(), position.y(), 1.5 * position.z());
  positions[0] += Vec3(3, 4, 0);
  EXPECT_NEAR(tissue_volume(model, positions) / (60 * 40 * 12), 1.5, 0.2);
  const double farthest = largest_distance(positions, model.tissue.rest_positions);
  EXPECT_NEAR(max_displacement(model.tissue, positions), farthest, 1e-12);
}

TEST(EnergyNorm, IsThatOfTheStiffnessAtRest) {
  const Tissue tissue =
      distorted_block({.length_um = 40, .width_um = 20, .cell_height_um = 40, .cells = {2, 1, 1}}, 2, 3);
  const RestMesh mesh{tissue.elements, tissue.element_rest_shape, {}};
  Random random(5);
  const Vectors a = random.vectors(tissue.node_count()), b = random.vectors(tissue.node_count());
  const auto energy = [&](const Vectors& u, const ElasticModuli& moduli) {
    double sum = 0;
    for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
      Vec24 local;
      for (int i = 0; i < 8; ++i) local.segment<3>(3 * i) = u[tissue.elements[e][i].index()];
      sum += local.dot(incompatible_stiffness(tissue.element_rest_shape[e], moduli) * local);
    }
    return sum;
  };
  Vectors apart = a;
  for (std::size_t n = 0; n < apart.size(); ++n) apart[n] -= b[n];
  const ElasticModuli any_modulus = ElasticModuli::from_young(7, 0.3);
  const double expected = std::sqrt(energy(apart, any_modulus) / energy(b, any_modulus));
  EXPECT_NEAR(relative_energy_norm(mesh, 0.3, a, b).value(), expected, 1e-12 * expected);
  EXPECT_EQ(relative_energy_norm(mesh, 0.3, b, b), 0);
}

TEST(EnergyNorm, CountsChosenElementsOnlyAndNoWholeMotion) {
  const Tissue tissue = build_block({.length_um = 40, .width_um = 20, .cell_height_um = 40, .cells = {2, 1, 1}});
  RestMesh mesh{tissue.elements, tissue.element_rest_shape, {}};
  const Vectors shifted(tissue.node_count(), Vec3(30, -20, 10)), still(tissue.node_count(), Vec3::Zero());
  EXPECT_FALSE(relative_energy_norm(mesh, 0.45, still, shifted));
  EXPECT_FALSE(relative_energy_norm(mesh, 0.45, shifted, still));
  // Only the second cell is deformed.
  Vectors b = still;
  for (const NodeId node : tissue.elements[1])
    if (tissue.rest_positions[node.index()].x() > 0) b[node.index()].x() = 1;
  EXPECT_NEAR(relative_energy_norm(mesh, 0.45, still, b).value(), 1, 1e-12);
  mesh.chosen = {true, false};
  EXPECT_FALSE(relative_energy_norm(mesh, 0.45, still, b));
  mesh.chosen = {false, true};
  EXPECT_NEAR(relative_energy_norm(mesh, 0.45, still, b).value(), 1, 1e-12);
}

Model model_of(Tissue tissue, double relaxation_s) {
  Model model(std::move(tissue));
  const std::size_t elements = model.tissue.elements.size(), cells = model.tissue.cells.size();
  model.laws.push_back(
      std::make_unique<NeoHookean>(model.tissue, std::vector<NeoHookeanMaterial>(elements, {0.4, relaxation_s})));
  for (const CellSide side : {CellSide::apical, CellSide::lateral})
    model.laws.push_back(std::make_unique<Cortex>(
        model.tissue, CellSet(cells, true),
        CortexRule{
            .side = side, .tension = 0.3, .stiffness = 1, .compression_ratio = 0.5, .relaxation_s = relaxation_s}));
  return model;
}

State stretched(const Model& model, unsigned seed) {
  State state = rest_state(model);
  Random random(seed);
  for (Vec3& x : state.positions) x = Vec3(1.2 * x.x(), 0.9 * x.y(), 1.1 * x.z()) + random.vector(0.5);
  model.tissue.place_hanging(state.positions);
  return state;
}

void expect_equal(const Vectors& a, const Vectors& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) EXPECT_LE((a[n] - b[n]).norm(), tolerance * largest(b)) << n;
}

Tissue block() {
  return distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}}, 1, 3);
}

void divide_two(Model& model, State& state) {
  divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 0}, 0, 0.5}, {{CellId(4), 1}, 0, 0.5}});
}

// What relaxes within a second has not relaxed yet: its forces are those of what never does.
TEST(StaticForces, OfALawThatRelaxesFastAreThoseOfNow) {
  const Model flowing = model_of(block(), 1), lasting = model_of(block(), 0);
  const State state = stretched(flowing, 5), of_lasting = stretched(lasting, 5);
  for (std::size_t l = 0; l < flowing.laws.size(); ++l)
    expect_equal(forces_of_law(flowing, state, *flowing.laws[l]), forces_of_law(lasting, of_lasting, *lasting.laws[l]),
                 1e-8);
  expect_equal(driving_forces(flowing, state), driving_forces(lasting, of_lasting), 1e-8);
  CellSet some(6, false);
  some[0] = some[1] = some[4] = true;
  expect_equal(forces_of_cells(flowing, state, some), forces_of_cells(lasting, of_lasting, some), 1e-8);
}

// Laws that resist motion show nothing, however stiff.
TEST(StaticForces, OfDragAndViscosityAreNone) {
  Model model(block());
  add_drag(model, 100);
  model.laws.push_back(std::make_unique<Corotational>(
      model.tissue, std::vector<ElasticModuli>(model.tissue.elements.size(), ElasticModuli::from_young(0, 0.3)), 100));
  for (const Vec3& force : driving_forces(model, stretched(model, 7))) EXPECT_EQ(force.norm(), 0);
}

// Nothing is left on hanging nodes, and neither resultant nor torque changes.
TEST(StaticForces, AreOnFreeNodes) {
  Model model = model_of(block(), 1);
  State state = stretched(model, 9);
  divide_two(model, state);
  ASSERT_FALSE(model.tissue.hanging.empty());
  const Vectors no_velocity(state.positions.size(), Vec3::Zero());
  for (std::size_t l = 0; l < model.laws.size(); ++l) {
    const Law& law = *model.laws[l];
    const Vectors forces = forces_of_law(model, state, law);
    Vectors as_they_act(forces.size(), Vec3::Zero());
    Step step{state.positions, state.positions, no_velocity, 1e-9, state.time_s};
    step.internal = state.internals[l];
    law.add_forces(step, as_they_act);
    for (std::size_t n = model.tissue.free_node_count(); n < forces.size(); ++n) EXPECT_EQ(forces[n].norm(), 0);
    double size = 0;
    for (const Vec3& force : as_they_act) size += force.norm();
    EXPECT_LE((resultant(forces) - resultant(as_they_act)).norm(), 1e-12 * size) << law.name();
    EXPECT_LE((torque(forces, state.positions) - torque(as_they_act, state.positions)).norm(), 1e-10 * size)
        << law.name();
  }
}

// What two parts of a tissue exert adds up to what the whole does, walls between them included.
TEST(StaticForces, OfPartsAddUp) {
  Model model = model_of(block(), 20);
  State state = stretched(model, 11);
  divide_two(model, state);
  const std::size_t cells = model.tissue.cells.size();
  CellSet left(cells, false), right(cells, false);
  for (std::size_t c = 0; c < cells; ++c) (c % 3 == 0 ? left : right)[c] = true;
  Vectors sum = forces_of_cells(model, state, left);
  const Vectors of_right = forces_of_cells(model, state, right);
  for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += of_right[n];
  expect_equal(sum, forces_of_cells(model, state, CellSet(cells, true)), 1e-12);
  expect_equal(sum, driving_forces(model, state), 1e-12);
}

// A row of two cells whose top faces shrink and whose bottom faces widen by as much.
TEST(BendingError, GrowsWithTheDifferenceOfAreasAndFallsWithLayers) {
  for (const int layers : {1, 2, 4}) {
    Model model(build_block({.length_um = 20,
                             .width_um = 10,
                             .cell_height_um = 10,
                             .cells = {2, 1, 1},
                             .elements_per_cell = {1, 1, layers}}));
    EXPECT_FALSE(bending_error(model, model.tissue.rest_positions));  // no law
    model.laws.push_back(
        std::make_unique<Corotational>(model.tissue, in_elements(model.tissue, ElasticModuli::from_young(1, 0.45)), 0));
    EXPECT_FALSE(bending_error(model, model.tissue.rest_positions));
    Vectors x = model.tissue.rest_positions;
    for (Vec3& one : x) one.x() *= 1 - 0.02 * one.z();
    EXPECT_NEAR(bending_error(model, x).value(), 0.14 * 0.2 / layers, 1e-12);
    EXPECT_EQ(elements_through_height(model.tissue), layers);
    for (Vec3& one : x) one = 0.7 * one;  // all alike: no more bending than that of the areas
    EXPECT_NEAR(bending_error(model, x).value(), 0.14 * 0.2 * 0.49 / layers, 1e-12);
  }
}

/// Quadrilaterals without common nodes.
struct Quads {
  std::vector<Facet> facets;
  Vectors positions;

  void add(const std::array<Vec3, 4>& corners) {
    Facet facet{};
    for (int i = 0; i < 4; ++i) {
      facet.nodes[i] = NodeId(positions.size());
      positions.push_back(corners[i]);
    }
    facets.push_back(facet);
  }
  void add_square(const Vec3& middle, const Vec3& u, const Vec3& v) {
    add({middle - u - v, middle + u - v, middle + u + v, middle - u + v});
  }
  [[nodiscard]] std::size_t crossings() const { return crossing_facets(facets, positions).size(); }
};

double between(Random& random, double low, double high) { return low + (high - low) * 0.5 * (random.number() + 1); }

const Vec3 X = Vec3::UnitX(), Y = Vec3::UnitY(), Z = Vec3::UnitZ();

TEST(SelfIntersections, WhatPassesThroughIsCounted) {
  Quads quads;
  quads.add_square(Vec3::Zero(), X, Y);
  quads.add_square(Vec3(0.3, 0.2, 0.1), Y, Z);
  EXPECT_EQ(quads.crossings(), 1u);
  quads.add_square(Vec3(-0.4, 0, 0), Y, Z);  // through the first, beside the second
  EXPECT_EQ(quads.crossings(), 2u);
  quads.add_square(Vec3(0, 0, 5), X, Y);
  EXPECT_EQ(quads.crossings(), 2u);
}

TEST(SelfIntersections, WhatTouchesIsNot) {
  const std::vector<std::pair<Vec3, std::pair<Vec3, Vec3>>> touching = {
      {Vec3(0, 0, 1), {Y, Z}},       // an edge lies on the other
      {Vec3(0, 0, 1), {X + Y, Z}},   // along its diagonal
      {Vec3(2, 0, 0), {X, Y}},       // side by side
      {Vec3(2, 0.5, 0), {X, Y}},     // as where a neighbour is cut in two
      {Vec3(0, 0, 0), {X, Y}},       // one upon the other
      {Vec3(0.5, 0.5, 0), {X, Y}},   // in part
      {Vec3(1, 0, 1), {Y, Z}},       // edge on edge
      {Vec3(2, 2, 0), {X, Y}},       // corner on corner
      {Vec3(0, 0, 1e-12), {X, Y}}};  // nearly
  int cases = 0;
  Random random(1);
  for (const auto& [middle, sides] : touching) {
    Quads quads;
    quads.add_square(Vec3::Zero(), X, Y);
    quads.add_square(middle, sides.first, sides.second);
    EXPECT_EQ(quads.crossings(), 0u) << "case " << cases;
    // And however it lies in space, as far as rounding goes.
    for (int turn = 0; turn < 50; ++turn) {
      const Vec3 axis = Vec3(between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)).normalized(),
                 shift(230, -40, 17);
      const Mat3 R = Eigen::AngleAxisd(between(random, 0, 6), axis).toRotationMatrix();
      Quads turned = quads;
      for (Vec3& x : turned.positions) x = 26 * (R * x) + shift;
      EXPECT_EQ(turned.crossings(), 0u) << "case " << cases;
    }
    ++cases;
  }
  EXPECT_EQ(cases, 9);
}

// Every edge of one meets an edge of the other, or a line of its fan, where it passes through the plane between them.
TEST(SelfIntersections, MirrorImagesThatCrossAreSeen) {
  Quads quads;
  quads.add({Vec3(-1, -1, 0), Vec3(1, -1, 0.1), Vec3(1, 1, 0.4), Vec3(-1, 1, 0.5)});
  quads.add({Vec3(-1, 1, 0), Vec3(1, 1, 0.1), Vec3(1, -1, 0.4), Vec3(-1, -1, 0.5)});
  EXPECT_EQ(quads.crossings(), 1u);
}

// Whether an edge of one passes through the other.
bool triangles_meet(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  const auto volume = [](const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    return (q - p).cross(r - p).dot(s - p);
  };
  const auto pierces = [&](const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
    if (volume(t[0], t[1], t[2], p) * volume(t[0], t[1], t[2], q) >= 0) return false;
    const double u = volume(p, q, t[0], t[1]), v = volume(p, q, t[1], t[2]), w = volume(p, q, t[2], t[0]);
    return (u > 0) == (v > 0) && (v > 0) == (w > 0);
  };
  for (int i = 0; i < 3; ++i)
    if (pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a)) return true;
  return false;
}

TEST(SelfIntersections, AreThoseOfEveryPairOfTriangles) {
  Random random(7);
  Quads quads;
  for (int k = 0; k < 400; ++k) {
    std::array<Vec3, 4> corners;
    const Vec3 middle(between(random, 0, 20), between(random, 0, 10), between(random, 0, 10));
    for (int i = 0; i < 4; ++i)
      corners[i] = middle + (i == 1 || i == 2 ? 1 : -1) * X + (i > 1 ? 1 : -1) * Y +
                   0.8 * Vec3(between(random, -1, 1), between(random, -1, 1), between(random, -2, 2));
    quads.add(corners);
  }
  const auto fan = [&](std::size_t f, int i) {
    const auto x = [&](int k) { return quads.positions[4 * f + k]; };
    return std::array<Vec3, 3>{x(i), x((i + 1) % 4), (x(0) + x(1) + x(2) + x(3)) / 4};
  };
  std::vector<std::pair<std::size_t, std::size_t>> expected;
  for (std::size_t a = 0; a < 400; ++a)
    for (std::size_t b = a + 1; b < 400; ++b) {
      bool meet = false;
      for (int i = 0; i < 16; ++i) meet = meet || triangles_meet(fan(a, i / 4), fan(b, i % 4));
      if (meet) expected.emplace_back(a, b);
    }
  EXPECT_GT(expected.size(), 200u);
  EXPECT_EQ(crossing_facets(quads.facets, quads.positions), expected);
}

// A fold, pressed together until its sides pass through each other.
TEST(SelfIntersections, OfASheetFoldedThroughItself) {
  const Tissue block = build_block({200, 60, 10, {20, 3, 1}, {1, 1, 1}});
  int folded = 0;
  for (const double angle : {1.0, 2.5, 3.3}) {  // half the turn from one end to the other
    Vectors positions = block.rest_positions;
    const double radius = 100 / angle;
    for (Vec3& x : positions) {
      const double turn = x.x() / radius;
      x = Vec3((radius - x.z()) * std::sin(turn), x.y(), x.z() + (radius - x.z()) * (1 - std::cos(turn)));
    }
    const std::size_t count = self_intersections(block, positions);
    const CellSet cells = self_intersecting_cells(block, positions);
    if (angle < 3.14) {
      EXPECT_EQ(count, 0u) << angle;
    } else {
      EXPECT_GT(count, 0u);
      EXPECT_TRUE(std::ranges::count(cells, true) > 0 && std::ranges::count(cells, true) < 60);
      ++folded;
    }
  }
  EXPECT_EQ(folded, 1);
}

// Resting embryos and sheets have none, nor have cells that are cut, whose neighbours' edges have new nodes midway.
TEST(SelfIntersections, AreNoneAtRestAndAfterDivisions) {
  for (const bool closed : {true, false}) {
    Model model(closed ? build_shell({}) : build_block({200, 100, 20, {10, 5, 1}, {1, 1, 1}}));
    EXPECT_EQ(self_intersections(model.tissue, model.tissue.rest_positions), 0u);
    Random random(3);
    State state = rest_state(model);
    for (int round = 0; round < 4; ++round) {
      divide_cells(model, state, random_divisions(model.tissue, 0.5, random));
      EXPECT_EQ(self_intersections(model.tissue, state.positions), 0u) << "round " << round;
    }
  }
}

}  // namespace
