// A spring under a constant force in a fluid: x(t) = (F/k)(1 - exp(-k t / D)), reached at second order in the step, on
// even steps and on uneven ones, and at any step the BDF2 of it. Rigid rotation of bodies, and momentum.
// A stripe that contracts. "When k_c is decreasing to zero, the contractile force is nullified and the cell returns to
// its original configuration" (the paper, section 2.3): the whole embryo, after its furrow has formed.
// A strip that is stretched at once and held: how its pull decays where its rest shape flows (Maxwell), against the
// flow's equation in one dimension. Cells keep their volumes, sides are free.
#include "mechanics/constraints/cell_volume.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "mechanics/elasticity/turning_elements.hpp"
#include "simulation/simulation.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/elements.hpp"
#include "support/law_checks.hpp"
#include "support/loads.hpp"
#include "support/models.hpp"
#include "support/scenarios.hpp"

namespace {

constexpr double stiffness = 2, force = 4, length = 20;  // nN/um, nN, um
// One facet of 20 x 20 um has the node at a corner: drag 0.1 nN s/um^3 times a quarter of it.
constexpr double drag = 10;  // nN s/um
constexpr double relaxation_s = drag / stiffness;

/// A brick so soft that it is not felt, all of it held but for one node that slides along the x edge under the force.
Model one_spring_in_fluid() {
  Model model(build_block({.length_um = length, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}}));
  for (auto& directions : model.held) directions = {true, true, true};
  model.held[1][0] = false;
  model.volumes.hold(false);
  model.laws.push_back(std::make_unique<Corotational>(
      model.tissue, in_elements(model.tissue, ElasticModuli::from_young(1e-12, 0.3)), 0));
  model.laws.push_back(std::make_unique<SurfaceDrag>(model.tissue, 0.1));
  model.laws.push_back(
      std::make_unique<Contraction>(std::vector<Spring>{{{NodeId(0), NodeId(1)}, stiffness, 0, 0, length}}, Program{}));
  Vectors loads(8, Vec3::Zero());
  loads[1].x() = force;
  model.laws.push_back(std::make_unique<NodalForces>(loads));
  return model;
}

using StepOf = std::function<double(int)>;

/// Elongations after each step.
std::vector<double> elongations(const StepOf& step_s, int steps) {
  const Model model = one_spring_in_fluid();
  NewtonStepper solver(model, {.force = 1e-12}, LinearMethod::automatic, TimeOrder::second);
  State state = rest_state(model), next;
  std::vector<double> all = {0};
  for (int k = 0; k < steps; ++k) {
    const StepReport report = solver.advance(state, step_s(k), k == 0, next);
    EXPECT_TRUE(report.converged()) << report.reason();
    if (!report.converged()) break;
    std::swap(state, next);
    all.push_back(state.positions[1].x() - model.tissue.rest_positions[1].x());
  }
  return all;
}

// (1 + 2w)/(1 + w) x_n+1 - (1 + w) x_n + w^2/(1 + w) x_n-1 = h (F - k x_n+1) / D, w the ratio of steps; the first is
// backward Euler's. From textbooks, not from backward_difference().
TEST(SpringInFluid, EveryStepIsTheBackwardDifference) {
  for (const StepOf& step_s : {StepOf([](int) { return 0.5; }), StepOf([](int) { return 50.0; }),
                               StepOf([](int k) { return k % 2 == 0 ? 1.0 : 0.45; })}) {
    const std::vector<double> ours = elongations(step_s, 12);
    double before = 0, x = 0;
    for (int k = 0; k < 12; ++k) {
      const double h = step_s(k), w = k > 0 ? h / step_s(k - 1) : 0;
      const double of_new = (1 + 2 * w) / (1 + w), of_old = 1 + w, of_older = w * w / (1 + w);
      const double next = (of_old * x - of_older * before + h * force / drag) / (of_new + h * stiffness / drag);
      before = std::exchange(x, next);
      EXPECT_NEAR(ours.at(k + 1), x, 1e-9) << "step " << k << " of " << h << " s";
    }
  }
}

TEST(SpringInFluid, ConvergesToTheExponentialAtSecondOrder) {
  for (const double unevenness : {0.0, 0.3}) {
    double previous = 0;
    for (const int steps : {20, 40, 80, 160, 320}) {
      const double h = relaxation_s / steps;
      const auto step_s = [&](int k) { return h * (1 + (k % 2 == 0 ? unevenness : -unevenness)); };
      const double exact = force / stiffness * (1 - std::exp(-1));
      const double error = elongations(step_s, steps).back() - exact;
      std::printf("spring in a fluid, %3d %s steps to D/k: error %.2e um", steps, unevenness > 0 ? "uneven" : "even",
                  error);
      if (previous != 0) {
        const double order = std::log2(previous / error);
        std::printf(", order %.3f", order);
        EXPECT_NEAR(order, 2, 0.1);
      }
      std::printf("\n");
      previous = error;
    }
  }
}

/// Largest nodal force over E A (A: mean face of a cell) after turns by 0 to 360 degrees about an axis.
double worst_force(const Tissue& tissue, const Vec3& axis, int& cases) {
  const ElasticModuli moduli = ElasticModuli::from_young(1, 0.45);
  const Corotational elasticity(tissue, in_elements(tissue, moduli), 0);
  const Dilatation dilatation(tissue, in_elements(tissue, moduli.bulk_modulus()), false);
  const double area = 20 * 20;
  double worst = 0;
  for (int degrees = 0; degrees <= 360; degrees += 15) {
    const Mat3 R = Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
    Motion motion = at_rest(tissue);
    for (Vec3& x : motion.positions) x = R * x + Vec3(30, -70, 11);
    motion.previous_positions = motion.positions;
    Vectors forces = forces_of(elasticity, motion.step());
    dilatation.add_forces(motion.step(), forces);
    worst = std::max(worst, largest(forces) / area);
    ++cases;
  }
  return worst;
}

TEST(RigidRotation, TurnedBlockHasNoForceAtAnyAngle) {
  const Tissue tissue =
      distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 40, .cells = {3, 2, 1}}, 2, 1);
  Random random(2);
  std::vector<Vec3> axes = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), Vec3(1, 1, 0), Vec3(1, -1, 1)};
  for (int k = 0; k < 40; ++k) axes.push_back(random.vector());
  double worst = 0;
  int cases = 0;
  for (const Vec3& axis : axes) worst = std::max(worst, worst_force(tissue, axis, cases));
  std::printf("rigid rotation of a block: largest force %.1e E A in %d turns\n", worst, cases);
  EXPECT_LE(worst, 1e-10);
}

TEST(RigidRotation, TurnedPillHasNoForceAtAnyAngle) {
  const Tissue tissue = build_shell({});
  double worst = 0;
  int cases = 0;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 2, -3)})
    worst = std::max(worst, worst_force(tissue, axis, cases));
  std::printf("rigid rotation of the pill: largest force %.1e E A in %d turns\n", worst, cases);
  EXPECT_LE(worst, 1e-10);
}

// Waves cross the body of 60 um in about 0.6 s at this density (E = 1 kPa, mass in g).
constexpr double density = 1e-4;

Model free_body() {
  Model model(distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 40, .cells = {3, 2, 2}}, 1, 1));
  const ElasticModuli moduli = ElasticModuli::from_young(1, 0.45);
  model.laws.push_back(std::make_unique<Corotational>(model.tissue, in_elements(model.tissue, moduli), 0));
  model.laws.push_back(
      std::make_unique<Dilatation>(model.tissue, in_elements(model.tissue, moduli.bulk_modulus()), false));
  ContractionRule rule{.stiffness = 1, .preload = 2, .damping = 0.1};
  model.laws.push_back(std::make_unique<Contraction>(
      contraction_springs(model.tissue, CellSet(model.tissue.cells.size(), true), rule), Program{}));
  model.laws.push_back(std::make_unique<Inertia>(model.tissue, density));
  return model;
}

/// Moving, turning and trembling.
State thrown(const Model& model) {
  State state = rest_state(model);
  Random random(2);
  for (std::size_t n = 0; n < state.velocities.size(); ++n)
    state.velocities[n] = Vec3(5, -3, 2) + Vec3(0.3, 0.2, 1).cross(state.positions[n]) + random.vector(2);
  return state;
}

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

Momenta momenta(const Model& model, const State& state) {
  const Inertia inertia(model.tissue, density);
  Momenta sum;
  for (std::size_t n = 0; n < state.positions.size(); ++n) {
    const Vec3 p = inertia.masses()[n] * state.velocities[n];
    sum.linear += p;
    sum.angular += state.positions[n].cross(p);
  }
  return sum;
}

State throw_for(const Model& model, double time_s, int steps, double& worst_linear) {
  StepTolerances tolerances;
  tolerances.force = 1e-10;  // what a step leaves unbalanced moves the body as a whole
  NewtonStepper solver(model, tolerances);
  State state = thrown(model), next;
  const Momenta before = momenta(model, state);
  for (int k = 0; k < steps; ++k) {
    const StepReport report = solver.advance(state, time_s / steps, k == 0, next);
    EXPECT_TRUE(report.converged()) << report.reason() << " in step " << k;
    if (!report.converged()) break;
    std::swap(state, next);
    worst_linear = std::max(worst_linear, (momenta(model, state).linear - before.linear).norm() / before.linear.norm());
  }
  return state;
}

TEST(Momentum, LinearMomentumOfAFreeBodyIsConstant) {
  const Model model = free_body();
  double worst = 0;
  throw_for(model, 1, 20, worst);
  std::printf("free body, 20 steps: linear momentum changes by %.1e\n", worst);
  EXPECT_LE(worst, 1e-12);
}

// Backward Euler loses angular momentum, at first order in the step; the forces themselves do not (the next test).
TEST(Momentum, AngularMomentumDriftsAtFirstOrderInTheStep) {
  const Model model = free_body();
  const Vec3 before = momenta(model, thrown(model)).angular;
  double previous = 0, ignored = 0;
  for (const int steps : {40, 80, 160, 320}) {
    const double drift =
        (momenta(model, throw_for(model, 0.5, steps, ignored)).angular - before).norm() / before.norm();
    std::printf("free body, 0.5 s in %3d steps: angular momentum drifts by %.3e", steps, drift);
    if (previous > 0) {
      std::printf(", order %.2f", std::log2(previous / drift));
    }
    std::printf("\n");
    if (steps == 320) {
      EXPECT_NEAR(std::log2(previous / drift), 1, 0.15);
    }
    previous = drift;
  }
}

TEST(Momentum, InternalForcesHaveNoResultantAndNoTorque) {
  const Model model = free_body();
  double worst_resultant = 0, worst_torque = 0;
  int cases = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Motion motion = random_motion(model.tissue, 3, seed);
    Vectors forces(model.tissue.node_count(), Vec3::Zero());
    for (const auto& law : model.laws)
      if (law->name() != "inertia") law->add_forces(motion.step(), forces);
    Random random(seed);
    std::vector<double> pressures;
    for (std::size_t c = 0; c < model.volumes.count(); ++c) pressures.push_back(random.number(1));
    model.volumes.add_forces(motion.positions, pressures, forces);
    worst_resultant = std::max(worst_resultant, resultant(forces).norm() / largest(forces));
    worst_torque = std::max(worst_torque, torque(forces, motion.positions).norm() / (largest(forces) * 100));
    ++cases;
  }
  std::printf("internal forces: resultant %.1e, torque %.1e of the largest force (arm 100 um) in %d motions\n",
              worst_resultant, worst_torque, cases);
  EXPECT_LE(worst_resultant, 1e-12);
  EXPECT_LE(worst_torque, 1e-12);
}

const std::string sheet = "format = 1\n" + sheet_table(30, 70, 15, 84) + R"(periodic = ["x"]
[region.stripe]
y_um = [-15, 15]
[furrow]
region = "stripe"
[elasticity]
corner_barrier_Pa = 100
[time]
end_min = 30
[stop]
equilibrium_speed_um_per_min = 0.05
)";
const std::string fading = R"(
region = "stripe"
program = { time_min = [0, 2], activity = [0, 1] }
profile = { shape = "linear", half_width_um = 15 }
)";

double depth_by(const std::string& load, const std::vector<std::string>& overrides) {
  Simulation simulation(load_scenario({"stripe", "stripe.toml", sheet + load + fading}, overrides));
  while (simulation.step()) {
  }
  EXPECT_EQ(simulation.status(), RunStatus::equilibrium) << simulation.failure();
  return simulation.measures()["furrow_depth_um"].value();
}

// Springs on edges only let the middles of kites buckle, and their dimples were the depth: 13 % more by springs, 9 % by
// a tension.
TEST(Stripe, IsAsDeepByKitesAsByDiagonals) {
  for (const std::string load :
       {"[contraction.apical]\nstiffness_nN_per_um = 2", "[contraction.apical]\ntension_mN_per_m = 1.5",
        "[cortex.apical]\ntension_mN_per_m = 2\nsaturation_ratio = 0.3"}) {
    const double diagonals = depth_by(load, {}), kites = depth_by(load, {"embryo.elements=kites"});
    std::printf("%s: %.3f um by diagonals, %.3f by kites\n", load.c_str(), diagonals, kites);
    EXPECT_GT(diagonals, 1.5) << load;
    EXPECT_NEAR(kites, diagonals, 0.03 * diagonals) << load;
  }
}

/// Largest distance of a node from its place at rest, once the rigid motion that fits best has been taken back.
double distance_from_rest(const Vectors& rest, const Vectors& positions) {
  Vec3 C = Vec3::Zero(), c = Vec3::Zero();
  for (std::size_t n = 0; n < rest.size(); ++n) {
    C += rest[n] / static_cast<double>(rest.size());
    c += positions[n] / static_cast<double>(rest.size());
  }
  Mat3 A = Mat3::Zero(), R, S;
  for (std::size_t n = 0; n < rest.size(); ++n) A += (positions[n] - c) * (rest[n] - C).transpose();
  polar(A / A.norm() * 2, R, S);
  double largest = 0;
  for (std::size_t n = 0; n < rest.size(); ++n)
    largest = std::max(largest, (positions[n] - c - R * (rest[n] - C)).norm());
  return largest;
}

struct Returned {
  double folded_um;  // how far from rest nodes were while the contraction was on
  double left_um;    // and at the end
};

/// Runs a built-in whose contraction is on for ten minutes and switched off within two; the drag a hundredth of the
/// usual, so that ten minutes and the time after are long.
Returned switch_off(const std::string& name) {
  const Scenario scenario = load_scenario(
      find_scenario(name), {"contraction.apical.program.time_min=[0, 10, 12]",
                            "contraction.apical.program.activity=[1, 1, 0]", "dynamics.surface_drag_Pa_s_per_um=1.36",
                            "time.max_step_s=300", "stop.equilibrium_speed_um_per_min=1e-6", "output.frame_every_s=0"});
  Simulation simulation(scenario);
  Returned returned{};
  const Vectors& rest = simulation.model().tissue.rest_positions;
  simulation.run_until(600);
  EXPECT_NEAR(simulation.time_s(), 600, 1e-6);
  returned.folded_um = distance_from_rest(rest, simulation.state().positions);
  EXPECT_NE(simulation.run(), RunStatus::failed) << simulation.failure();
  EXPECT_GT(simulation.time_s(), 720);
  returned.left_um = distance_from_rest(rest, simulation.state().positions);
  std::printf(
      "%s: nodes up to %.3g um from rest with the contraction on, %.1e um after it was switched off (%d steps, at %.0f "
      "s)\n",
      name.c_str(), returned.folded_um, returned.left_um, simulation.steps(), simulation.time_s());
  return returned;
}

TEST(SwitchedOff, EveryNodeReturnsToRest) {
  for (const char* name : {"drosophila", "drosophila-shape-memory"}) {
    const Returned returned = switch_off(name);
    EXPECT_GT(returned.folded_um, 20);
    EXPECT_LE(returned.left_um, 1e-6);
  }
}

constexpr double shear_modulus = 0.3, decay_s = 100;
constexpr double strip_length = 60, width = 20, height = 30;

// Pull over the section at rest, in units of mu, of a stretch l that is held from time 0, at time t in units of tau:
// l/c - sqrt(c)/l^2, where c = C_p along the strip and dc/dt = l^2 - (l^2 + 2 c^(3/2)/l)/3.
double expected_pull(double l, double t) {
  const auto rate = [&](double c) { return (2 * l * l - 2 * std::pow(c, 1.5) / l) / 3; };
  const int steps = 10000;
  const double h = t / steps;
  double c = 1;
  for (int k = 0; k < steps; ++k) {
    const double a = rate(c), b = rate(c + h / 2 * a), d = rate(c + h / 2 * b), e = rate(c + h * d);
    c += h / 6 * (a + 2 * b + 2 * d + e);
  }
  return l / c - std::sqrt(c) / (l * l);
}

struct Pulls {
  double at_once, after_tau;
};

Pulls pulls_of_strip(double stretch, int steps) {
  Model model(
      build_block({.length_um = strip_length, .width_um = width, .cell_height_um = height, .cells = {3, 1, 1}}));
  const std::vector<double> moduli(3, shear_modulus), relaxation(3, decay_s);
  model.laws.push_back(std::make_unique<NeoHookean>(model.tissue, materials_of(model.tissue, moduli, relaxation)));
  State state = rest_state(model);
  for (std::size_t n = 0; n < model.tissue.node_count(); ++n) {
    const Vec3& X = model.tissue.rest_positions[n];
    model.held[n] = {std::abs(X.x()) == strip_length / 2, X.y() == -width / 2, X.z() == -height / 2};
    state.positions[n].x() *= stretch;
    for (const int axis : {1, 2}) {  // to the sides that are held
      const double side = axis == 1 ? -width / 2 : -height / 2;
      state.positions[n][axis] = side + (X[axis] - side) / std::sqrt(stretch);
    }
  }
  NewtonStepper stepper(model, {}, LinearMethod::direct, TimeOrder::second);
  const auto step = [&](double duration_s) {
    State next;
    const StepReport report = stepper.advance(state, duration_s, true, next);
    EXPECT_TRUE(report.converged()) << report.reason();
    // Without drag what is not balanced at the end is what holds it.
    Step end{next.positions, state.positions, state.velocities, duration_s, next.time_s};
    if (state.trend.step_s > 0) {
      const BackwardDifference rates = backward_difference(duration_s, state.trend.step_s);
      end.rate_s = rates.rate_s;
      end.ahead = rates.ahead;
    }
    end.internal = state.internals[0];
    Vectors forces(next.positions.size(), Vec3::Zero());
    model.laws[0]->add_forces(end, forces);
    model.volumes.add_forces(next.positions, next.multipliers, forces);
    double pull = 0;
    for (std::size_t n = 0; n < forces.size(); ++n)
      if (model.tissue.rest_positions[n].x() == strip_length / 2) pull -= forces[n].x();
    state = std::move(next);
    return pull / (width * height * shear_modulus);
  };
  Pulls pulls{step(1e-7), 0};
  state.trend = {};  // what came before says nothing of a step of another length
  for (int k = 0; k < steps; ++k) pulls.after_tau = step(decay_s / steps);
  return pulls;
}

TEST(MaxwellStrip, PullDecays) {
  for (const double stretch : {1.001, 1.8, 0.5}) {
    const Pulls pulls = pulls_of_strip(stretch, 100);
    const double at_once = expected_pull(stretch, 1e-12), after_tau = expected_pull(stretch, 1);
    std::printf(
        "strip held at %.3f: pull over mu %.5f at once, %.5f after tau (expected %.5f, %.5f); %.4f of it left\n",
        stretch, pulls.at_once, pulls.after_tau, at_once, after_tau, pulls.after_tau / pulls.at_once);
    EXPECT_NEAR(pulls.at_once / at_once, 1, 1e-5);
    EXPECT_NEAR(pulls.after_tau / after_tau, 1, 2e-3);
    if (stretch == 1.001) {
      EXPECT_NEAR(pulls.after_tau / pulls.at_once, std::exp(-1.0), 2e-3);
    }
  }
}

}  // namespace
