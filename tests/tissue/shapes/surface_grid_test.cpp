#include "tissue/shapes/surface_grid.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace plica {
namespace {

const std::array<std::array<int, 3>, 4> counts_of_cases = {{{18, 9, 8}, {9, 9, 8}, {1, 1, 1}, {4, 3, 2}}};

Vec3 point(const SurfaceGrid::Place& place) { return {1.0 * place[0], 1.0 * place[1], 1.0 * place[2]}; }

TEST(SurfaceGrid, HasTwoMoreVerticesThanSquares) {
  for (const auto& counts : counts_of_cases) {
    const SurfaceGrid grid(counts);
    const auto [a, b, c] = counts;
    EXPECT_EQ(grid.squares().size(), static_cast<std::size_t>(2 * (a * b + b * c + c * a)));
    EXPECT_EQ(grid.vertex_count(), grid.squares().size() + 2);
    EXPECT_EQ(grid.counts(), counts);
  }
  RecordProperty("cases", static_cast<int>(counts_of_cases.size()));
}

TEST(SurfaceGrid, PlacesAndIndicesAreInverse) {
  for (const auto& counts : counts_of_cases) {
    const SurfaceGrid grid(counts);
    std::set<SurfaceGrid::Place> places;
    for (std::size_t vertex = 0; vertex < grid.vertex_count(); ++vertex) {
      const SurfaceGrid::Place& place = grid.place(vertex);
      EXPECT_EQ(grid.index(place), vertex);
      bool outside = false;
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(place[axis], 0);
        EXPECT_LE(place[axis], counts[axis]);
        outside |= place[axis] == 0 || place[axis] == counts[axis];
      }
      EXPECT_TRUE(outside);
      places.insert(place);
    }
    EXPECT_EQ(places.size(), grid.vertex_count());
  }
}

// Closed and consistently turned: every edge belongs to two squares that run along it in opposite directions.
TEST(SurfaceGrid, SquaresCloseTheSurfaceAndLookOutward) {
  for (const auto& counts : counts_of_cases) {
    const SurfaceGrid grid(counts);
    std::set<std::pair<std::size_t, std::size_t>> edges;
    const Vec3 middle = 0.5 * Vec3(counts[0], counts[1], counts[2]);
    for (const SurfaceGrid::Square& square : grid.squares()) {
      const auto corners = grid.corners(square);
      Vec3 centre = Vec3::Zero();
      for (int i = 0; i < 4; ++i) {
        EXPECT_TRUE(edges.emplace(corners[i], corners[(i + 1) % 4]).second);
        centre += point(grid.place(corners[i])) / 4;
      }
      const Vec3 normal = point(square.u).cross(point(square.v));
      EXPECT_NEAR(normal.norm(), 1, 1e-15);
      EXPECT_GT(normal.dot(centre - middle), 0);
      // Counter-clockwise from the origin: u first, then v.
      EXPECT_EQ(grid.place(corners[0]), square.origin);
      EXPECT_EQ(point(grid.place(corners[1])), point(square.origin) + point(square.u));
      EXPECT_EQ(point(grid.place(corners[3])), point(square.origin) + point(square.v));
    }
    for (const auto& [from, to] : edges) EXPECT_TRUE(edges.count({to, from}));
  }
}

TEST(SurfaceGrid, FacesHaveTheirPlacesAndSides) {
  using Face = GridPlace::Face;
  const SurfaceGrid grid({4, 3, 2});
  std::map<Face, std::set<std::array<int, 2>>> places;
  std::map<Face, std::array<int, 2>> counts;
  const std::map<Face, Vec3> outward = {{Face::ventral, -Vec3::UnitZ()},  {Face::dorsal, Vec3::UnitZ()},
                                        {Face::left, -Vec3::UnitY()},     {Face::right, Vec3::UnitY()},
                                        {Face::anterior, -Vec3::UnitX()}, {Face::posterior, Vec3::UnitX()}};
  for (const SurfaceGrid::Square& square : grid.squares()) {
    const GridPlace& place = square.grid_place;
    EXPECT_EQ(point(square.u).cross(point(square.v)), outward.at(place.face));
    EXPECT_TRUE(places[place.face].insert(place.place).second);
    counts[place.face] = place.count;
    for (int i = 0; i < 2; ++i) {
      EXPECT_GE(place.place[i], 0);
      EXPECT_LT(place.place[i], place.count[i]);
    }
  }
  EXPECT_EQ(counts[Face::ventral], (std::array<int, 2>{4, 3}));
  EXPECT_EQ(counts[Face::dorsal], (std::array<int, 2>{4, 3}));
  EXPECT_EQ(counts[Face::anterior], (std::array<int, 2>{3, 2}));
  EXPECT_EQ(counts[Face::posterior], (std::array<int, 2>{3, 2}));
  EXPECT_EQ(counts[Face::left][0], 4);
  EXPECT_EQ(counts[Face::right][0], 4);
  EXPECT_EQ(places.size(), 6u);
}

}  // namespace
}  // namespace plica
