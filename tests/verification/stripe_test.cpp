// A stripe that contracts. "When k_c is decreasing to zero, the contractile force is nullified and the cell returns to
// its original configuration" (the paper, section 2.3): the whole embryo, after its furrow has formed.
// A strip that is stretched at once and held: how its pull decays where its rest shape flows (Maxwell), against the
// flow's equation in one dimension. Cells keep their volumes, sides are free.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "mechanics/elasticity/neo_hookean.hpp"
#include "mechanics/elasticity/turning_elements.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/models.hpp"

namespace plica {
namespace {

using namespace support;

const std::string sheet = R"(format = 1
[embryo]
shape = "sheet"
periodic = ["x"]
length_um = 30
width_um = 70
cell_count = 84
cell_height_um = 15
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
  int cases = 0;
  for (const std::string load :
       {"[contraction.apical]\nstiffness_nN_per_um = 2", "[contraction.apical]\ntension_mN_per_m = 1.5",
        "[cortex.apical]\ntension_mN_per_m = 2\nsaturation_ratio = 0.3"}) {
    const double diagonals = depth_by(load, {}), kites = depth_by(load, {"embryo.elements=kites"});
    std::printf("%s: %.3f um by diagonals, %.3f by kites\n", load.c_str(), diagonals, kites);
    EXPECT_GT(diagonals, 1.5) << load;
    EXPECT_NEAR(kites, diagonals, 0.03 * diagonals) << load;
    ++cases;
  }
  EXPECT_EQ(cases, 3);
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
      "%s: nodes up to %.3g um from rest with the contraction on, %.1e um after it was switched off (%d steps, "
      "at %.0f s)\n",
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

constexpr double shear_modulus = 0.3, relaxation_s = 100;
constexpr double length = 60, width = 20, height = 30;

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
  Model model(build_block({.length_um = length, .width_um = width, .cell_height_um = height, .cells = {3, 1, 1}}));
  const std::vector<double> moduli(3, shear_modulus), relaxation(3, relaxation_s);
  model.laws.push_back(std::make_unique<NeoHookean>(model.tissue, moduli, relaxation));
  State state = rest_state(model);
  for (std::size_t n = 0; n < model.tissue.node_count(); ++n) {
    const Vec3& X = model.tissue.rest_positions[n];
    model.held[n] = {std::abs(X.x()) == length / 2, X.y() == -width / 2, X.z() == -height / 2};
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
    model.volumes().add_forces(next.positions, next.multipliers, forces);
    double pull = 0;
    for (std::size_t n = 0; n < forces.size(); ++n)
      if (model.tissue.rest_positions[n].x() == length / 2) pull -= forces[n].x();
    state = std::move(next);
    return pull / (width * height * shear_modulus);
  };
  Pulls pulls{step(1e-7), 0};
  state.trend = {};  // what came before says nothing of a step of another length
  for (int k = 0; k < steps; ++k) pulls.after_tau = step(relaxation_s / steps);
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
}  // namespace plica
