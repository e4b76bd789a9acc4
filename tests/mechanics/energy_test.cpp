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

// The work of a law's forces on a straight way of length `size` that takes `size` seconds, by the forces midway, and
// what the law says of it. Midway, what flows has flown for half of the time.
struct Work {
  double of_forces, told;
};

Work work_over(const std::function<std::unique_ptr<Law>(const Tissue&)>& make, const Tissue& tissue, double size) {
  Model model(tissue);
  model.laws.push_back(make(model.tissue));
  const Law& law = *model.laws.front();
  State before = rest_state(model);
  before.time_s = 1;
  Random random(5);
  for (Vec3& x : before.positions) x += random.vector(1.5);
  State after = before;
  after.time_s += size;
  for (Vec3& x : after.positions) x += size * random.vector(2);

  Vectors middle = before.positions;
  for (std::size_t n = 0; n < middle.size(); ++n) middle[n] = 0.5 * (before.positions[n] + after.positions[n]);
  Step step;
  step.positions = middle;
  step.previous_positions = before.positions;
  step.previous_velocities = before.velocities;
  step.rate_s = 0.5 * size;
  step.end_time_s = 1 + 0.5 * size;
  step.internal = before.internals.front();
  if (step.internal.empty()) {
    // Rates are the mean ones of the whole way: (q - q_before)/rate with so large an `ahead` that the way from the
    // beginning to the end is all that counts.
    step.earlier_positions = after.positions;
    step.ahead = 1e6;
    step.rate_s = (0.5 + step.ahead) * size;
  }
  const Vectors forces = forces_of(law, step);
  double work = 0;
  for (std::size_t n = 0; n < forces.size(); ++n) work += forces[n].dot(after.positions[n] - before.positions[n]);

  step.positions = after.positions;
  step.ahead = 0;
  step.rate_s = size;
  step.end_time_s = after.time_s;
  after.internals.front() = law.next_internal(step);
  const EnergyFlow flow = energy_flows(model, before, after).front();
  return {work, flow.active - flow.stored - flow.dissipated};
}

CellSet all_cells(const Tissue& tissue) { return CellSet(tissue.cells.size(), true); }

// Both are right to second order, so they differ by the third power of the size.
TEST(EnergyFlow, IsTheWorkOfTheLawsForces) {
  using Make = std::function<std::unique_ptr<Law>(const Tissue&)>;
  const auto cortex = [](CortexRule rule) {
    return [rule](const Tissue& t) { return std::make_unique<Cortex>(t, all_cells(t), rule); };
  };
  const ElasticModuli moduli = ElasticModuli::from_young(1, 0.3);
  const std::vector<std::pair<const char*, Make>> laws = {
      {"corotational", [&](const Tissue& t) { return std::make_unique<Corotational>(t, in_elements(t, moduli), 0); }},
      {"and viscous", [&](const Tissue& t) { return std::make_unique<Corotational>(t, in_elements(t, moduli), 2); }},
      {"shape memory",
       [&](const Tissue& t) {
         return std::make_unique<ShapeMemory>(t, AttractorSprings{3, 0, 0, 0}, 2);
       }},
      {"neo-Hookean",
       [&](const Tissue& t) {
         return std::make_unique<NeoHookean>(t, materials_of(t, std::vector{1.0, 2.0}));
       }},
      {"that flows",
       [&](const Tissue& t) {
         return std::make_unique<NeoHookean>(t, materials_of(t, std::vector{1.0, 2.0}, std::vector{3.0, 5.0}));
       }},
      {"shell drag",
       [](const Tissue& t) {
         return std::make_unique<ShellDrag>(t, Capsule{.half_axis_um = 0, .radius_um = 1}, 0.14);
       }},
      {"corner barrier", [&](const Tissue& t) { return std::make_unique<CornerBarrier>(t, 1, 0.9); }},
      {"drag", [](const Tissue& t) { return std::make_unique<SurfaceDrag>(t, 0.14); }},
      {"pressure",
       [](const Tissue& t) {
         return std::make_unique<FacePressure>(t, true, all_cells(t), 0.3, Program({0, 4}, {0, 1}));
       }},
      {"contraction",
       [](const Tissue& t) {
         const ContractionRule rule{
             .stiffness = 2, .diagonals = true, .rest_length_ratio = 0.4, .preload = 1, .damping = 3};
         return std::make_unique<Contraction>(contraction_springs(t, all_cells(t), rule), Program({0, 4}, {0, 1}));
       }},
      {"tension", cortex({.tension = 1.4, .saturation = 0.16, .program = Program({0, 4}, {0, 1})})},
      {"stiffness", cortex({.side = CellSide::lateral, .stiffness = 2, .stiffness_program = Program({0, 4}, {0, 1})})},
      {"stiffness that falls", cortex({.stiffness = 2, .stiffness_program = Program({0, 4}, {1, 0})})},
      {"flow", cortex({.side = CellSide::basal, .stiffness = 2, .relaxation_s = 3})},
      {"crowding", cortex({.crowding = 0.2})}};
  const Tissue tissue =
      distorted_block({.length_um = 40, .width_um = 20, .cell_height_um = 30, .cells = {2, 1, 1}}, 2, 3);
  for (const auto& [name, make] : laws) {
    const Work coarse = work_over(make, tissue, 0.1), fine = work_over(make, tissue, 0.05);
    const double error = coarse.told - coarse.of_forces, finer = fine.told - fine.of_forces;
    EXPECT_GT(std::abs(coarse.of_forces), 1e-3) << name;
    EXPECT_LE(std::abs(error), 0.05 * std::abs(coarse.of_forces)) << name;
    EXPECT_LE(std::abs(finer), std::abs(error) / 6 + 1e-12 * std::abs(fine.of_forces)) << name;
  }
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
