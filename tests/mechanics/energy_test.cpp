// Where energy goes: laws against the work of their forces, a spring in a fluid against its closed solution, and the
// order of what is missing.
#include "mechanics/energy.hpp"

#include "mechanics/active/contraction.hpp"
#include "mechanics/active/cortex.hpp"
#include "mechanics/constraints/ties.hpp"
#include "mechanics/contact/self_contact.hpp"
#include "mechanics/elasticity/corner_barrier.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "mechanics/elasticity/shape_memory.hpp"
#include "mechanics/obstacles/shell_drag.hpp"
#include "mechanics/surroundings.hpp"
#include "simulation/simulation.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/elements.hpp"
#include "support/law_checks.hpp"
#include "support/scenarios.hpp"

namespace {

CellSet all_cells(const Tissue& tissue) { return CellSet(tissue.cells.size(), true); }

TEST(EnergyFlow, IsTheWorkOfTheLawsForces) {
  const Tissue tissue =
      distorted_block({.length_um = 40, .width_um = 20, .cell_height_um = 30, .cells = {2, 1, 1}}, 2, 3);
  const auto check = [&](const char* what, const Law& law) {
    SCOPED_TRACE(what);
    check_energy_flow(law, tissue);
  };
  const CellSet all = all_cells(tissue);
  const Program rising({0, 4}, {0, 1}), falling({0, 4}, {1, 0});
  const auto moduli = in_elements(tissue, ElasticModuli::from_young(1, 0.3));
  check("corotational", Corotational(tissue, moduli, 0));
  check("and viscous", Corotational(tissue, moduli, 2));
  check("shape memory", ShapeMemory(tissue, AttractorSprings{3, 0, 0, 0}, 2));
  check("neo-Hookean", NeoHookean(tissue, materials_of(tissue, std::vector{1.0, 2.0})));
  check("that flows", NeoHookean(tissue, materials_of(tissue, std::vector{1.0, 2.0}, std::vector{3.0, 5.0})));
  check("shell drag", ShellDrag(tissue, Capsule{.half_axis_um = 0, .radius_um = 1}, 0.14));
  check("corner barrier", CornerBarrier(tissue, 1, 0.9));
  check("drag", SurfaceDrag(tissue, 0.14));
  check("pressure", FacePressure(tissue, CellSide::apical, all, 0.3, rising));
  const ContractionRule springs{
      .stiffness = 2, .diagonals = true, .rest_length_ratio = 0.4, .preload = 1, .damping = 3};
  check("contraction", Contraction(contraction_springs(tissue, all, springs), rising));
  check("tension", Cortex(tissue, all, {.tension = 1.4, .saturation = 0.16, .program = rising}));
  check("stiffness", Cortex(tissue, all, {.side = CellSide::lateral, .stiffness = 2, .stiffness_program = rising}));
  check("stiffness that falls", Cortex(tissue, all, {.stiffness = 2, .stiffness_program = falling}));
  check("flow", Cortex(tissue, all, {.side = CellSide::basal, .stiffness = 2, .relaxation_s = 3}));
  check("crowding", Cortex(tissue, all, {.crowding = 0.2}));
}

// A node that a constant tension P pulls against a spring k in a fluid D: x = (P/k)(1 - exp(-t k/D)).
constexpr double pull = 4, stiffness = 2, drag = 10, length = 20;

Model spring_in_fluid() {
  Model model(build_block({.length_um = length, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}}));
  for (auto& directions : model.held) directions = {true, true, true};
  model.held[1][0] = false;
  model.volumes.hold(false);
  model.laws.push_back(std::make_unique<Corotational>(
      model.tissue, in_elements(model.tissue, ElasticModuli::from_young(1e-12, 0.3)), 0));
  model.laws.push_back(std::make_unique<SurfaceDrag>(model.tissue, 0.1));  // of a quarter of 20 x 20 um
  model.laws.push_back(
      std::make_unique<Contraction>(std::vector<Spring>{{{NodeId(0), NodeId(1)}, 0, pull, 0, 0}}, Program{}));
  model.laws.push_back(
      std::make_unique<Ties>(std::vector<Ties::Tie>{{{NodeId(0), NodeId(1)}, Vec3(length, 0, 0)}}, stiffness));
  return model;
}

struct Course {
  EnergyFlow energy;
  double shortened = 0, sum_of_squares = 0;  // of the motion; um, um^2
};

Course pulled_for(double time_s, int steps, TimeOrder order) {
  const Model model = spring_in_fluid();
  NewtonStepper solver(model, {.force = 1e-12}, LinearMethod::automatic, order);
  State state = rest_state(model), next;
  Course course;
  for (int k = 0; k < steps; ++k) {
    const StepReport report = solver.advance(state, time_s / steps, k == 0, next);
    EXPECT_TRUE(report.converged()) << report.reason();
    next.time_s = state.time_s + time_s / steps;
    for (const EnergyFlow& flow : energy_flows(model, state, next)) course.energy += flow;
    course.sum_of_squares += std::pow(next.positions[1].x() - state.positions[1].x(), 2);
    std::swap(state, next);
  }
  course.shortened = model.tissue.rest_positions[1].x() - state.positions[1].x();
  return course;
}

double missing(const EnergyFlow& energy) { return energy.active - energy.stored - energy.dissipated; }

TEST(EnergyBalance, OfASpringInAFluidIsTheClosedSolutions) {
  const double time_s = drag / stiffness, gone = 1 - std::exp(-1);
  const EnergyFlow energy = pulled_for(time_s, 400, TimeOrder::second).energy;
  EXPECT_NEAR(energy.active, pull * pull / stiffness * gone, 1e-4);
  EXPECT_NEAR(energy.stored, 0.5 * pull * pull / stiffness * gone * gone, 1e-4);
  EXPECT_NEAR(energy.dissipated, 0.5 * pull * pull / stiffness * (1 - std::exp(-2)), 1e-4);
}

// Backward Euler loses k/2 dx^2 a step, exactly.
TEST(EnergyBalance, OfBackwardEulerMissesWhatItDamps) {
  for (const int steps : {1, 5, 50}) {
    const Course course = pulled_for(5, steps, TimeOrder::first);
    EXPECT_NEAR(course.energy.active, pull * course.shortened, 1e-9);
    EXPECT_NEAR(course.energy.stored, 0.5 * stiffness * course.shortened * course.shortened, 1e-9);
    EXPECT_NEAR(missing(course.energy), 0.5 * stiffness * course.sum_of_squares, 1e-9) << steps << " steps";
  }
}

TEST(EnergyBalance, IsOfTheOrderOfTheSteps) {
  for (const TimeOrder order : {TimeOrder::first, TimeOrder::second}) {
    double previous = 0;
    for (const int steps : {20, 40, 80, 160}) {
      const EnergyFlow energy = pulled_for(5, steps, order).energy;
      const double ratio = missing(energy) / energy.active;
      std::printf("spring in a fluid, %3d steps: imbalance %.2e", steps, ratio);
      if (previous != 0) {
        const double found = std::log2(previous / ratio);
        std::printf(", order %.3f", found);
        EXPECT_NEAR(found, order == TimeOrder::first ? 1 : 2, 0.15);
      }
      std::printf("\n");
      previous = ratio;
    }
  }
}

// Pairs that are found anew: what the old ones had stored and the new ones do not is lost, and nothing else is.
TEST(EnergyFlow, OfContactLosesWhatPairsLeaveBehind) {
  const Tissue tissue = build_slice({.length_um = 7, .diameter_um = 180, .cell_height_um = 35, .cells = {1, 8, 8}});
  Model model(tissue);
  model.laws.push_back(std::make_unique<SelfContact>(
      model.tissue, SelfContactRule{.side = CellSide::basal, .distance = 60, .stiffness = 1, .search = 120}));
  State before = rest_state(model), after = before;
  after.time_s = 1;
  for (Vec3& x : before.positions) x.y() *= 0.5;
  const SelfContact& law = static_cast<const SelfContact&>(*model.laws.front());
  Motion there{before.positions, before.positions, before.velocities};
  there.internal = law.first_internal(model.tissue);
  before.internals.front() = law.next_internal(there.step());
  for (std::size_t n = 0; n < after.positions.size(); ++n) after.positions[n] = before.positions[n] * 0.98;
  Motion on{after.positions, before.positions, before.velocities};
  on.internal = before.internals.front();
  after.internals.front() = law.next_internal(on.step());
  const EnergyFlow flow = energy_flows(model, before, after).front();
  EXPECT_GT(flow.stored, 0);
  EXPECT_NEAR(flow.stored + flow.dissipated, law.energy(on.step()) - law.energy([&] {
    on.positions = before.positions;
    return on.step();
  }()),
              1e-9 * flow.stored);
}

// Cells act by the signal at the beginning of a step: what balances both ends of a step is counted, not what acts in
// it.
TEST(EnergyBalance, OfCellsThatFollowASignalHasNoLag) {
  const std::string text = R"(format = 1
[embryo]
shape = "sheet"
length_um = 20
width_um = 20
cell_count = 16
cell_height_um = 10
[elasticity]
young_modulus_Pa = 1000
[dynamics]
surface_drag_Pa_s_per_um = 140
[signal.u]
source = { region = "all", per_min = 1 }
[cortex.apical]
region = "all"
tension_mN_per_m = 2
follow = { signal = "u", from = 0, to = 1 }
[time]
end_min = 1
max_step_s = 4
tolerance_um = 1
[stop]
at_equilibrium = false
)";
  Simulation simulation(scenario_of(text));
  ASSERT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
  const double ratio = *simulation.measures()["energy_imbalance_ratio"];
  std::printf("cells that follow a signal: imbalance %.2e in %d steps\n", ratio, simulation.steps());
  EXPECT_LT(simulation.steps(), 30);
  EXPECT_LE(std::abs(ratio), 0.01);
}

// A whole run says the same of itself, law by law.
TEST(EnergyBalance, OfARunIsTheSumOfItsLaws) {
  Simulation simulation(load_scenario(pulled_block("[cortex.skin]\nregion = \"all\"\nstiffness_mN_per_m = 1\n")));
  EXPECT_EQ(simulation.measures()["active_work_nN_um"], 0);
  EXPECT_EQ(simulation.measures()["energy_imbalance_ratio"], std::nullopt);
  simulation.run();
  const std::vector<std::string> labels = energy_labels(simulation.model());
  EnergyFlow sum;
  ASSERT_EQ(simulation.energies().size(), labels.size());
  for (std::size_t l = 0; l < labels.size(); ++l) {
    sum += simulation.energies()[l];
    EXPECT_EQ(simulation.energies()[l].active > 0, labels[l] == "contraction.all") << labels[l];
  }
  const auto measure = [&](std::string_view name) { return *simulation.measures()[name]; };
  EXPECT_EQ(measure("active_work_nN_um"), sum.active);
  EXPECT_EQ(measure("stored_energy_nN_um"), sum.stored);
  EXPECT_EQ(measure("dissipated_energy_nN_um"), sum.dissipated);
  EXPECT_EQ(measure("energy_imbalance_ratio"), missing(sum) / sum.active);
}

}  // namespace
