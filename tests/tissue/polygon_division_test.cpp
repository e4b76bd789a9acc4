// Polygons after cuts: that neighbours fit, elements are sound, and volumes are kept.
#include <gtest/gtest.h>

#include "simulation/division_rules.hpp"
#include "support/divided.hpp"
#include "support/prisms.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace plica {
namespace {

using namespace support;

Tissue bent_sheet(unsigned seed) {
  return tissue_from_prisms(bent(irregular_polygons(12, 12, 8, 20, 0.1, seed),
                                 [](const Vec3& x) {
                                   const double radius = 90 + x.z(), angle = x.x() / 90;
                                   return Vec3(radius * std::sin(angle), x.y(), radius * std::cos(angle));
                                 }),
                            PolygonSplit::diagonals, 1);
}

Tissue egg() { return build_egg({460, 180, 180, {}, {}}, 300, 1, {.height_um = 25}); }

// Across the longest axis, along the embryo or across it, of cells at random.
std::vector<CellCut> random_cuts(const Tissue& tissue, const Vectors& positions, std::size_t count, Random& random) {
  std::vector<CellCut> cuts;
  std::set<std::size_t> chosen;
  constexpr std::array planes = {DivisionPlane::longest_axis, DivisionPlane::transverse, DivisionPlane::sagittal};
  while (cuts.size() < count) {
    const auto c = static_cast<std::size_t>(0.5 * (random.number() + 1) * static_cast<double>(tissue.cells.size() - 1));
    if (!chosen.insert(c).second) continue;
    cuts.push_back(cut_by(planes[cuts.size() % 3], tissue, CellId(c), positions));
  }
  return cuts;
}

double worst_element(const Tissue& tissue, const Vectors& positions) {
  double least = 1;
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    least = std::min({least, hex_scaled_jacobian(gather(positions, tissue.elements[e])),
                      hex_scaled_jacobian(tissue.element_rest_shape[e])});
  return least;
}

struct Errors {
  double others = 0, halves = 0, gap = 0, least_jacobian = 1;
  int divisions = 0;
};

// 210 divisions in three rounds, every node moved by up to `size_um` before each. So there are daughters of the third
// generation.
Errors divide_three_times(Tissue tissue, double size_um, unsigned seed) {
  Random random(seed);
  Errors errors;
  int generation = 0;
  for (int round = 0; round < 3; ++round) {
    Vectors positions = tissue.rest_positions;
    for (Vec3& x : positions) x += random.vector(size_um);
    tissue.place_hanging(positions);
    std::map<int, double> before;
    for (const Cell& cell : tissue.cells) before[cell.lineage.id] = cell_volume(tissue, cell, positions);
    const std::vector<CellCut> cuts = random_cuts(tissue, positions, 70, random);
    const Division division = divide(tissue, cuts, round, positions);
    positions = with_new_nodes(tissue, division, positions);
    errors.divisions += static_cast<int>(cuts.size());
    errors.least_jacobian = std::min(errors.least_jacobian, worst_element(tissue, positions));
    for (const Cell& cell : tissue.cells)
      if (before.contains(cell.lineage.id))
        errors.others =
            std::max(errors.others, std::abs(cell_volume(tissue, cell, positions) / before[cell.lineage.id] - 1));
    for (const auto& [low, high] : division.daughters) {
      const Cell &a = tissue.cells[low.index()], &b = tissue.cells[high.index()];
      const double halves = cell_volume(tissue, a, positions) + cell_volume(tissue, b, positions);
      errors.halves = std::max(errors.halves, std::abs(halves / before.at(a.lineage.mother) - 1));
      generation = std::max(generation, a.lineage.generation);
    }
    Vectors elsewhere = tissue.rest_positions;
    for (Vec3& x : elsewhere) x += random.vector(0.2);
    tissue.place_hanging(elsewhere);
    errors.gap = std::max(errors.gap,
                          std::abs(volume_of_cells(tissue, elsewhere) / volume_inside_boundary(tissue, elsewhere) - 1));
  }
  EXPECT_EQ(generation, 3);
  return errors;
}

void check(const char* what, const Errors& errors) {
  EXPECT_EQ(errors.divisions, 210) << what;
  EXPECT_LE(errors.others, 1e-13) << what;
  EXPECT_LE(errors.gap, 1e-13) << what;
  EXPECT_GT(errors.least_jacobian, 0) << what;
  std::cout << what << ": " << errors.divisions << " divisions; volumes of other cells off by " << errors.others
            << ", sums of halves by " << errors.halves << ", inside of the boundary by " << errors.gap
            << "; worst scaled Jacobian " << errors.least_jacobian << "\n";
}

TEST(PolygonDivision, FitsThroughThreeGenerationsOfASheet) {
  for (const unsigned seed : {1u, 2u, 3u}) check("sheet", divide_three_times(bent_sheet(seed), 0.1, seed));
}

TEST(PolygonDivision, FitsThroughThreeGenerationsOfAnEgg) {
  for (const unsigned seed : {1u, 2u, 3u}) check("egg", divide_three_times(egg(), 0.1, seed));
}

TEST(PolygonDivision, OfAHexagonGivesTwoPentagonsAndStopsInItsNeighbours) {
  Tissue tissue = tissue_from_prisms(honeycomb(3, 3, 8, 20), PolygonSplit::diagonals, 1);
  const std::size_t middle = 4, nodes = tissue.free_node_count();
  ASSERT_EQ(tissue.cells[middle].sides(), 6u);
  const Division division = divide(tissue, std::vector<CellCut>{{CellId(middle), 0, 3}}, 0);
  EXPECT_EQ(tissue.cells.size(), 10u);
  EXPECT_EQ(tissue.free_node_count(), nodes + 4);
  for (const CellId daughter : division.daughters[0]) EXPECT_EQ(tissue.cells[daughter.index()].sides(), 5u);
  int stops = 0;
  for (std::size_t c = 0; c < 9; ++c)
    if (c != middle) {
      EXPECT_EQ(tissue.cells[c].sides(), 6u);
      for (const auto& wall : tissue.cells[c].walls) stops += static_cast<int>(wall.size()) - 2;
    }
  EXPECT_EQ(stops, 2);
  const std::vector<double> areas = apical_areas(tissue, tissue.rest_positions);
  EXPECT_NEAR(areas[middle], areas[9], 1e-9);
}

TEST(PolygonDivision, RestShapesOfDaughtersAreTheHalvesOfTheirMother) {
  Tissue tissue = bent_sheet(4);
  for (const std::size_t cell : {9u, 10u, 11u, 12u}) {
    const auto sides = static_cast<int>(tissue.cells[cell].sides());
    const CellCut cut{CellId(cell), 1, 1 + sides / 2};
    const auto [low, high] = halves_of_prism(cut, tissue.cells[cell].rest_shape);
    EXPECT_EQ(low.size() + high.size(), tissue.cells[cell].rest_shape.size() + 8);
    const Division division = divide(tissue, std::vector<CellCut>{cut}, 0);
    const auto [a, b] = division.daughters[0];
    EXPECT_EQ(tissue.cells[a.index()].rest_shape, low);
    EXPECT_EQ(tissue.cells[b.index()].rest_shape, high);
    // Corners at rest lie where the rest shape says: rest positions of this tissue are the mother's shape.
    for (const CellId id : {a, b})
      for (std::size_t i = 0; i < tissue.cells[id.index()].corners.size(); ++i)
        EXPECT_LE((tissue.rest_positions[tissue.cells[id.index()].corners[i].index()] -
                   tissue.cells[id.index()].rest_shape[i])
                      .norm(),
                  1e-9);
  }
}

TEST(PolygonDivision, CutsAcrossTheLongestAxisIntoHalves) {
  PrismSheet sheet = honeycomb(3, 3, 8, 20);
  for (Vectors* vertices : {&sheet.apical, &sheet.basal})
    for (Vec3& x : *vertices) x.x() *= 2;
  const Tissue tissue = tissue_from_prisms(sheet, PolygonSplit::diagonals, 1);
  for (const auto& [plane, axis] :
       {std::pair(DivisionPlane::longest_axis, 0), {DivisionPlane::transverse, 0}, {DivisionPlane::sagittal, 1}}) {
    const CellCut cut = cut_by(plane, tissue, CellId(4), tissue.rest_positions);
    EXPECT_EQ(cut.second_wall - cut.first_wall, 3);
    const auto middle_of = [&](int wall) {
      const auto corners = tissue.cells[4].apical_corners();
      return Vec3(0.5 * (tissue.rest_positions[corners[wall].index()] +
                         tissue.rest_positions[corners[(wall + 1) % 6].index()]));
    };
    const Vec3 way = (middle_of(cut.second_wall) - middle_of(cut.first_wall)).normalized();
    EXPECT_LE(std::abs(way[axis]), std::sqrt(4.0 / 7) + 1e-9) << axis;  // the best of three ways
  }
}

TEST(PolygonDivision, IsRefusedOfKitesAndLayers) {
  const PrismSheet sheet = honeycomb(3, 3, 8, 20);
  EXPECT_FALSE(why_indivisible(tissue_from_prisms(sheet, PolygonSplit::diagonals, 1)));
  EXPECT_TRUE(why_indivisible(tissue_from_prisms(sheet, PolygonSplit::kites, 1)));
  EXPECT_TRUE(why_indivisible(tissue_from_prisms(sheet, PolygonSplit::diagonals, 2)));
}

}  // namespace
}  // namespace plica
