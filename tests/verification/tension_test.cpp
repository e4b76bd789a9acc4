// Laplace's law at t = 0: a network of tension T (per width) on a curved surface presses inward with T (1/R1 + 1/R2).
// On the pill: hoop tension presses on the cylinder and on the caps, tension along the axis only on the caps. With one
// tension in every spring the law is exact at each node, not only in the limit: a chord of length l between two points
// of a circle of radius R leans inward by l / 2R.
// Laplace's law, by pressures that are solved for: a ball of cells with a tense cortex on either side, filled with
// yolk. A surface of tension T and radius R holds a pressure that is larger inside by 2T/R. Cells are larger in
// pressure than what is outside by that of the apical cortex, the yolk than cells by that of the basal one.
// Creep of a Kelvin-Voigt spring under a constant force: x(t) = (F/k)(1 - exp(-k t / c)), reached at first or second
// order in the step, and at any step the backward Euler of it.
#include "measure/cells.hpp"
#include "mechanics/active/cortex.hpp"
#include "mechanics/constraints/enclosed_volume.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/elements.hpp"
#include "support/loads.hpp"
#include "support/models.hpp"

namespace {

constexpr double radius = 140, half_axis = 90, force_in_spring = 10;  // um, um, nN: a constant tension in every spring

enum class Place { cylinder, cap };

/// The apical nodes of the ventral face nearest to the midline, well inside the cylinder or well on a cap.
std::vector<std::size_t> midline_nodes(const Tissue& tissue, const std::vector<char>& ventral_inner, Place place) {
  double nearest = 1e9;
  for (std::size_t n = 0; n < tissue.node_count(); ++n)
    if (ventral_inner[n]) nearest = std::min(nearest, std::abs(tissue.rest_positions[n].y()));
  std::vector<std::size_t> nodes;
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const Vec3& X = tissue.rest_positions[n];
    const double x = std::abs(X.x());
    const bool here = place == Place::cylinder ? x < half_axis - 35 : x > half_axis + 25 && x < half_axis + 75;
    if (ventral_inner[n] && here && std::abs(X.y()) < nearest + 4) nodes.push_back(n);
  }
  return nodes;
}

struct Network {
  Tissue tissue;
  std::vector<char> ventral_inner;  // nodes: all four cells around them are ventral
  std::vector<double> area;         // nodes: tributary apical area
  Vectors forces;                   // nodes: of springs
  std::vector<double> length;       // nodes: half the lengths of the springs' edges at it
};

/// Springs on all apical edges of one direction. An inner edge carries two.
Network network(std::array<int, 3> cells, EdgeDirection direction) {
  Network net{build_shell({.cells = cells}), {}, {}, {}, {}};
  const Tissue& tissue = net.tissue;
  std::vector<int> around(tissue.node_count(), 0);
  net.area.assign(tissue.node_count(), 0);
  for (const Facet& facet : tissue.apical_facets) {
    std::array<Vec3, 4> points;
    for (int i = 0; i < 4; ++i) points[i] = tissue.rest_positions[facet.nodes[i].index()];
    for (const NodeId node : facet.nodes) {
      net.area[node.index()] += facet_area(points) / 4;
      around[node.index()] += tissue.cells[facet.cell.index()].grid_place->face == GridPlace::Face::ventral;
    }
  }
  for (const int count : around) net.ventral_inner.push_back(count == 4);
  const ContractionRule rule{.along_ratio = direction == EdgeDirection::along ? 1.0 : 0.0,
                             .across_ratio = direction == EdgeDirection::across ? 1.0 : 0.0,
                             .preload = force_in_spring};
  const auto springs = contraction_springs(tissue, CellSet(tissue.cells.size(), true), rule);
  net.length.assign(tissue.node_count(), 0);
  for (const Spring& spring : springs) {
    const double l =
        (tissue.rest_positions[spring.nodes[0].index()] - tissue.rest_positions[spring.nodes[1].index()]).norm();
    for (const NodeId node : spring.nodes) net.length[node.index()] += l / 4;  // two springs an edge
  }
  const Motion rest = at_rest(tissue);
  net.forces = forces_of(Contraction(springs, {}), rest.step());
  return net;
}

Vec3 inward(const Vec3& X) {
  const double foot = std::clamp(X.x(), -half_axis, half_axis);
  return -(X - Vec3(foot, 0, 0)).normalized();
}

/// Largest relative deviation, over the midline nodes of a place, of the pressure from T/R. T is twice a spring's
/// tension over the width that a chain stands for, area over length of the chain's share.
double worst_deviation(std::array<int, 3> cells, EdgeDirection direction, Place place, double curvature, int& nodes) {
  const Network net = network(cells, direction);
  double worst = 0;
  for (const std::size_t n : midline_nodes(net.tissue, net.ventral_inner, place)) {
    const double pressure = net.forces[n].dot(inward(net.tissue.rest_positions[n])) / net.area[n];
    const double tension = 2 * force_in_spring * net.length[n] / net.area[n];
    worst = std::max(worst, std::abs(pressure - tension * curvature) / (tension / radius));
    ++nodes;
  }
  return worst;
}

void expect_laplace(EdgeDirection direction, Place place, double curvature, const char* name) {
  int nodes = 0;
  for (const std::array<int, 3>& cells :
       {std::array<int, 3>{18, 9, 8}, std::array<int, 3>{36, 18, 16}, std::array<int, 3>{72, 36, 32}}) {
    const double worst = worst_deviation(cells, direction, place, curvature, nodes);
    std::printf("Laplace, %s, %d x %d x %d cells: inward pressure off by %.1e T/R\n", name, cells[0], cells[1],
                cells[2], worst);
    EXPECT_LE(worst, 1e-3);
  }
  EXPECT_GT(nodes, 6);
  ::testing::Test::RecordProperty("nodes", nodes);
}

TEST(Laplace, HoopTensionPressesOnTheCylinder) {
  expect_laplace(EdgeDirection::across, Place::cylinder, 1 / radius, "across, cylinder");
}

TEST(Laplace, AxialTensionDoesNotPressOnTheCylinder) {
  expect_laplace(EdgeDirection::along, Place::cylinder, 0, "along, cylinder");
}

TEST(Laplace, HoopTensionPressesOnTheCaps) {
  expect_laplace(EdgeDirection::across, Place::cap, 1 / radius, "across, caps");
}

TEST(Laplace, AxialTensionPressesOnTheCaps) {
  expect_laplace(EdgeDirection::along, Place::cap, 1 / radius, "along, caps");
}

// A network of equal springs in both directions: T/R on the cylinder and 2 T/R on the caps, as far as cells are square.
// T is two springs over the side of a cell, here the root of the node's area; cells of the pill's cylinder are a third
// longer than wide, which puts 15 % on the hoop.
TEST(Laplace, SquareNetworkPressesTwiceAsHardOnTheCaps) {
  for (const std::array<int, 3>& cells : {std::array<int, 3>{18, 9, 8}, std::array<int, 3>{36, 18, 16}}) {
    const Network along = network(cells, EdgeDirection::along), across = network(cells, EdgeDirection::across);
    std::array<double, 2> mean{};
    for (const Place place : {Place::cylinder, Place::cap}) {
      const auto nodes = midline_nodes(along.tissue, along.ventral_inner, place);
      for (const std::size_t n : nodes) {
        const double tension = 2 * force_in_spring / std::sqrt(along.area[n]);
        const Vec3 force = along.forces[n] + across.forces[n];
        const double pressure = force.dot(inward(along.tissue.rest_positions[n])) / along.area[n];
        mean[place == Place::cap] += pressure / (tension / radius) / static_cast<double>(nodes.size());
      }
    }
    std::printf("Laplace, square network, %d x %d x %d cells: %.3f T/R on the cylinder, %.3f T/R on the caps\n",
                cells[0], cells[1], cells[2], mean[0], mean[1]);
    EXPECT_NEAR(mean[0], 1, 0.2);
    EXPECT_NEAR(mean[1], 2, 0.2);
  }
}

struct Pressures {
  double cells, yolk;  // over those of Laplace's law
};

Pressures pressures(int cells, double apical_tension, double basal_tension) {
  Model model(build_shell({200, 200, 20, {cells, cells, cells}, {1, 1, 1}}));
  const Tissue& tissue = model.tissue;
  model.stiffness_scale = 1e-4;
  model.laws.push_back(
      std::make_unique<Corotational>(tissue, in_elements(tissue, ElasticModuli::from_young(1e-4, 0)), 0));
  model.laws.push_back(std::make_unique<SurfaceDrag>(tissue, 1e-3));
  const CellSet all(tissue.cells.size(), true);
  for (const auto& [side, tension] : {std::pair(CellSide::apical, apical_tension), {CellSide::basal, basal_tension}})
    if (tension > 0)
      model.laws.push_back(std::make_unique<Cortex>(tissue, all, CortexRule{.side = side, .tension = tension}));
  model.constraints.push_back(std::make_unique<EnclosedVolume>(tissue));
  NewtonStepper stepper(model);
  State state = rest_state(model);
  for (int step = 0; step < 12; ++step) {
    State next;
    EXPECT_TRUE(stepper.advance(state, 2, step == 0, next).converged());
    state = std::move(next);
  }
  double of_cells = 0;
  for (const double pressure : state.pressures(model)) of_cells += pressure / static_cast<double>(tissue.cells.size());
  const auto radius_of = [](double volume) { return std::cbrt(0.75 * volume / std::numbers::pi); };
  const double outer = 2 * apical_tension / radius_of(*volume_inside_apices(tissue, state.positions)),
               inner = 2 * basal_tension / radius_of(*lumen_volume(tissue, state.positions));
  return {of_cells / outer, state.multipliers.back() / (outer + inner)};
}

TEST(CortexSphere, PressureJumpsByLaplacesLaw) {
  double last = 1;
  for (const int cells : {6, 12}) {
    const Pressures found = pressures(cells, 1, 0.4);
    std::printf("sphere of %d cells: pressure of cells %.4f, of the yolk %.4f of Laplace's\n", 6 * cells * cells,
                found.cells, found.yolk);
    EXPECT_LT(std::abs(found.yolk - 1), last);
    last = std::abs(found.yolk - 1);
    if (cells < 12) continue;
    EXPECT_NEAR(found.cells, 1, 0.01);
    EXPECT_NEAR(found.yolk, 1, 0.01);
  }
}

constexpr double stiffness = 2, damping = 10, force = 4, length = 20;  // nN/um, nN s/um, nN, um

/// A brick so soft that it is not felt, all of it held but for one node that slides along the x edge under the force:
/// there is nothing but the spring on that edge.
Model one_spring() {
  Model model(build_block({.length_um = length, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}}));
  for (auto& directions : model.held) directions = {true, true, true};
  model.held[1][0] = false;
  model.volumes.hold(false);
  model.laws.push_back(std::make_unique<Corotational>(
      model.tissue, in_elements(model.tissue, ElasticModuli::from_young(1e-12, 0.3)), 0));
  model.laws.push_back(std::make_unique<Contraction>(
      std::vector<Spring>{{{NodeId(0), NodeId(1)}, stiffness, 0, damping, length}}, Program{}));
  Vectors loads(8, Vec3::Zero());
  loads[1].x() = force;
  model.laws.push_back(std::make_unique<NodalForces>(loads));
  return model;
}

/// Elongation after `steps` steps of `duration_s`.
double creep(double duration_s, int steps, TimeOrder order = TimeOrder::first) {
  const Model model = one_spring();
  NewtonStepper solver(model, {.force = 1e-12}, LinearMethod::automatic, order);
  State state = rest_state(model), next;
  for (int k = 0; k < steps; ++k) {
    const StepReport report = solver.advance(state, duration_s, k == 0, next);
    EXPECT_TRUE(report.converged()) << report.reason();
    if (!report.converged()) break;
    std::swap(state, next);
  }
  for (std::size_t n = 0; n < 8; ++n)
    if (n != 1) {
      EXPECT_EQ((state.positions[n] - model.tissue.rest_positions[n]).norm(), 0) << "held node " << n;
    }
  return state.positions[1].x() - model.tissue.rest_positions[1].x();
}

TEST(Creep, EveryStepIsBackwardEuler) {
  for (const double h : {0.01, 1.0, 100.0}) {
    const double exact = force / stiffness * (1 - std::pow(1 + stiffness * h / damping, -10));
    EXPECT_NEAR(creep(h, 10), exact, 1e-9);
  }
}

void expect_convergence(TimeOrder order) {
  const double time = 5;  // one relaxation time c/k
  const double exact = force / stiffness * (1 - std::exp(-stiffness * time / damping));
  double previous = 0;
  for (const int steps : {10, 20, 40, 80, 160}) {
    const double error = creep(time / steps, steps, order) - exact;
    std::printf("creep, %3d steps to c/k: %.6f um, error %.2e", steps, exact + error, error);
    if (previous != 0) {
      const double found = std::log2(previous / error);
      std::printf(", order %.3f", found);
      if (order == TimeOrder::first)
        EXPECT_NEAR(found, 1, 0.05);
      else
        EXPECT_NEAR(found, 2, 0.1);
    }
    std::printf("\n");
    previous = error;
  }
}

TEST(Creep, ConvergesToTheExponentialAtFirstOrder) { expect_convergence(TimeOrder::first); }

TEST(Creep, ConvergesToTheExponentialAtSecondOrder) { expect_convergence(TimeOrder::second); }

}  // namespace
