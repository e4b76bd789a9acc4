// Surfaces that others have made: what is mended, what is refused, and where.
#include "tissue/shapes/given_surface.hpp"

#include "support/mesh_error.hpp"

namespace {

using Face = std::vector<std::size_t>;

// A cube from -1 to 1, faces outward.
PolygonSurface cube() {
  PolygonSurface surface;
  for (const double z : {-1.0, 1.0})
    for (const auto& [x, y] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
      surface.vertices.emplace_back(x, y, z);
  surface.polygons = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  return surface;
}

// A flat patch of squares, columns x rows, counter-clockwise from above.
PolygonSurface squares(std::size_t columns, std::size_t rows) {
  PolygonSurface surface;
  for (std::size_t r = 0; r <= rows; ++r)
    for (std::size_t c = 0; c <= columns; ++c)
      surface.vertices.emplace_back(static_cast<double>(c), static_cast<double>(r), 0);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const std::size_t v = c + r * (columns + 1);
      surface.polygons.push_back({v, v + 1, v + columns + 2, v + columns + 1});
    }
  return surface;
}

std::string all(const MendedSurface& mended) {
  std::string text;
  for (const std::string& remark : mended.remarks) text += remark + '\n';
  return text;
}

TEST(GivenSurface, AGoodOneStaysAsItIs) {
  for (const bool mend : {true, false}) {
    PolygonSurface surface = cube();
    const MendedSurface mended = check_and_mend(surface, mend);
    EXPECT_TRUE(mended.is_closed);
    EXPECT_EQ(all(mended), "");
    EXPECT_EQ(surface.vertices, cube().vertices);
    EXPECT_EQ(surface.polygons, cube().polygons);
    surface = squares(3, 2);  // four faces meet at its vertices
    EXPECT_FALSE(check_and_mend(surface, mend).is_closed);
    EXPECT_EQ(surface.polygons, squares(3, 2).polygons);
  }
}

TEST(GivenSurface, VerticesGivenTwiceAreMerged) {
  const PolygonSurface whole = cube();
  PolygonSurface soup;
  for (const Face& polygon : whole.polygons) {
    Face& face = soup.polygons.emplace_back();
    for (const std::size_t vertex : polygon) {
      face.push_back(soup.vertices.size());
      soup.vertices.push_back(whole.vertices[vertex]);
    }
  }
  PolygonSurface as_given = soup;
  expect_mesh_error(
      [&] { check_and_mend(as_given, false); },
      "vertices 3 and 8 coincide at (-1, -1, -1) um; let neighbours share their vertices: set mend = true");
  const MendedSurface mended = check_and_mend(soup, true);
  EXPECT_TRUE(mended.is_closed);
  EXPECT_EQ(all(mended), "16 coincident vertices were merged\n");
  EXPECT_EQ(soup.vertices.size(), 8U);
}

TEST(GivenSurface, FacesAreTurnedOutward) {
  PolygonSurface surface = cube();
  for (const std::size_t face : {1, 4}) std::ranges::reverse(surface.polygons[face]);
  PolygonSurface as_given = surface;
  expect_mesh_error([&] { check_and_mend(as_given, false); },
                    "face 1 at (0, 0, 1) um is wound the wrong way, as are 2 of 6 faces");
  EXPECT_EQ(all(check_and_mend(surface, true)), "2 faces were reversed\n");
  for (std::size_t face = 0; face < 6; ++face) {
    Vec3 middle = Vec3::Zero();
    for (const std::size_t vertex : surface.polygons[face]) middle += surface.vertices[vertex] / 4;
    EXPECT_GT(area_vector(surface.vertices, surface.polygons[face]).dot(middle), 0);
  }
  // All of a closed one look inward; of an open one, whichever are fewer are wrong.
  surface = cube();
  for (Face& polygon : surface.polygons) std::ranges::reverse(polygon);
  EXPECT_EQ(all(check_and_mend(surface, true)), "6 faces were reversed\n");
  surface = squares(3, 1);
  std::ranges::reverse(surface.polygons[0]);
  EXPECT_EQ(all(check_and_mend(surface, true)),
            "1 faces were reversed, by majority: the apical side faces (0.00, 0.00, 1.00); for the other side, reverse "
            "most faces of the file\n");
  EXPECT_GT(area_vector(surface.vertices, surface.polygons[0]).z(), 0);
}

TEST(GivenSurface, ShortEdgesAndWideAnglesAreMended) {
  // Two squares and two triangles about an edge of a twentieth.
  PolygonSurface surface;
  surface.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, -0.025, 0}, {0, 0.025, 0}};
  surface.polygons = {{0, 1, 4}, {1, 2, 5, 4}, {2, 3, 5}, {3, 0, 4, 5}};
  const MendedSurface mended = check_and_mend(surface, true, {.least_edge = 0.3});
  EXPECT_SAYS(all(mended), "1 short edges and 0 wide angles");
  const double mean = (4 * 2 + 4 * std::sqrt(1 + 0.975 * 0.975) + 0.05) / 9;
  EXPECT_NEAR((surface.vertices[5] - surface.vertices[4]).norm(), 0.3 * mean, 0.02 * mean);

  // Three squares as one and a half: the vertex in the middle of a long side is sharpened.
  surface = squares(2, 2);
  surface.polygons = {{0, 1, 2, 5, 4, 3}, {3, 4, 7, 6}, {4, 5, 8, 7}};
  surface.vertices[1].y() = -0.5;
  EXPECT_SAYS(all(check_and_mend(surface, true)), "1 wide angles");
  EXPECT_GT(surface.vertices[4].y(), 1.05);
}

TEST(GivenSurface, VerticesAlongAWallAreDropped) {
  // Two squares whose common wall has two vertices more, and whose rim one that is straight and one that is not.
  PolygonSurface surface = squares(2, 1);
  for (const Vec3& more : {Vec3(1.1, 0.3, 0), Vec3(0.9, 0.7, 0), Vec3(0.5, 0, 0), Vec3(1.5, -0.5, 0)})
    surface.vertices.push_back(more);
  surface.polygons = {{0, 8, 1, 6, 7, 4, 3}, {1, 9, 2, 5, 4, 7, 6}};
  EXPECT_EQ(all(check_and_mend(surface, true)),
            "3 vertices along an edge or the rim, where no third cell meets, were removed\n");
  EXPECT_EQ(surface.polygons, (std::vector<Face>{{0, 1, 4, 3}, {1, 6, 2, 5, 4}}));
  // A rim that is bent inward.
  surface = squares(2, 1);
  surface.vertices.emplace_back(0.5, 0.1, 0);
  surface.polygons[0] = {0, 6, 1, 4, 3};
  EXPECT_SAYS(all(check_and_mend(surface, true)), "1 vertices along an edge or the rim");
  EXPECT_EQ(surface.polygons[0], (Face{0, 1, 4, 3}));
}

TEST(GivenSurface, NeighboursOfAFileOfFiveDigitsAreJoined) {
  PolygonSurface surface = squares(2, 1);
  for (const std::size_t v : {1, 4}) surface.vertices.push_back(surface.vertices[v] + Vec3(2e-5, 0, 0));
  surface.polygons[1] = {6, 2, 5, 7};
  EXPECT_EQ(all(check_and_mend(surface, true)), "2 coincident vertices were merged\n");
}

TEST(GivenSurface, CornersInOnePlaceAreOne) {
  // The corner of four squares as an edge of a ten thousandth of the mean, and one much shorter; rings closed twice.
  for (const double length : {1e-5, 1e-9, 0.0}) {
    PolygonSurface surface = squares(2, 2);
    surface.vertices.emplace_back(1 + length, 1, 0);
    surface.polygons = {{0, 1, 4, 3, 0}, {1, 2, 5, 9, 4}, {3, 4, 7, 6}, {4, 9, 5, 8, 7, 7}};
    surface.polygons[3] = {4, 9, 5, 8, 7, 7, 4};
    EXPECT_EQ(all(check_and_mend(surface, true)),
              "1 coincident vertices were merged\n5 corners in the place of the one before them were removed\n");
    for (const Face& polygon : surface.polygons) EXPECT_EQ(polygon.size(), 4U);
  }
  // A ring that is closed twice moves nothing, so it needs no repair.
  PolygonSurface surface = squares(2, 1);
  surface.polygons[0].push_back(surface.polygons[0][0]);
  EXPECT_EQ(all(check_and_mend(surface, false)), "1 corners in the place of the one before them were removed\n");
  EXPECT_EQ(surface.polygons, squares(2, 1).polygons);
  // What is left of a face is no cell.
  surface = squares(2, 1);
  surface.vertices[2] = surface.vertices[5];
  surface.polygons[1] = {1, 2, 5};
  expect_mesh_error([&] { check_and_mend(surface, true); }, "face 1 has 2 corners; a cell requires at least three");
}

TEST(GivenSurface, TheLargestPieceIsKept) {
  PolygonSurface surface = squares(3, 2);
  for (const auto& [x, y] : {std::pair(9.0, 0.0), {10.0, 0.0}, {9.0, 1.0}}) surface.vertices.emplace_back(x, y, 0);
  surface.polygons.insert(surface.polygons.begin(), {12, 13, 14});
  PolygonSurface as_given = surface;
  expect_mesh_error([&] { check_and_mend(as_given, true); },
                    "the surface is not one piece but 2 pieces of 6 and 1 cells; face 0 at (9.333, 0.3333, 0) um");
  const MendedSurface mended = check_and_mend(surface, true, {}, true);
  EXPECT_EQ(all(mended), "the largest of 2 pieces of 6 and 1 cells was kept\n");
  EXPECT_EQ(mended.kept, (Face{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(surface.polygons, squares(3, 2).polygons);
}

// The smallest surfaces that are wrong each in one way.
TEST(GivenSurface, SaysWhatIsWrongAndWhere) {
  const auto expect = [](PolygonSurface surface, const std::string& said) {
    expect_mesh_error([&] { check_and_mend(surface, true); }, said);
  };
  const auto spoilt = [](const auto& spoil) {
    PolygonSurface surface = squares(2, 1);
    spoil(surface);
    return surface;
  };
  expect({}, "the surface has no faces");
  expect(spoilt([](auto& s) { s.vertices[2].x() = std::nan(""); }), "vertex 2 of face 1 is at (nan, 0, 0)");
  expect(spoilt([](auto& s) { s.vertices[2].x() = std::numeric_limits<double>::infinity(); }), "vertex 2 of face 1");
  expect(spoilt([](auto& s) { s.vertices[2].x() = 1e12; }), "coordinates must be finite, in um");
  expect(spoilt([](auto& s) { s.polygons[1] = {1, 2}; }), "face 1 has 2 corners; a cell requires at least three");
  expect(spoilt([](auto& s) { s.polygons[1] = {}; }), "face 1 has 0 corners");
  expect(spoilt([](auto& s) { s.polygons[1] = {1, 2, 5, 2}; }), "face 1 at (1.75, 0.25, 0) um has vertex 2 twice");
  expect(spoilt([](auto& s) {
           s.vertices.emplace_back(1, 0.5, 1);
           s.polygons.push_back({1, 4, 6});
         }),
         "the edge from (1, 0, 0) um to (1, 1, 0) um belongs to 3 faces, 0, 1 and 2 among them");
  expect(spoilt([](auto& s) {
           for (const double x : {9, 10, 9}) s.vertices.emplace_back(x, s.vertices.size() == 8, 0);
           s.polygons.push_back({6, 7, 8});
         }),
         "the surface is not one piece but 2 pieces of 2 and 1 cells; face 2 at (9.333, 0.3333, 0) um is joined to the "
         "largest by no edge: set embryo.keep = \"largest\", or join them");
  // A ring of squares, but for one corner: those beside it touch in one vertex.
  PolygonSurface ring = squares(3, 3);
  ring.polygons.erase(ring.polygons.begin() + 4);
  ring.polygons.erase(ring.polygons.begin());
  expect(ring, "the surface touches itself at vertex");
  // A Moebius band of five squares.
  PolygonSurface band;
  for (int i = 0; i < 5; ++i) {
    const double turn = 2 * M_PI * i / 5, tilt = turn / 2;
    for (const double side : {-1.0, 1.0})
      band.vertices.emplace_back((10 + side * std::cos(tilt)) * std::cos(turn),
                                 (10 + side * std::cos(tilt)) * std::sin(turn), side * std::sin(tilt));
  }
  for (std::size_t i = 0; i < 4; ++i) band.polygons.push_back({2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
  band.polygons.push_back({8, 1, 0, 9});
  expect(band, "the surface is one-sided");
  expect(spoilt([](auto& s) {
           for (const int v : {2, 5}) s.vertices[v].x() = 1;
           s.vertices[2].y() = 0.25, s.vertices[5].y() = 0.75;
         }),
         "face 1 at (1, 0.5, 0) um has no area");
  PolygonSurface arrow;  // a third corner far inside
  arrow.vertices = {{0, 0, 0}, {4, 0, 0}, {0.5, 0.5, 0}, {0, 4, 0}};
  arrow.polygons = {{0, 1, 2, 3}};
  expect(arrow, "face 0 at (1.125, 1.125, 0) um is not convex, with a corner of ");
  PolygonSurface star;  // around twice
  for (int i = 0; i < 5; ++i) star.vertices.emplace_back(std::cos(0.8 * M_PI * i), std::sin(0.8 * M_PI * i), 0);
  star.polygons = {{0, 1, 2, 3, 4}};
  expect(star, "crosses itself");
  PolygonSurface folded = squares(2, 1);
  for (const int v : {2, 5}) folded.vertices[v].x() = 0.1;
  expect(folded, "are folded onto each other at the edge from (1, 0, 0) um to (1, 1, 0) um");
  PolygonSurface saddle;
  saddle.vertices = {{-1, -1, 1}, {1, -1, -1}, {1, 1, 1}, {-1, 1, -1}};
  saddle.polygons = {{0, 1, 2, 3}};
  expect(saddle, "face 0 at (0, 0, 0) um is far from flat: its corners lie up to 45 degrees out of its plane; 40");
}

}  // namespace
