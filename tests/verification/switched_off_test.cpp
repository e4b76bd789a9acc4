// "When k_c is decreasing to zero, the contractile force is nullified and the cell returns to its original
// configuration" (the paper, section 2.3): the whole embryo, after its furrow has formed.
#include <gtest/gtest.h>

#include <cstdio>

#include "mechanics/elasticity/turning_elements.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"

namespace plica {
namespace {

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
  int cases = 0;
  for (const char* name : {"drosophila", "drosophila-shape-memory"}) {
    const Returned returned = switch_off(name);
    EXPECT_GT(returned.folded_um, 20);
    EXPECT_LE(returned.left_um, 1e-6);
    ++cases;
  }
  RecordProperty("cases", cases);
}

}  // namespace
}  // namespace plica
