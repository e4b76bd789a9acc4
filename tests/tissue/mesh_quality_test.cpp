#include "tissue/mesh_quality.hpp"

#include <gtest/gtest.h>

#include "tissue/shapes/embryo.hpp"

namespace plica {
namespace {

void expect_all(const Spread& spread, double value) {
  EXPECT_NEAR(spread.min, value, 1e-9);
  EXPECT_NEAR(spread.mean, value, 1e-9);
  EXPECT_NEAR(spread.max, value, 1e-9);
}

TEST(MeshQuality, ARegularBlockIsPerfect) {
  int cases = 0;
  for (const std::array<int, 3>& elements : {std::array<int, 3>{1, 1, 1}, {2, 3, 2}}) {
    const Tissue block = build_block(
        {.length_um = 60, .width_um = 30, .cell_height_um = 40, .cells = {3, 2, 1}, .elements_per_cell = elements});
    const MeshQuality quality = mesh_quality(block, block.rest_positions);
    expect_all(quality.volume_um3, 20 * 15 * 40);
    expect_all(quality.apical_area_um2, 20 * 15);
    expect_all(quality.along_um, 20);
    expect_all(quality.across_um, 15);
    expect_all(quality.height_um, 40);
    EXPECT_NEAR(quality.min_scaled_jacobian, 1, 1e-13);
    ++cases;
  }
  RecordProperty("cases", cases);
}

TEST(MeshQuality, MeasuresThePositionsItIsGiven) {
  const Tissue block = build_block({.length_um = 40, .width_um = 20, .cell_height_um = 40, .cells = {2, 1, 1}});
  Vectors positions = block.rest_positions;
  for (Vec3& x : positions)
    if (x.x() == 0) x.x() = 5;  // cells of 25 and 15 um
  const MeshQuality quality = mesh_quality(block, positions);
  EXPECT_NEAR(quality.volume_um3.min, 15 * 800, 1e-9);
  EXPECT_NEAR(quality.volume_um3.mean, 20 * 800, 1e-9);
  EXPECT_NEAR(quality.volume_um3.max, 25 * 800, 1e-9);
  EXPECT_NEAR(quality.along_um.min, 15, 1e-12);
  EXPECT_NEAR(quality.along_um.max, 25, 1e-12);
  positions[0] += Vec3(0, 0, 50);
  EXPECT_LT(mesh_quality(block, positions).min_scaled_jacobian, 0);
}

TEST(MeshQuality, OnlySurfaceCellsHaveAnApicalArea) {
  const Tissue block = build_block({.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 3}});
  expect_all(mesh_quality(block, block.rest_positions).apical_area_um2, 400);
}

}  // namespace
}  // namespace plica
