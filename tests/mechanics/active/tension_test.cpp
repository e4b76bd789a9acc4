// A tension per length of the face: what its lines carry together, however the face is divided.
#include <gtest/gtest.h>

#include "mechanics/active/contraction.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

// The pull of all springs across the plane x = `at`, nN, and across y.
double pull_across(const Tissue& tissue, const std::vector<Spring>& springs, int axis, double at) {
  double pull = 0;
  for (const Spring& spring : springs) {
    const double from = tissue.rest_positions[spring.nodes.front().index()][axis],
                 to = tissue.rest_positions[spring.nodes.back().index()][axis];
    if ((from < at) != (to < at)) pull += spring.preload;
  }
  return pull;
}

TEST(Tension, IsThatOfTheWidthWhateverTheCells) {
  int cases = 0;
  for (const std::array<int, 3> cells : {std::array{2, 3, 1}, {4, 3, 1}, {8, 5, 1}})
    for (const std::array<int, 3> elements : {std::array{1, 1, 1}, {2, 2, 1}, {3, 1, 2}})
      for (const CellSide side : {CellSide::apical, CellSide::basal}) {
        const Tissue sheet = build_block({80, 60, 20, cells, elements});
        const auto springs = contraction_springs(sheet, CellSet(sheet.cells.size(), true),
                                                 {.side = side, .across_ratio = 0.5, .tension = 1.5});
        EXPECT_NEAR(pull_across(sheet, springs, 0, 3.3), 1.5 * 60, 1e-9);
        EXPECT_NEAR(pull_across(sheet, springs, 1, 3.3), 0.5 * 1.5 * 80, 1e-9);
        ++cases;
      }
  EXPECT_EQ(cases, 18);
}

// The walls of a cell have its perimeter for a width.
TEST(Tension, OfLateralFacesIsThatOfThePerimeter) {
  const Tissue sheet = build_block({80, 60, 20, {4, 3, 1}, {1, 1, 1}});
  const auto springs =
      contraction_springs(sheet, CellSet(sheet.cells.size(), true), {.side = CellSide::lateral, .tension = 2});
  EXPECT_NEAR(pull_across(sheet, springs, 2, 1.1), 12 * 2 * (4 * 20), 1e-9);
}

}  // namespace
}  // namespace plica
