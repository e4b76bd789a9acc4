// Laplace's law at t = 0: a network of tension T (per width) on a curved surface presses inward with T (1/R1 + 1/R2).
// On the pill: hoop tension presses on the cylinder and on the caps, tension along the axis only on the caps. With one
// tension in every spring the law is exact at each node, not only in the limit: a chord of length l between two points
// of a circle of radius R leans inward by l / 2R.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "mechanics/active/contraction.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

using namespace support;

constexpr double radius = 140, half_axis = 90, force_in_spring = 10;  // um, um, nN: a constant tension in every spring

enum class Place { cylinder, cap };

/// The apical nodes of the ventral face nearest to the midline, well inside the cylinder or well on a cap.
std::vector<std::size_t> midline_nodes(const Tissue& tissue, const std::vector<char>& ventral_inner, Place place) {
  double nearest = 1e9;
  for (std::size_t n = 0; n < tissue.node_count(); ++n)
    if (ventral_inner[n]) nearest = std::min(nearest, std::abs(tissue.rest_positions[n].y()));
  std::vector<std::size_t> nodes;
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const Vec3& X = tissue.rest_positions[n];
    const double x = std::abs(X.x());
    const bool here = place == Place::cylinder ? x < half_axis - 35 : x > half_axis + 25 && x < half_axis + 75;
    if (ventral_inner[n] && here && std::abs(X.y()) < nearest + 4) nodes.push_back(n);
  }
  return nodes;
}

struct Network {
  Tissue tissue;
  std::vector<char> ventral_inner;  // nodes: all four cells around them are ventral
  std::vector<double> area;         // nodes: tributary apical area
  Vectors forces;                   // nodes: of springs
  std::vector<double> length;       // nodes: half the lengths of the springs' edges at it
};

/// Springs on all apical edges of one direction. An inner edge carries two.
Network network(std::array<int, 3> cells, EdgeDirection direction) {
  Network net{build_shell({.cells = cells}), {}, {}, {}, {}};
  const Tissue& tissue = net.tissue;
  std::vector<int> around(tissue.node_count(), 0);
  net.area.assign(tissue.node_count(), 0);
  for (const Facet& facet : tissue.apical_facets) {
    std::array<Vec3, 4> points;
    for (int i = 0; i < 4; ++i) points[i] = tissue.rest_positions[facet.nodes[i].index()];
    for (const NodeId node : facet.nodes) {
      net.area[node.index()] += facet_area(points) / 4;
      around[node.index()] += tissue.cells[facet.cell.index()].grid_place->face == GridPlace::Face::ventral;
    }
  }
  for (const int count : around) net.ventral_inner.push_back(count == 4);
  const ContractionRule rule{.along_ratio = direction == EdgeDirection::along ? 1.0 : 0.0,
                             .across_ratio = direction == EdgeDirection::across ? 1.0 : 0.0,
                             .preload = force_in_spring};
  const auto springs = contraction_springs(tissue, CellSet(tissue.cells.size(), true), rule);
  net.length.assign(tissue.node_count(), 0);
  for (const Spring& spring : springs) {
    const double l =
        (tissue.rest_positions[spring.nodes[0].index()] - tissue.rest_positions[spring.nodes[1].index()]).norm();
    for (const NodeId node : spring.nodes) net.length[node.index()] += l / 4;  // two springs an edge
  }
  const Motion rest = at_rest(tissue);
  net.forces = forces_of(Contraction(springs, {}), rest.step());
  return net;
}

Vec3 inward(const Vec3& X) {
  const double foot = std::clamp(X.x(), -half_axis, half_axis);
  return -(X - Vec3(foot, 0, 0)).normalized();
}

/// Largest relative deviation, over the midline nodes of a place, of the pressure from T/R. T is twice a spring's
/// tension over the width that a chain stands for, area over length of the chain's share.
double worst_deviation(std::array<int, 3> cells, EdgeDirection direction, Place place, double curvature, int& nodes) {
  const Network net = network(cells, direction);
  double worst = 0;
  for (const std::size_t n : midline_nodes(net.tissue, net.ventral_inner, place)) {
    const double pressure = net.forces[n].dot(inward(net.tissue.rest_positions[n])) / net.area[n];
    const double tension = 2 * force_in_spring * net.length[n] / net.area[n];
    worst = std::max(worst, std::abs(pressure - tension * curvature) / (tension / radius));
    ++nodes;
  }
  return worst;
}

void expect_laplace(EdgeDirection direction, Place place, double curvature, const char* name) {
  int nodes = 0;
  for (const std::array<int, 3>& cells :
       {std::array<int, 3>{18, 9, 8}, std::array<int, 3>{36, 18, 16}, std::array<int, 3>{72, 36, 32}}) {
    const double worst = worst_deviation(cells, direction, place, curvature, nodes);
    std::printf("Laplace, %s, %d x %d x %d cells: inward pressure off by %.1e T/R\n", name, cells[0], cells[1],
                cells[2], worst);
    EXPECT_LE(worst, 1e-3);
  }
  EXPECT_GT(nodes, 6);
  ::testing::Test::RecordProperty("nodes", nodes);
}

TEST(Laplace, HoopTensionPressesOnTheCylinder) {
  expect_laplace(EdgeDirection::across, Place::cylinder, 1 / radius, "across, cylinder");
}

TEST(Laplace, AxialTensionDoesNotPressOnTheCylinder) {
  expect_laplace(EdgeDirection::along, Place::cylinder, 0, "along, cylinder");
}

TEST(Laplace, HoopTensionPressesOnTheCaps) {
  expect_laplace(EdgeDirection::across, Place::cap, 1 / radius, "across, caps");
}

TEST(Laplace, AxialTensionPressesOnTheCaps) {
  expect_laplace(EdgeDirection::along, Place::cap, 1 / radius, "along, caps");
}

// A network of equal springs in both directions: T/R on the cylinder and 2 T/R on the caps, as far as cells are square.
// T is two springs over the side of a cell, here the root of the node's area; cells of the pill's cylinder are a third
// longer than wide, which puts 15 % on the hoop.
TEST(Laplace, SquareNetworkPressesTwiceAsHardOnTheCaps) {
  int cases = 0;
  for (const std::array<int, 3>& cells : {std::array<int, 3>{18, 9, 8}, std::array<int, 3>{36, 18, 16}}) {
    const Network along = network(cells, EdgeDirection::along), across = network(cells, EdgeDirection::across);
    std::array<double, 2> mean{};
    for (const Place place : {Place::cylinder, Place::cap}) {
      const auto nodes = midline_nodes(along.tissue, along.ventral_inner, place);
      for (const std::size_t n : nodes) {
        const double tension = 2 * force_in_spring / std::sqrt(along.area[n]);
        const Vec3 force = along.forces[n] + across.forces[n];
        const double pressure = force.dot(inward(along.tissue.rest_positions[n])) / along.area[n];
        mean[place == Place::cap] += pressure / (tension / radius) / static_cast<double>(nodes.size());
      }
    }
    std::printf("Laplace, square network, %d x %d x %d cells: %.3f T/R on the cylinder, %.3f T/R on the caps\n",
                cells[0], cells[1], cells[2], mean[0], mean[1]);
    EXPECT_NEAR(mean[0], 1, 0.2);
    EXPECT_NEAR(mean[1], 2, 0.2);
    ++cases;
  }
  RecordProperty("cases", cases);
}

}  // namespace
}  // namespace plica
