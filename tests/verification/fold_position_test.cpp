// Folds of `growing-disc` follow its map of growth: where the growing region is moved, the fold moves with it. The
// centre of a fold, the mean reference place of basal nodes, weighted by their squared height, lies within a cell of
// the centre of the region. It does not move by the same distance within 10 %: regions are made of whole cells, which
// grow at their own rates.
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
  for (const Vec3& growing : {Vec3(-20, 0, 0), Vec3(0, 20, 0)})
    for (const int seed : {4, 5}) EXPECT_LE((fold_of(growing, seed) - growing).norm(), cell_um);
}

}  // namespace
