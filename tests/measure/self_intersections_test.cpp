#include "measure/self_intersections.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mechanics/division.hpp"
#include "support/divided.hpp"
#include "tissue/shapes/embryo.hpp"

namespace plica {
namespace {

using support::Random;

/// Quadrilaterals without common nodes.
struct Quads {
  std::vector<Facet> facets;
  Vectors positions;

  void add(const std::array<Vec3, 4>& corners) {
    Facet facet{};
    for (int i = 0; i < 4; ++i) {
      facet.nodes[i] = NodeId(positions.size());
      positions.push_back(corners[i]);
    }
    facets.push_back(facet);
  }
  void add_square(const Vec3& middle, const Vec3& u, const Vec3& v) {
    add({middle - u - v, middle + u - v, middle + u + v, middle - u + v});
  }
  [[nodiscard]] std::size_t crossings() const { return crossing_facets(facets, positions).size(); }
};

double between(Random& random, double low, double high) { return low + (high - low) * 0.5 * (random.number() + 1); }

const Vec3 X = Vec3::UnitX(), Y = Vec3::UnitY(), Z = Vec3::UnitZ();

TEST(SelfIntersections, WhatPassesThroughIsCounted) {
  Quads quads;
  quads.add_square(Vec3::Zero(), X, Y);
  quads.add_square(Vec3(0.3, 0.2, 0.1), Y, Z);
  EXPECT_EQ(quads.crossings(), 1u);
  quads.add_square(Vec3(-0.4, 0, 0), Y, Z);  // through the first, beside the second
  EXPECT_EQ(quads.crossings(), 2u);
  quads.add_square(Vec3(0, 0, 5), X, Y);
  EXPECT_EQ(quads.crossings(), 2u);
}

TEST(SelfIntersections, WhatTouchesIsNot) {
  const std::vector<std::pair<Vec3, std::pair<Vec3, Vec3>>> touching = {
      {Vec3(0, 0, 1), {Y, Z}},       // an edge lies on the other
      {Vec3(0, 0, 1), {X + Y, Z}},   // along its diagonal
      {Vec3(2, 0, 0), {X, Y}},       // side by side
      {Vec3(2, 0.5, 0), {X, Y}},     // as where a neighbour is cut in two
      {Vec3(0, 0, 0), {X, Y}},       // one upon the other
      {Vec3(0.5, 0.5, 0), {X, Y}},   // in part
      {Vec3(1, 0, 1), {Y, Z}},       // edge on edge
      {Vec3(2, 2, 0), {X, Y}},       // corner on corner
      {Vec3(0, 0, 1e-12), {X, Y}}};  // nearly
  int cases = 0;
  Random random(1);
  for (const auto& [middle, sides] : touching) {
    Quads quads;
    quads.add_square(Vec3::Zero(), X, Y);
    quads.add_square(middle, sides.first, sides.second);
    EXPECT_EQ(quads.crossings(), 0u) << "case " << cases;
    // And however it lies in space, as far as rounding goes.
    for (int turn = 0; turn < 50; ++turn) {
      const Vec3 axis = Vec3(between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)).normalized(),
                 shift(230, -40, 17);
      const Mat3 R = Eigen::AngleAxisd(between(random, 0, 6), axis).toRotationMatrix();
      Quads turned = quads;
      for (Vec3& x : turned.positions) x = 26 * (R * x) + shift;
      EXPECT_EQ(turned.crossings(), 0u) << "case " << cases;
    }
    ++cases;
  }
  EXPECT_EQ(cases, 9);
}

// Every edge of one meets an edge of the other, or a line of its fan, where it passes through the plane between them.
TEST(SelfIntersections, MirrorImagesThatCrossAreSeen) {
  Quads quads;
  quads.add({Vec3(-1, -1, 0), Vec3(1, -1, 0.1), Vec3(1, 1, 0.4), Vec3(-1, 1, 0.5)});
  quads.add({Vec3(-1, 1, 0), Vec3(1, 1, 0.1), Vec3(1, -1, 0.4), Vec3(-1, -1, 0.5)});
  EXPECT_EQ(quads.crossings(), 1u);
}

// Whether an edge of one passes through the other.
bool triangles_meet(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  const auto volume = [](const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    return (q - p).cross(r - p).dot(s - p);
  };
  const auto pierces = [&](const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
    if (volume(t[0], t[1], t[2], p) * volume(t[0], t[1], t[2], q) >= 0) return false;
    const double u = volume(p, q, t[0], t[1]), v = volume(p, q, t[1], t[2]), w = volume(p, q, t[2], t[0]);
    return (u > 0) == (v > 0) && (v > 0) == (w > 0);
  };
  for (int i = 0; i < 3; ++i)
    if (pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a)) return true;
  return false;
}

TEST(SelfIntersections, AreThoseOfEveryPairOfTriangles) {
  Random random(7);
  Quads quads;
  for (int k = 0; k < 400; ++k) {
    std::array<Vec3, 4> corners;
    const Vec3 middle(between(random, 0, 20), between(random, 0, 10), between(random, 0, 10));
    for (int i = 0; i < 4; ++i)
      corners[i] = middle + (i == 1 || i == 2 ? 1 : -1) * X + (i > 1 ? 1 : -1) * Y +
                   0.8 * Vec3(between(random, -1, 1), between(random, -1, 1), between(random, -2, 2));
    quads.add(corners);
  }
  const auto fan = [&](std::size_t f, int i) {
    const auto x = [&](int k) { return quads.positions[4 * f + k]; };
    return std::array<Vec3, 3>{x(i), x((i + 1) % 4), (x(0) + x(1) + x(2) + x(3)) / 4};
  };
  std::vector<std::pair<std::size_t, std::size_t>> expected;
  for (std::size_t a = 0; a < 400; ++a)
    for (std::size_t b = a + 1; b < 400; ++b) {
      bool meet = false;
      for (int i = 0; i < 16; ++i) meet = meet || triangles_meet(fan(a, i / 4), fan(b, i % 4));
      if (meet) expected.emplace_back(a, b);
    }
  EXPECT_GT(expected.size(), 200u);
  EXPECT_EQ(crossing_facets(quads.facets, quads.positions), expected);
}

// A fold, pressed together until its sides pass through each other.
TEST(SelfIntersections, OfASheetFoldedThroughItself) {
  const Tissue block = build_block({200, 60, 10, {20, 3, 1}, {1, 1, 1}});
  int folded = 0;
  for (const double angle : {1.0, 2.5, 3.3}) {  // half the turn from one end to the other
    Vectors positions = block.rest_positions;
    const double radius = 100 / angle;
    for (Vec3& x : positions) {
      const double turn = x.x() / radius;
      x = Vec3((radius - x.z()) * std::sin(turn), x.y(), x.z() + (radius - x.z()) * (1 - std::cos(turn)));
    }
    const std::size_t count = self_intersections(block, positions);
    const CellSet cells = self_intersecting_cells(block, positions);
    if (angle < 3.14) {
      EXPECT_EQ(count, 0u) << angle;
    } else {
      EXPECT_GT(count, 0u);
      EXPECT_TRUE(std::ranges::count(cells, true) > 0 && std::ranges::count(cells, true) < 60);
      ++folded;
    }
  }
  EXPECT_EQ(folded, 1);
}

// Resting embryos and sheets have none, nor have cells that are cut, whose neighbours' edges have new nodes midway.
TEST(SelfIntersections, AreNoneAtRestAndAfterDivisions) {
  int cases = 0;
  for (const bool closed : {true, false}) {
    Model model(closed ? build_shell({}) : build_block({200, 100, 20, {10, 5, 1}, {1, 1, 1}}));
    EXPECT_EQ(self_intersections(model.tissue, model.tissue.rest_positions), 0u);
    Random random(3);
    State state = rest_state(model);
    for (int round = 0; round < 4; ++round, ++cases) {
      divide_cells(model, state, support::random_divisions(model.tissue, 0.5, random));
      EXPECT_EQ(self_intersections(model.tissue, state.positions), 0u) << "round " << round;
    }
  }
  EXPECT_EQ(cases, 8);
}

}  // namespace
}  // namespace plica
