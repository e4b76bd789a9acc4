// Curvature of regions, and their depth below the cells around them.
#include "measure/region_shape.hpp"

#include "mechanics/model.hpp"
#include "support/testing.hpp"
#include "tissue/shapes/embryo.hpp"

namespace {

Tissue flat() { return build_block({.length_um = 120, .width_um = 80, .cell_height_um = 10, .cells = {6, 4, 1}}); }

Vectors bent(const Tissue& tissue, const std::function<double(double, double)>& height, const Mat3& turn) {
  Vectors positions = tissue.rest_positions;
  for (Vec3& x : positions) x = turn * Vec3(x.x(), x.y(), x.z() + height(x.x(), x.y()));
  return positions;
}

TEST(Curvature, OfAQuadricIsExact) {
  const Tissue tissue = flat();
  const CellSet all(tissue.cells.size(), true);
  const auto saddle = [](double x, double y) { return -x * x / 600 + y * y / 200; };
  for (const CellSide side : {CellSide::apical, CellSide::basal}) {
    const Vectors positions = bent(tissue, saddle, Mat3::Identity());
    const auto along = [&](std::optional<int> axis) { return curvature_per_um(tissue, side, all, axis, positions); };
    EXPECT_NEAR(along(0).value(), 1.0 / 300, 1e-12);
    EXPECT_NEAR(along(1).value(), -1.0 / 100, 1e-12);
    EXPECT_NEAR(along({}).value(), 0.5 / 300 - 0.5 / 100, 1e-12);
    EXPECT_FALSE(along(2));
  }
  const Mat3 turn = Eigen::AngleAxisd(2, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Vectors turned = bent(tissue, saddle, turn);
  EXPECT_NEAR(curvature_per_um(tissue, CellSide::apical, all, {}, turned).value(), 0.5 / 300 - 0.5 / 100, 1e-12);
  CellSet two(tissue.cells.size(), false);
  two[0] = true;
  EXPECT_FALSE(curvature_per_um(tissue, CellSide::apical, two, {}, turned)) << "four nodes";
}

// Anywhere on a sphere, where regions are small.
TEST(Curvature, OfASphereIsThatOfItsRadius) {
  const double radius = 300;
  const Tissue tissue = flat();
  CellSet region(tissue.cells.size(), false);
  for (std::size_t c = 0; c < region.size(); ++c)
    region[c] = cell_centre(tissue.cells[c], tissue.rest_positions).head<2>().norm() < 40;
  for (const double off : {0.0, 60.0}) {
    const auto ball = [&](double x, double y) { return std::sqrt(radius * radius - x * x - (y - off) * (y - off)); };
    const Vectors positions = bent(tissue, ball, Mat3::Identity());
    for (const std::optional<int> axis : {std::optional<int>(), {0}, {1}})
      EXPECT_NEAR(curvature_per_um(tissue, CellSide::apical, region, axis, positions).value(), 1 / radius,
                  0.01 / radius);
  }
}

// A slice has none along its axis; a closed surface has no middle.
TEST(Curvature, OfASliceIsThatOfItsSection) {
  const Tissue slice = build_slice({.length_um = 7, .diameter_um = 180, .cell_height_um = 35, .cells = {1, 20, 20}});
  CellSet region(slice.cells.size(), false);
  for (std::size_t c = 0; c < region.size(); ++c) {
    const Vec3 centre = cell_centre(slice.cells[c], slice.rest_positions);
    region[c] = centre.z() < 0 && std::abs(centre.y()) < 25;
  }
  const auto along = [&](std::optional<int> axis) {
    return curvature_per_um(slice, CellSide::apical, region, axis, slice.rest_positions);
  };
  EXPECT_NEAR(along(1).value(), 1 / 90.0, 0.05 / 90);
  EXPECT_NEAR(along({}).value(), 0.5 * along(1).value(), 1e-15);
  EXPECT_NEAR(along(0).value(), 0, 1e-12);
  EXPECT_FALSE(curvature_per_um(slice, CellSide::apical, CellSet(slice.cells.size(), true), {}, slice.rest_positions));
}

// A row of cells goes down by 5 um while all go up by 7.
TEST(Depth, IsBelowTheCellsAround) {
  const Tissue whole = flat();
  const auto depths = [](const Tissue& tissue, const std::function<double(double, double)>& height) {
    CellSet row;
    std::vector<CellId> cells;
    for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
      row.push_back(std::abs(cell_centre(tissue.cells[c], tissue.rest_positions).y()) < 20);
      if (row.back()) cells.emplace_back(c);
    }
    return depths_below_border_um(tissue, row, cells, bent(tissue, height, Mat3::Identity()));
  };
  const auto sunk = [](double, double y) { return std::abs(y) < 1 ? -3.0 : 7.0; };
  ASSERT_EQ(depths(whole, sunk).size(), 12u);
  for (const double depth : depths(whole, sunk)) EXPECT_NEAR(depth, 5, 1e-12);
  for (const double depth : depths(whole, [](double, double) { return 7.0; })) EXPECT_NEAR(depth, 0, 1e-12);
  // Where cells around rise by 10 um on one side of x, and half of the row's corners with them, depths are by the
  // nearest.
  const std::vector<double> all =
      depths(whole, [&](double x, double y) { return sunk(x, y) + (x > 0 && std::abs(y) > 1 ? 10 : 0); });
  EXPECT_NEAR(all.front(), 5, 0.5);
  EXPECT_NEAR(all[5], 10, 0.5);
  EXPECT_TRUE(depths_below_border_um(whole, CellSet(whole.cells.size(), true), {}, whole.rest_positions).empty());
}

}  // namespace
