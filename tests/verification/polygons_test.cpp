// Sheets of irregular polygons against the theory of plates: a constant strain is exact, and they bend as a plate does.
#include <gtest/gtest.h>

#include <cstdio>
#include <set>

#include "support/linear_statics.hpp"
#include "support/prisms.hpp"

namespace plica {
namespace {

using namespace support;

constexpr double young = 1;

using Case = std::pair<PolygonSplit, double>;  // split, Poisson's ratio

class PolygonSheets : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Splits, PolygonSheets,
                         testing::Values(Case{PolygonSplit::diagonals, 0.3}, Case{PolygonSplit::diagonals, 0.45},
                                         Case{PolygonSplit::kites, 0.3}, Case{PolygonSplit::kites, 0.45}),
                         [](const auto& given) {
                           return std::string(given.param.first == PolygonSplit::kites ? "kites" : "diagonals") +
                                  (given.param.second == 0.3 ? "3" : "45");
                         });

/// Free nodes of walls that have a cell on one side only.
std::set<std::size_t> rim_of(const Tissue& tissue) {
  std::set<std::size_t> rim;
  std::map<std::pair<NodeId, NodeId>, int> cells_of;  // edges
  for (const Cell& cell : tissue.cells)
    for (const CellEdge& edge : cell.edges)
      if (edge.side != CellSide::lateral) ++cells_of[std::minmax(edge.nodes.front(), edge.nodes.back())];
  for (const Cell& cell : tissue.cells)
    for (const CellEdge& edge : cell.edges) {
      if (edge.side == CellSide::lateral || cells_of.at(std::minmax(edge.nodes.front(), edge.nodes.back())) > 1)
        continue;
      for (const NodeId node : edge.nodes) rim.insert(node.index());
    }
  return rim;
}

// Stretched along and across, free above and below: u = (a x, b y, -nu/(1 - nu) (a + b) z).
TEST_P(PolygonSheets, StretchAsAPlateDoes) {
  const auto [split, poisson] = GetParam();
  const Tissue tissue = tissue_from_prisms(irregular_polygons(9, 8, 4, 12, 0.15, 3), split, 1);
  LinearStatics statics(tissue, ElasticModuli::from_young(young, poisson));
  const double thins = -poisson / (1 - poisson) * (2e-3 - 1e-3);
  const auto exact = [&](const Vec3& x) { return Vec3(2e-3 * x.x(), -1e-3 * x.y(), thins * x.z()); };
  for (const std::size_t n : rim_of(tissue)) statics.prescribe(n, exact(tissue.rest_positions[n]));
  const Vectors u = statics.solve();
  for (std::size_t n = 0; n < u.size(); ++n)
    EXPECT_LE((u[n] - exact(tissue.rest_positions[n])).norm(), 1e-12) << "node " << n;
}

/// The energy of a sheet that is bent across the middle of its height, as a part of a plate's: along x by a curvature,
/// flat along y.
double bending_over_exact(const PrismSheet& sheet, PolygonSplit split, double poisson, double height) {
  const Tissue tissue = tissue_from_prisms(sheet, split, 1);
  LinearStatics statics(tissue, ElasticModuli::from_young(young, poisson));
  constexpr double curvature = 1e-4;
  const auto exact = [&](const Vec3& x) {
    const double z = x.z() + height / 2;
    return Vec3(-curvature * x.x() * z, 0, curvature / 2 * (x.x() * x.x() + poisson / (1 - poisson) * z * z));
  };
  for (const std::size_t n : rim_of(tissue)) statics.prescribe(n, exact(tissue.rest_positions[n]));
  const Vectors u = statics.solve(), forces = statics.reactions(u);
  double energy = 0, area = 0;
  for (std::size_t n = 0; n < tissue.free_node_count(); ++n) energy += 0.5 * u[n].dot(forces[n]);
  for (const double of_cell : apical_areas(tissue, tissue.rest_positions)) area += of_cell;
  const double plate = young / (1 - poisson * poisson) * height * height * height / 12;
  return energy / (0.5 * plate * curvature * curvature * area);
}

// Cells 7 um wide and 12 high, and finer ones of the same height: what is left falls with the square of their width.
TEST_P(PolygonSheets, BendAsAPlateDoes) {
  const auto [split, poisson] = GetParam();
  constexpr double height = 12, edge = 4;
  double last = 0;
  for (const int times : {1, 2}) {
    const PrismSheet sheet = irregular_polygons(12 * times, 14 * times, edge / times, height, 0.1, 3);
    const double error = bending_over_exact(sheet, split, poisson, height) - 1;
    std::printf("bending, %s, nu = %.2f, edges of %.0f um: energy over a plate's %.4f\n",
                split == PolygonSplit::kites ? "kites" : "diagonals", poisson, edge / times, 1 + error);
    EXPECT_NEAR(error, 0, 0.05);
    if (times > 1) {
      EXPECT_LT(error, 0.4 * last);
    }
    last = error;
  }
}

}  // namespace
}  // namespace plica
