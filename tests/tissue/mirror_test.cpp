#include "tissue/mirror.hpp"

#include <gtest/gtest.h>

#include "support/tissues.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

using namespace support;

constexpr std::array<bool, 3> across_y = {false, true, false}, both = {true, true, false};

Tissue pill(std::array<int, 3> elements_per_cell = {1, 1, 1}) {
  return build_shell({300, 160, 30, {12, 8, 6}, elements_per_cell});
}

double sum_of_volumes(const Tissue& tissue) {
  double sum = 0;
  for (const Cell& cell : tissue.cells) sum += cell_volume(tissue, cell, tissue.rest_positions);
  return sum;
}

double sum(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double number : numbers) sum += number;
  return sum;
}

TEST(Mirror, OneSideIsAHalfOrAQuarter) {
  const std::vector<Tissue> wholes = {pill(), pill({2, 1, 2}), build_slice({14, 160, 30, {2, 8, 6}, {1, 1, 1}}),
                                      build_block({.length_um = 60, .width_um = 40, .cells = {6, 4, 2}})};
  for (const Tissue& whole : wholes)
    for (const auto& axes : {across_y, both}) {
      const MirroredSide side = side_of(whole, axes);
      const std::size_t times = axes[0] ? 4 : 2;
      EXPECT_EQ(side.tissue.cells.size() * times, whole.cells.size());
      EXPECT_EQ(side.tissue.elements.size() * times, whole.elements.size());
      EXPECT_EQ(side.tissue.apical_facets.size() * times, whole.apical_facets.size());
      EXPECT_NEAR(sum_of_volumes(side.tissue) * times, sum_of_volumes(whole), 1e-12 * sum_of_volumes(whole));
      const double area = sum(apical_areas(whole, whole.rest_positions));
      EXPECT_NEAR(sum(apical_areas(side.tissue, side.tissue.rest_positions)) * times, area, 1e-12 * area);
      double copies = 0;  // of nodes
      for (std::size_t n = 0; n < side.tissue.node_count(); ++n) {
        const NodeId node(n);
        copies += static_cast<double>(times) * side.tissue.own_share({&node, 1});
      }
      EXPECT_EQ(copies, static_cast<double>(whole.node_count()));
    }
}

TEST(Mirror, TheWholeIsWhereItWas) {
  const Tissue whole = pill({1, 2, 1});
  for (const auto& axes : {across_y, both}) {
    const auto [side, mirror] = side_of(whole, axes);
    const Vectors again = mirror.whole(side.rest_positions);
    ASSERT_EQ(again.size(), whole.node_count());
    for (std::size_t n = 0; n < again.size(); ++n) EXPECT_LT((again[n] - whole.rest_positions[n]).norm(), 1e-10);
    for (const Vec3& x : side.rest_positions) EXPECT_TRUE(x.y() >= 0 && (!axes[0] || x.x() >= 0));
    for (std::size_t c = 0; c < whole.cells.size(); ++c) {
      Vec3 centre = cell_centre(whole.cells[c], whole.rest_positions);
      for (int axis = 0; axis < 2; ++axis)
        if (axes[axis]) centre[axis] = std::abs(centre[axis]);
      EXPECT_LT((cell_centre(side.cells[mirror.cells[c].index()], side.rest_positions) - centre).norm(), 1e-10);
      EXPECT_EQ(mirror.own(mirror.own(CellId(c))), mirror.own(CellId(c)));
    }
    for (std::size_t c = 0; c < side.cells.size(); ++c) {
      EXPECT_EQ(mirror.cells[mirror.origins[c].index()], CellId(c));
      EXPECT_EQ(side.cells[c].lineage.id, whole.cells[mirror.origins[c].index()].lineage.id);
      for (const CellLine& line : side.cells[c].lines)
        for (const NodeId node : line.chain.nodes) EXPECT_LT(node.index(), side.node_count());
    }
  }
}

// Walls count once in a whole: those on a plane are shared with the image.
TEST(Mirror, WallsOnThePlaneAreHalves) {
  const Tissue whole = pill();
  const Tissue side = side_of(whole, both).tissue;
  double walls = 0;
  int halves = 0;
  for (const Face& face : faces_of(side, CellSide::lateral)) {
    EXPECT_EQ(face.share == 1, face.beyond.has_value());
    walls += face.share;
    halves += face.share == 0.5 ? 1 : 0;
  }
  EXPECT_EQ(4 * walls, static_cast<double>(faces_of(whole, CellSide::lateral).size()));
  EXPECT_EQ(halves, 12 + 6 + 8 + 6);  // half a ring along, half a ring around
}

TEST(Mirror, WhatIsNotSymmetricIsRefused) {
  const auto complaint = [](const Tissue& whole) -> std::string {
    try {
      (void)side_of(whole, across_y);
    } catch (const NotSymmetric& error) {
      return std::string(error.what()) + "; " + error.remedy;
    }
    return "";
  };
  EXPECT_EQ(complaint(build_shell({300, 160, 30, {12, 7, 6}, {1, 1, 1}})),
            "the plane y = 0 cuts cells in two, for example cell 36; give an even number of cells along y");
  Tissue bent = pill();
  bent.rest_positions[40].z() += 0.1;
  EXPECT_NE(complaint(bent).find("the mesh is not symmetric about the plane y = 0: it has a node at"),
            std::string::npos)
      << complaint(bent);
}

}  // namespace
}  // namespace plica
