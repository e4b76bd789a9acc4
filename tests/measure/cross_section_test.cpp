// Cells of cross-sections: which they are, how they are counted, and the shapes of their apices.
#include "measure/cross_section.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tissue/shapes/embryo.hpp"

namespace plica {
namespace {

std::vector<SectionCell> at_place(const std::vector<SectionCell>& cells, int percent) {
  std::vector<SectionCell> found;
  for (const SectionCell& one : cells)
    if (one.place_percent == percent) found.push_back(one);
  return found;
}

Vec3 rest_centre(const Tissue& tissue, CellId cell) {
  return cell_centre(tissue.cells[cell.index()], tissue.rest_positions);
}

// Even and odd numbers of cells along and across: one ring a place, each cell once, numbers in the order of angles.
TEST(CrossSection, IsARingOfCellsAtEachPlace) {
  for (const auto& counts : {std::array{20, 8, 8}, {21, 9, 8}, {20, 9, 7}}) {
    const Tissue tissue = build_shell({.length_um = 500, .diameter_um = 180, .cell_height_um = 35, .cells = counts});
    const std::vector<SectionCell> all = section_cells(tissue, -Vec3::UnitZ());
    EXPECT_EQ(all.front().place_percent, 50);
    const bool odd = counts[1] % 2 == 1;
    const int around = 2 * counts[1] + 2 * counts[2];
    for (const int percent : {25, 50, 75}) {
      const std::vector<SectionCell> ring = at_place(all, percent);
      ASSERT_EQ(ring.size(), static_cast<std::size_t>(around)) << percent;
      std::set<int> numbers;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec3 centre = rest_centre(tissue, ring[i].cell);
        EXPECT_NEAR(centre.x(), 5 * percent - 250, 500.0 / counts[0]);
        EXPECT_TRUE(numbers.insert(ring[i].from_midline).second);
        if (std::abs(centre.y()) > 1e-6) {
          EXPECT_EQ(ring[i].from_midline > 0, centre.y() > 0);
        }
        if (i > 0) {
          EXPECT_GT(ring[i].from_midline, ring[i - 1].from_midline) << "from left to right";
        }
      }
      EXPECT_EQ(numbers.contains(0), odd);
      EXPECT_EQ(*numbers.rbegin(), around / 2);
      EXPECT_EQ(*numbers.begin(), odd ? 1 - around / 2 : -around / 2);
      // The first ones lie on the belly, mirror images of each other; the last ones on the back.
      for (const SectionCell& one : ring) {
        const Vec3 centre = rest_centre(tissue, one.cell);
        if (std::abs(one.from_midline) == 1) {
          EXPECT_LT(centre.z(), -60);
        }
        if (std::abs(one.from_midline) == around / 2 - 1) {
          EXPECT_GT(centre.z(), 60);
        }
      }
    }
  }
}

// A slice has one ring of one cell, wherever it is cut; a sheet's cells are counted along it.
TEST(CrossSection, OfAShortTissueIsOne) {
  const Tissue slice = build_slice({.length_um = 7, .diameter_um = 180, .cell_height_um = 35, .cells = {1, 20, 20}});
  EXPECT_EQ(section_cells(slice, -Vec3::UnitZ()).size(), 80u);
  const Tissue sheet = build_block({.length_um = 20, .width_um = 60, .cells = {1, 3, 1}});
  const std::vector<SectionCell> cells = section_cells(sheet, Vec3::UnitZ());
  ASSERT_EQ(cells.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(cells[i].from_midline, i - 1);
    EXPECT_NEAR(rest_centre(sheet, cells[i].cell).y(), 20 * (i - 1), 1e-9);
  }
}

// A rectangle of 24 by 6 um, turned in its plane by 30 degrees; one element or several.
TEST(ApicalShape, OfARectangleIsItsSides) {
  for (const int elements : {1, 3}) {
    const Tissue tissue = build_block({.length_um = 24,
                                       .width_um = 6,
                                       .cell_height_um = 10,
                                       .cells = {1, 1, 1},
                                       .elements_per_cell = {elements, elements, 1}});
    const std::vector<CellId> cells = {CellId(0)};
    Vectors positions = tissue.rest_positions;
    const double turn = 30 * M_PI / 180;
    for (Vec3& x : positions) x = Eigen::AngleAxisd(turn, Vec3::UnitZ()) * x;
    const FaceShape shape = apical_shapes(tissue, cells, positions).front();
    EXPECT_NEAR(shape.long_axis_um, 24, 1e-9);
    EXPECT_NEAR(shape.short_axis_um, 6, 1e-9);
    EXPECT_NEAR(shape.direction_deg, 30, 1e-9);
    EXPECT_NEAR(shape.width_across_um, std::hypot(24 * std::sin(turn), 6 * std::cos(turn)), 1e-9);
    EXPECT_NEAR(shape.length_along_um, std::hypot(24 * std::cos(turn), 6 * std::sin(turn)), 1e-9);
    // Tilted as a whole about the axis: no other shape. Standing on its end: it has no direction.
    for (Vec3& x : positions) x = Eigen::AngleAxisd(0.7, Vec3::UnitX()) * x;
    EXPECT_NEAR(apical_shapes(tissue, cells, positions).front().direction_deg, 30, 1e-9);
    for (std::size_t n = 0; n < positions.size(); ++n)
      positions[n] = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()) * tissue.rest_positions[n];
    EXPECT_TRUE(std::isnan(apical_shapes(tissue, cells, positions).front().direction_deg));
  }
}

}  // namespace
}  // namespace plica
