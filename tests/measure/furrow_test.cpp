#include "measure/furrow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "measure/cells.hpp"
#include "support/prisms.hpp"
#include "tissue/shapes/embryo.hpp"

namespace plica {
namespace {

/// The paper's Drosophila, its 14 x 5 contractile ventral cells, and what is measured of them.
struct Pill {
  Tissue tissue = build_shell({});
  CellSet contractile = CellSet(tissue.cells.size());
  FurrowSites sites;

  explicit Pill(int vce_from_end = 2) {
    for (std::size_t c = 0; c < contractile.size(); ++c) {
      const GridPlace& place = *tissue.cells[c].grid_place;
      contractile[c] = place.face == GridPlace::Face::ventral && 2 <= place.place[0] && place.place[0] < 16 &&
                       2 <= place.place[1] && place.place[1] < 7;
    }
    sites = choose_furrow_sites(tissue, contractile, vce_from_end);
  }

  /// Columns and rows of cells on the ventral face.
  [[nodiscard]] std::set<std::array<int, 2>> places(const std::vector<CellId>& cells) const {
    std::set<std::array<int, 2>> result;
    for (const CellId cell : cells) {
      const GridPlace& place = *tissue.cells[cell.index()].grid_place;
      EXPECT_EQ(place.face, GridPlace::Face::ventral);
      result.insert(place.place);
    }
    return result;
  }

  /// Positions at rest, the nodes of some cells shifted.
  [[nodiscard]] Vectors shifted(const std::vector<CellId>& cells, const Vec3& shift) const {
    Vectors positions = tissue.rest_positions;
    std::set<NodeId> nodes;
    for (const CellId cell : cells)
      for (const NodeId node : tissue.cells[cell.index()].corners) nodes.insert(node);
    for (const NodeId node : nodes) positions[node.index()] += shift;
    return positions;
  }

  [[nodiscard]] std::vector<CellId> contractile_cells() const {
    std::vector<CellId> cells;
    for (std::size_t c = 0; c < contractile.size(); ++c)
      if (contractile[c]) cells.emplace_back(c);
    return cells;
  }
};

using Places = std::set<std::array<int, 2>>;

TEST(Furrow, MonitoredCellsAreAtTheMiddleAndSecondLastOnTheMidline) {
  const Pill pill;
  EXPECT_EQ(pill.contractile_cells().size(), 70u);
  EXPECT_EQ(pill.sites.midline_pairs, 7);
  ASSERT_EQ(pill.sites.vml.size(), 2u);
  ASSERT_EQ(pill.sites.vce.size(), 2u);
  EXPECT_EQ(pill.places(pill.sites.vml), (Places{{8, 4}, {9, 4}}));
  EXPECT_EQ(pill.places(pill.sites.vce), (Places{{3, 4}, {14, 4}}));
}

TEST(Furrow, EndCellsAreCountedFromTheEndsAndStopAtTheMiddle) {
  for (const auto& [from_end, column] : {std::pair{1, 2}, {2, 3}, {7, 8}, {8, 8}, {100, 8}}) {
    const Pill pill(from_end);
    EXPECT_EQ(pill.places(pill.sites.vce), (Places{{column, 4}, {17 - column, 4}})) << from_end << " from the end";
  }
}

TEST(Furrow, MidlineRunsFromAnteriorToPosterior) {
  const Pill pill;
  double before = -1e300;
  int ventral = 0;
  for (const CellId cell : pill.sites.midline) {
    const Vec3 centre = cell_centre(pill.tissue.cells[cell.index()], pill.tissue.rest_positions);
    EXPECT_GT(centre.x(), before);
    EXPECT_NEAR(centre.y(), 0, 1e-9);
    EXPECT_LT(centre.z(), 0);
    before = centre.x();
    ventral += pill.tissue.cells[cell.index()].grid_place->face == GridPlace::Face::ventral;
  }
  EXPECT_EQ(ventral, 18);
}

TEST(Furrow, LipsAreTheEdgeOfTheRegionInTheMiddle) {
  const Pill pill;
  ASSERT_TRUE(pill.sites.has_lips);
  const Vectors& rest = pill.tissue.rest_positions;
  // The outermost nodes of the region on x = 0.
  double edge_y = 0, edge_z = 0;
  for (const CellId cell : pill.contractile_cells())
    for (int corner = 4; corner < 8; ++corner) {
      const Vec3& x = rest[pill.tissue.cells[cell.index()].corners[corner].index()];
      if (x.x() == 0 && std::abs(x.y()) > edge_y) edge_y = std::abs(x.y()), edge_z = x.z();
    }
  ASSERT_GT(edge_y, 0);
  const Vec3 left = pill.sites.lips[0].at(rest), right = pill.sites.lips[1].at(rest);
  EXPECT_LE((left - Vec3(0, -edge_y, edge_z)).norm(), 1e-12);
  EXPECT_LE((right - Vec3(0, edge_y, edge_z)).norm(), 1e-12);
  EXPECT_NEAR(lip_shape(pill.tissue, pill.sites, rest).lip_distance_um.value(), 2 * edge_y, 1e-12);
}

TEST(Furrow, AtRestThereIsNone) {
  const Pill pill;
  const LipShape shape = lip_shape(pill.tissue, pill.sites, pill.tissue.rest_positions);
  EXPECT_NEAR(furrow_depth_um(pill.tissue, pill.sites, pill.tissue.rest_positions).value(), 0, 1e-12);
  EXPECT_LT(shape.depth_below_lips_um.value(), 0) << "the belly is convex";
  for (const auto& depth : cell_depths_um(pill.tissue, pill.sites, pill.sites.midline, pill.tissue.rest_positions))
    EXPECT_NEAR(depth.value(), 0, 1e-12);
}

TEST(Furrow, DepthIsTheShiftOfTheMiddle) {
  const Pill pill;
  const LipShape rest = lip_shape(pill.tissue, pill.sites, pill.tissue.rest_positions);
  for (const double shift : {0.5, 7.0, 31.0}) {
    const Vectors positions = pill.shifted(pill.sites.vml, Vec3(0, 0, shift));
    const LipShape shape = lip_shape(pill.tissue, pill.sites, positions);
    EXPECT_NEAR(furrow_depth_um(pill.tissue, pill.sites, positions).value(), shift, 1e-10);
    EXPECT_NEAR(shape.depth_below_lips_um.value(), rest.depth_below_lips_um.value() + shift, 1e-10);
    EXPECT_NEAR(shape.lip_distance_um.value(), rest.lip_distance_um.value(), 1e-12);
    for (const auto& depth : cell_depths_um(pill.tissue, pill.sites, pill.sites.vml, positions))
      EXPECT_NEAR(depth.value(), shift, 1e-10);
    for (const auto& depth : cell_depths_um(pill.tissue, pill.sites, pill.sites.vce, positions))
      EXPECT_NEAR(depth.value(), 0, 1e-12);
  }
}

// A dimple of single faces is no furrow: the middles of polygons move and depth does not, but their corners count.
TEST(Furrow, DepthIsWithoutDimples) {
  const Tissue tissue = tissue_from_prisms(support::honeycomb(5, 5, 6, 12), PolygonSplit::kites, 1);
  const CellSet all(tissue.cells.size(), true);
  const FurrowSites sites = choose_furrow_sites(tissue, all, 2);
  Vectors dimpled = tissue.rest_positions, lowered = tissue.rest_positions;
  int middles = 0;
  for (const Cell& cell : tissue.cells) {
    const Vec3 middle = mean_apical(cell, tissue.rest_positions);
    for (std::size_t n = 0; n < tissue.node_count(); ++n)
      if ((tissue.rest_positions[n] - middle).norm() < 1e-9) dimpled[n].z() -= 2, ++middles;
  }
  for (Vec3& x : lowered) x.z() -= 3;
  EXPECT_EQ(middles, 25);
  const LipShape rest = lip_shape(tissue, sites, tissue.rest_positions);
  const LipShape shape = lip_shape(tissue, sites, dimpled);
  EXPECT_NEAR(furrow_depth_um(tissue, sites, dimpled).value(), 0, 1e-12);
  EXPECT_NEAR(shape.depth_below_lips_um.value(), rest.depth_below_lips_um.value(), 1e-12);
  for (const auto& depth : cell_depths_um(tissue, sites, sites.midline, dimpled)) EXPECT_NEAR(depth.value(), 0, 1e-12);
  EXPECT_NEAR(furrow_depth_um(tissue, sites, lowered).value(), 3, 1e-12);
}

TEST(Furrow, LipsMoveWithTheTissue) {
  const Pill pill;
  const LipShape rest = lip_shape(pill.tissue, pill.sites, pill.tissue.rest_positions);
  // All contractile cells rise: as deep inside the shell, no deeper below the lips.
  const Vectors risen = pill.shifted(pill.contractile_cells(), Vec3(0, 0, 9));
  const LipShape raised = lip_shape(pill.tissue, pill.sites, risen);
  EXPECT_NEAR(furrow_depth_um(pill.tissue, pill.sites, risen).value(), 9, 1e-10);
  EXPECT_NEAR(raised.depth_below_lips_um.value(), rest.depth_below_lips_um.value(), 1e-10);
  EXPECT_NEAR(raised.lip_distance_um.value(), rest.lip_distance_um.value(), 1e-12);
  // Every width narrows by a tenth, and the lips' distance does.
  Vectors narrow = pill.tissue.rest_positions;
  for (Vec3& x : narrow) x.y() *= 0.9;
  EXPECT_NEAR(lip_shape(pill.tissue, pill.sites, narrow).lip_distance_um.value(), 0.9 * *rest.lip_distance_um, 1e-12);
}

TEST(Furrow, WithoutContractileCellsNothingHasAValue) {
  const Tissue tissue = build_shell({});
  const FurrowSites sites = choose_furrow_sites(tissue, CellSet(tissue.cells.size()), 2);
  EXPECT_TRUE(sites.vml.empty());
  EXPECT_TRUE(sites.vce.empty());
  EXPECT_FALSE(sites.has_lips);
  const LipShape shape = lip_shape(tissue, sites, tissue.rest_positions);
  EXPECT_FALSE(furrow_depth_um(tissue, sites, tissue.rest_positions));
  EXPECT_FALSE(shape.depth_below_lips_um || shape.lip_distance_um || shape.highest_points_distance_um);
}

// Whatever side of an embryo, or of a sheet, the apices of the region face: inward is against them.
TEST(Furrow, DepthIsAgainstTheRegionsApices) {
  const Pill pill;
  CellSet dorsal(pill.contractile.size());
  for (std::size_t c = 0; c < dorsal.size(); ++c) {
    const GridPlace& place = *pill.tissue.cells[c].grid_place;
    dorsal[c] = place.face == GridPlace::Face::dorsal && 6 <= place.place[0] && place.place[0] < 12 &&
                2 <= place.place[1] && place.place[1] < 7;
  }
  const FurrowSites sites = choose_furrow_sites(pill.tissue, dorsal, 1);
  EXPECT_EQ(sites.outward, Vec3::UnitZ());
  const Vectors positions = pill.shifted(sites.vml, Vec3(0, 0, -7));
  const LipShape shape = lip_shape(pill.tissue, sites, positions);
  EXPECT_NEAR(furrow_depth_um(pill.tissue, sites, positions).value(), 7, 1e-10);
  EXPECT_NEAR(shape.depth_below_lips_um.value(),
              7 + lip_shape(pill.tissue, sites, pill.tissue.rest_positions).depth_below_lips_um.value(), 1e-10);

  const Tissue block = build_block({90, 90, 10, {9, 9, 1}, {1, 1, 1}});
  CellSet middle(block.cells.size());
  for (std::size_t c = 0; c < middle.size(); ++c)
    middle[c] = cell_centre(block.cells[c], block.rest_positions).norm() < 25;
  const FurrowSites sheet = choose_furrow_sites(block, middle, 1);
  EXPECT_EQ(sheet.outward, Vec3::UnitZ());
  EXPECT_EQ(sheet.midline.size(), 9u);
  Vectors bent = block.rest_positions;
  for (Vec3& x : bent)
    if (Eigen::Vector2d(x.x(), x.y()).norm() < 10) x.z() -= 16.86;
  EXPECT_NEAR(furrow_depth_um(block, sheet, bent).value(), 16.86, 1e-10);
  EXPECT_GT(lip_shape(block, sheet, bent).depth_below_lips_um.value(), 5);
}

// A furrow that is deepest in the middle is straight; one that goes up and down by 3 um is wavy by 3 / sqrt(2).
TEST(Furrow, WavinessIsWhatASmoothFloorLeaves) {
  const Tissue block = build_block({400, 90, 10, {80, 9, 1}, {1, 1, 1}});
  CellSet middle(block.cells.size());
  for (std::size_t c = 0; c < middle.size(); ++c)
    middle[c] = std::abs(cell_centre(block.cells[c], block.rest_positions).x()) < 160;  // 64 cells, of which 32 count
  const FurrowSites sites = choose_furrow_sites(block, middle, 1);
  const auto waviness = [&](const auto& depth) {
    Vectors positions = block.rest_positions;
    for (Vec3& x : positions) x.z() -= depth(x.x());
    return midline_waviness_um(block, sites, positions);
  };
  const auto dome = [](double x) { return 40 - 1e-3 * x * x + 1e-8 * std::pow(x, 4) + 0.02 * x; };
  EXPECT_NEAR(waviness(dome).value(), 0, 1e-10);
  const auto waves = [&](double x) { return dome(x) + 3 * std::cos(2 * std::numbers::pi * x / 20); };
  // A cell's apex, 5 um long, has the mean of its ends.
  EXPECT_NEAR(waviness(waves).value(), 3 * std::cos(std::numbers::pi * 5 / 20) / std::sqrt(2), 0.05);

  CellSet few = middle;
  for (std::size_t c = 0; c < few.size(); ++c)
    few[c] = std::abs(cell_centre(block.cells[c], block.rest_positions).x()) < 40;  // 16, of which 8 count
  EXPECT_FALSE(midline_waviness_um(block, choose_furrow_sites(block, few, 1), block.rest_positions));
}

// From the shell along any direction in y = 0: a sphere's chord, a pill's straight side and caps.
TEST(Furrow, DepthInsideACapsuleIsTheWayOut) {
  const OuterShape sphere(Capsule{0, 10}), pill(Capsule{20, 10});
  int cases = 0;
  for (double angle = 0; angle < 6.28; angle += 0.1, ++cases) {
    const Vec3 outward(std::sin(angle), 0, std::cos(angle)), across(outward.z(), 0, -outward.x());
    EXPECT_NEAR(sphere.depth(3 * outward + 6 * across, outward), 5, 1e-12);
    EXPECT_NEAR(sphere.depth(9 * outward + 6 * across, outward), -1, 1e-12);
    // Where the way out ends, the shell is R from the axis.
    const Vec3 from(7, 0, -4), out = from + pill.depth(from, outward) * outward;
    EXPECT_NEAR(Vec3(out.x() - std::clamp(out.x(), -20.0, 20.0), 0, out.z()).norm(), 10, 1e-9) << angle;
  }
  EXPECT_EQ(cases, 63);
}

}  // namespace
}  // namespace plica
