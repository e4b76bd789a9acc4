// Polygons of points on a surface: even points, cells, rims, bends at vertices.
#include "tissue/shapes/surface_polygons.hpp"

#include "support/mesh_error.hpp"
#include "support/prisms.hpp"
#include "tissue/shapes/extrusion.hpp"
#include "tissue/shapes/polygon_embryo.hpp"
#include "tissue/shapes/polygon_surface.hpp"

namespace {

StarSurface ellipsoid(double a, double b, double c) { return {Mat3::Identity(), Vec3(a, b, c), {1.0}}; }

// Spiral points by area, each moved by up to `jitter` of the spacing.
Vectors spiral_points(const StarSurface& surface, std::size_t count, double jitter, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double spacing = jitter * std::sqrt(4 * std::numbers::pi / static_cast<double>(count));
  Vectors points;
  for (const Vec3& direction : even_directions(count)) {
    const Vec3 moved = direction + spacing * Vec3(uniform(random), uniform(random), uniform(random));
    points.push_back(surface.in_direction(moved.normalized()));
  }
  return points;
}

// Closed, three cells a vertex, each polygon convex and counter-clockwise seen from outside.
void expect_sheet_of_cells(const PolygonSurface& surface, const Vectors& points, const StarSurface& shape) {
  ASSERT_EQ(surface.polygons.size(), points.size());
  const auto edges = polygon_edges(surface);
  EXPECT_EQ(surface.vertices.size() + surface.polygons.size(), edges.size() + 2);  // Euler
  std::vector<int> cells_at(surface.vertices.size(), 0);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vec3 normal = shape.bend(points[p]).normal;
    EXPECT_GT(area_vector(surface.vertices, surface.polygons[p]).dot(normal), 0) << "cell " << p;
    for (const double angle : polygon_angles_deg(surface.vertices, surface.polygons[p], normal)) EXPECT_LT(angle, 180);
    for (const std::size_t vertex : surface.polygons[p]) ++cells_at[vertex];
  }
  EXPECT_TRUE(std::ranges::all_of(cells_at, [](int count) { return count == 3; }));
  for (const Vec3& vertex : surface.vertices) EXPECT_LT((shape.along_ray(vertex) - vertex).norm(), 1e-9);
}

TEST(PolygonsOfPoints, OfTwelveEvenPointsAreADodecahedron) {
  const double g = std::numbers::phi;
  Vectors points;
  for (const double s : {-1.0, 1.0})
    for (const double t : {-g, g})
      for (const Vec3& p : {Vec3(0, s, t), Vec3(s, t, 0), Vec3(t, 0, s)}) points.push_back(100 * p.normalized());
  const StarSurface ball = ellipsoid(100, 100, 100);
  const CellPolygons cells = polygons_of_points(points, ball);
  expect_sheet_of_cells(cells.surface, points, ball);
  EXPECT_EQ(cells.flipped_edges, 0);
  EXPECT_EQ(cells.passes, 0);
  EXPECT_EQ(corner_counts(cells.surface), (std::vector<std::size_t>{0, 0, 0, 0, 0, 12}));
  // A dodecahedron's edge over its circumradius.
  const double edge = 100 * 4 / (std::sqrt(3.0) * (1 + std::sqrt(5.0)));
  for (const double length : edge_lengths(cells.surface)) EXPECT_NEAR(length, edge, 1e-9);
}

TEST(PolygonsOfPoints, CoverASphere) {
  const StarSurface ball = ellipsoid(100, 100, 100);
  const Vectors points = spiral_points(ball, 3000, 0.3);
  const CellPolygons cells = polygons_of_points(points, ball);
  expect_sheet_of_cells(cells.surface, points, ball);
  const std::vector<double> areas = polygon_areas(cells.surface);
  const double sum = std::accumulate(areas.begin(), areas.end(), 0.0);
  // Flat polygons lie a little below the sphere.
  EXPECT_NEAR(sum / (4 * std::numbers::pi * 1e4), 1 - 1e-3, 1e-3);
}

// On a sphere the triangles of the hull are Delaunay: every place is nearest to its own cell's point.
TEST(PolygonsOfPoints, VerticesAreAsFarFromTheirThreePoints) {
  const StarSurface ball = ellipsoid(100, 100, 100);
  const Vectors points = spiral_points(ball, 500, 0.2);
  const CellPolygons cells = polygons_of_points(points, ball, {0, 181, 0.1});
  std::vector<std::vector<double>> distances(cells.surface.vertices.size());
  for (std::size_t p = 0; p < points.size(); ++p)
    for (const std::size_t vertex : cells.surface.polygons[p])
      distances[vertex].push_back((cells.surface.vertices[vertex] - points[p]).norm());
  for (std::size_t v = 0; v < distances.size(); ++v) {
    const auto [least, most] = std::ranges::minmax(distances[v]);
    EXPECT_NEAR(least, most, 1e-9);
    for (const Vec3& point : points) EXPECT_GT((cells.surface.vertices[v] - point).norm(), most - 1e-9);
  }
}

// The hull alone, which knows only directions, makes cells of an egg far longer than wide.
TEST(PolygonsOfPoints, OfAnEggAreAsWideAsLong) {
  const StarSurface egg = ellipsoid(250, 90, 90);
  // A hexagonal net of spacing 9 um in the middle, as cells are.
  Vectors points;
  int row = 0;
  for (double x = -216; x <= 216.1; x += 8, ++row) {
    const double radius = 90 * std::sqrt(1 - x * x / 62'500);
    const int around = std::max(6, static_cast<int>(std::lround(2 * std::numbers::pi * radius / 9)));
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5 * (row % 2)) / around;
      points.push_back(egg.along_ray(Vec3(x, radius * std::cos(angle), radius * std::sin(angle))));
    }
  }
  for (const double x : {-225.0, -238.0, 225.0, 238.0})
    for (int k = 0; k < 5; ++k) {
      const double radius = 90 * std::sqrt(1 - x * x / 62'500), angle = 2 * std::numbers::pi * (k + 0.3) / 5;
      points.push_back(egg.along_ray(Vec3(x, radius * std::cos(angle), radius * std::sin(angle))));
    }
  const auto mean_elongation = [&](const PolygonSurface& surface) {
    double sum = 0, count = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (std::abs(points[p].x()) > 120) continue;
      const Vec3 normal = egg.bend(points[p]).normal, across = normal.cross(Vec3::UnitX()).normalized();
      const Vec3 along = across.cross(normal);
      double length = 0, width = 0;
      for (const std::size_t vertex : surface.polygons[p]) {
        length = std::max(length, std::abs((surface.vertices[vertex] - points[p]).dot(along)));
        width = std::max(width, std::abs((surface.vertices[vertex] - points[p]).dot(across)));
      }
      sum += length / width;
      count += 1;
    }
    return sum / count;
  };
  const CellPolygons cells = polygons_of_points(points, egg);
  EXPECT_GT(cells.flipped_edges, points.size() / 4);
  EXPECT_NEAR(mean_elongation(cells.surface), 1, 0.15);
  expect_sheet_of_cells(cells.surface, points, egg);
  // Every edge is Delaunay: the angles opposite to it add up to at most 180 degrees.
  SurfaceTriangulation triangulation = hull_triangulation(points, egg);
  EXPECT_GT(flip_to_delaunay(points, triangulation), points.size() / 4);
  EXPECT_EQ(flip_to_delaunay(points, triangulation), 0);
  EXPECT_TRUE(looks_outward(points, triangulation));
}

TEST(PolygonsOfPoints, TurnWithThePoints) {
  const Mat3 rotation = Eigen::AngleAxisd(0.7, Vec3(1, -1, 0.4).normalized()).toRotationMatrix();
  const StarSurface egg = egg_surface({300, 120, 120, 11, 6});
  const Vectors points = spiral_points(egg, 1500, 0.3);
  Vectors turned;
  for (const Vec3& point : points) turned.push_back(rotation * point);
  const CellPolygons one = polygons_of_points(points, fit_star_surface(points, 8).surface);
  const CellPolygons other = polygons_of_points(turned, fit_star_surface(turned, 8).surface);
  EXPECT_EQ(one.surface.polygons, other.surface.polygons);
  double furthest = 0;
  for (std::size_t v = 0; v < one.surface.vertices.size(); ++v)
    furthest = std::max(furthest, (rotation * one.surface.vertices[v] - other.surface.vertices[v]).norm());
  EXPECT_LT(furthest, 1e-6);
}

TEST(PolygonsOfPoints, AreTheSameToTheBit) {
  const StarSurface egg = egg_surface({300, 120, 120, 11, 6});
  const Vectors points = spiral_points(egg, 800, 0.5);
  const CellPolygons one = polygons_of_points(points, egg), other = polygons_of_points(points, egg);
  EXPECT_EQ(one.surface.polygons, other.surface.polygons);
  EXPECT_EQ(one.surface.vertices, other.surface.vertices);
}

TEST(PolygonsOfPoints, HaveNoShortEdgesAfterMending) {
  const StarSurface egg = ellipsoid(150, 60, 60);
  // Rough enough that many an edge is short.
  const Vectors points = spiral_points(egg, 2000, 0.35);
  SurfaceTriangulation triangulation = hull_triangulation(points, egg);
  flip_to_delaunay(points, triangulation);
  const PolygonSurface raw = dual_polygons(points, triangulation, egg);
  const CellPolygons cells = polygons_of_points(points, egg);
  const auto least_share = [](const PolygonSurface& surface) {
    const std::vector<double> lengths = edge_lengths(surface);
    return *std::ranges::min_element(lengths) * static_cast<double>(lengths.size()) /
           std::accumulate(lengths.begin(), lengths.end(), 0.0);
  };
  EXPECT_LT(least_share(raw), 0.02);
  EXPECT_EQ(raw.polygons, cells.surface.polygons);
  EXPECT_GT(cells.lengthened_edges, 20);
  EXPECT_EQ(cells.left_edges, 0);
  EXPECT_EQ(cells.left_corners, 0);
  EXPECT_GT(least_share(cells.surface), 0.149);
  EXPECT_GT(cells.furthest_move_um, 0);
  expect_sheet_of_cells(cells.surface, points, egg);
}

// Points as uneven as random ones still make convex cells; what stays short is told.
TEST(PolygonsOfPoints, AreConvexAmongRandomPoints) {
  const StarSurface egg = ellipsoid(150, 60, 60);
  for (const double jitter : {0.5, 1.0})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Vectors points = spiral_points(egg, 1000, jitter, seed);
      const CellPolygons cells = polygons_of_points(points, egg);
      expect_sheet_of_cells(cells.surface, points, egg);
      EXPECT_LT(cells.left_edges + cells.left_corners, 30);  // of 3000 edges, 6000 corners
      EXPECT_LE(cells.passes, 60);
    }
}

TEST(PolygonsOfPoints, TakePointsNextToTheSurfaceWhereTheyAreNearest) {
  const StarSurface ball = ellipsoid(100, 100, 100);
  Vectors points = spiral_points(ball, 300, 0.2);
  const CellPolygons on = polygons_of_points(points, ball);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] *= i % 2 ? 1.02 : 0.97;
  const CellPolygons off = polygons_of_points(points, ball);
  EXPECT_EQ(on.surface.polygons, off.surface.polygons);
}

TEST(PolygonsOfPoints, NameTheRowsThatCannotBeUsed) {
  const StarSurface ball = ellipsoid(100, 100, 100);
  const Vectors points = spiral_points(ball, 200, 0);
  const auto refused = [&](const Vectors& changed, const std::string& text) {
    expect_mesh_error([&] { polygons_of_points(changed, ball); }, text);
  };
  refused(Vectors(points.begin(), points.begin() + 11), "11 points");
  Vectors bad = points;
  bad[7].x() = std::numeric_limits<double>::infinity();
  refused(bad, "row 7");
  bad = points;
  bad[150] = bad[20] + Vec3(0, 0, 1e-9);
  refused(bad, "rows 20 and 150 coincide");
  bad = points;
  bad[42] *= 0.8;
  refused(bad, "row 42");
  bad.clear();
  for (const Vec3& point : points)
    if (point.z() > -10) bad.push_back(point);
  refused(bad, "across a hole");
  bad.clear();
  for (const Vec3& point : points) bad.push_back(100 * Vec3(point.x(), point.y(), 0).normalized());
  refused(bad, "no convex hull");
}

TEST(PolygonsOfPoints, RefuseAPolygonThatCrossesItself) {
  const StarSurface ball = ellipsoid(100, 100, 100);
  const Vectors points = spiral_points(ball, 200, 0.1);
  PolygonSurface surface = polygons_of_points(points, ball).surface;
  check_polygons(points, ball, surface);
  // A corner pulled over to the other side of its cell.
  const std::size_t vertex = surface.polygons[30][0];
  surface.vertices[vertex] = ball.along_ray(2.2 * points[30] - 1.2 * surface.vertices[vertex]);
  expect_mesh_error([&] { check_polygons(points, ball, surface); }, "row ");
}

TEST(EvenPoints, MakeCellsOfOneSizeThatAreNoCrystal) {
  const StarSurface egg = egg_surface({500, 180, 180, 17, 7});
  for (const std::size_t count : {200, 2000})
    for (const std::uint64_t seed : {1, 2}) {
      const Vectors points = even_points(egg, count, seed);
      ASSERT_EQ(points.size(), count);
      const CellPolygons cells = polygons_of_points(points, egg);
      const std::vector<double> areas = polygon_areas(cells.surface);
      const double mean = std::accumulate(areas.begin(), areas.end(), 0.0) / static_cast<double>(count);
      double squares = 0;
      for (const double area : areas) squares += (area - mean) * (area - mean);
      EXPECT_LT(std::sqrt(squares / static_cast<double>(count)) / mean, 0.12);
      EXPECT_NEAR(mean * static_cast<double>(count), egg.area(), (count == 200 ? 0.02 : 0.002) * egg.area());
      const double hexagons = static_cast<double>(corner_counts(cells.surface)[6]) / static_cast<double>(count);
      EXPECT_GT(hexagons, 0.6);
      EXPECT_LT(hexagons, 0.8);
      const std::vector<double> lengths = edge_lengths(cells.surface);
      EXPECT_GT(*std::ranges::min_element(lengths) / std::accumulate(lengths.begin(), lengths.end(), 0.0) *
                    static_cast<double>(lengths.size()),
                0.149);
    }
}

TEST(EvenPoints, FollowTheirSeed) {
  const StarSurface ball(Mat3::Identity(), Vec3(100, 100, 100), {1.0});
  EXPECT_EQ(even_points(ball, 100, 5), even_points(ball, 100, 5));
  EXPECT_NE(even_points(ball, 100, 5), even_points(ball, 100, 6));
}

TEST(EvenPoints, CanBeFew) {
  const StarSurface egg = egg_surface({500, 180, 180, {}, {}});
  for (const std::size_t count : {12, 13, 20, 50})
    for (std::uint64_t seed = 0; seed < 10; ++seed)
      EXPECT_EQ(polygons_of_points(even_points(egg, count, seed), egg).surface.polygons.size(), count);
  expect_mesh_error([&] { even_points(egg, 11, 1); }, "11 points");
}

// A cube of side 2 about the origin.
PolygonSurface cube() {
  PolygonSurface surface;
  for (int k = 0; k < 8; ++k) surface.vertices.emplace_back(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
  surface.polygons = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return surface;
}

TEST(PolygonSurface, KnowsACube) {
  const PolygonSurface surface = cube();
  for (const double area : polygon_areas(surface)) EXPECT_DOUBLE_EQ(area, 4);
  const std::vector<double> lengths = edge_lengths(surface);
  EXPECT_EQ(lengths.size(), 12);
  for (const double length : lengths) EXPECT_DOUBLE_EQ(length, 2);
  EXPECT_EQ(corner_counts(surface), (std::vector<std::size_t>{0, 0, 0, 0, 6}));
  // Outward: the vector of a face is 4 along its middle.
  for (const auto& polygon : surface.polygons) {
    Vec3 middle = Vec3::Zero();
    for (const std::size_t vertex : polygon) middle += surface.vertices[vertex] / 4;
    EXPECT_LT((area_vector(surface.vertices, polygon) - 4 * middle).norm(), 1e-14);
  }
}

TEST(PolygonSurface, NeighboursAreMutualAndShareTheEdge) {
  const PolygonSurface surface = cube();
  const auto neighbours = polygon_neighbours(surface);
  EXPECT_EQ(neighbours[0], (std::vector<std::size_t>{4, 3, 5, 2}));
  for (const PolygonEdge& edge : polygon_edges(surface)) EXPECT_NE(edge.right, no_polygon);
}

TEST(PolygonSurface, HasARimWhereAPolygonIsMissing) {
  PolygonSurface surface = cube();
  surface.polygons.pop_back();
  const auto edges = polygon_edges(surface);
  EXPECT_EQ(edges.size(), 12);
  EXPECT_EQ(std::ranges::count(edges, no_polygon, &PolygonEdge::right), 4);
}

TEST(PolygonSurface, RefusesPolygonsThatDoNotFitTogether) {
  PolygonSurface surface = cube();
  std::ranges::reverse(surface.polygons[2]);
  expect_mesh_error([&] { polygon_edges(surface); }, "runs the same way in two cells");
  surface = cube();
  surface.polygons.push_back({1, 0, 6});
  expect_mesh_error([&] { polygon_edges(surface); }, "belongs to more than two cells");
}

TEST(PolygonSurface, AFanHasTheMiddleOfAnUnevenPolygon) {
  // An L-like trapezium in the plane z = 0 with corners (0,0), (4,0), (2,2), (0,2): area 6, centroid by hand.
  const Vectors vertices = {{0, 0, 0}, {4, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  const PolygonFan fan = fan_about(vertices, {0, 1, 2, 3}, Vec3(1, 1, 0));
  EXPECT_DOUBLE_EQ(fan.area, 6);
  EXPECT_LT((fan.centroid - Vec3(14.0 / 9, 8.0 / 9, 0)).norm(), 1e-14);
}

TEST(VertexBends, OnASphere) {
  const StarSurface ball{Mat3::Identity(), Vec3::Constant(100), {1.0}};
  const PolygonSurface polygons = polygons_of_points(even_points(ball, 2000, 1), ball).surface;
  const std::vector<VertexBend> alone = vertex_bends(polygons), smooth = vertex_bends(polygons, ball);
  for (std::size_t v = 0; v < alone.size(); ++v) {
    EXPECT_NEAR(smooth[v].least_radius_um, 100, 1e-9);
    EXPECT_NEAR(alone[v].least_radius_um, 100, 3);
    EXPECT_GT(alone[v].normal.dot(smooth[v].normal), 0.999);
  }
}

// Outward and inward about a cylinder of 60 um.
TEST(VertexBends, OnACylinderAndInAPipe) {
  for (const bool outward : {true, false}) {
    const double radius = outward ? 60 : -60;
    const PrismSheet sheet = bent(honeycomb(8, 8, 4, 1), [&](const Vec3& x) {
      return Vec3(x.x(), (radius + x.z()) * std::sin(x.y() / radius), (radius + x.z()) * std::cos(x.y() / radius));
    });
    const std::vector<VertexBend> bends = vertex_bends({sheet.apical, sheet.cells});
    for (std::size_t v = 0; v < bends.size(); ++v) {
      const Vec3 normal = Vec3(0, sheet.apical[v].y(), sheet.apical[v].z()) / radius;
      EXPECT_GT(bends[v].normal.dot(normal), 0.98) << v;
      if (bends[v].normal.dot(normal) < 0.9995) continue;  // at the rim
      if (outward)
        EXPECT_NEAR(bends[v].least_radius_um, 60, 6) << v;
      else
        EXPECT_GT(bends[v].least_radius_um, 600) << v;
    }
  }
}

// A corner of one hexagon has five others, all on one circle with it: they do not say how it bends, and a nanometre
// there is no curvature.
TEST(VertexBends, AtTheRimOfADome) {
  PrismSheet sheet = bent(honeycomb(12, 12, 4.6, 1),
                          [](const Vec3& x) { return Vec3(x.x(), x.y(), -(x.x() * x.x() + x.y() * x.y()) / 600); });
  Random random(1);
  for (Vec3& x : sheet.apical) x.z() += 1e-3 * random.number();
  for (const VertexBend& bend : vertex_bends({sheet.apical, sheet.cells})) EXPECT_GT(bend.least_radius_um, 150);
}

TEST(VertexBends, OfAFlatPatch) {
  const PrismSheet sheet = irregular_polygons(6, 5, 4, 1, 0.2, 1);
  for (const VertexBend& bend : vertex_bends({sheet.apical, sheet.cells})) {
    EXPECT_NEAR(bend.normal.z(), 1, 1e-12);
    EXPECT_TRUE(std::isinf(bend.least_radius_um));
  }
}

}  // namespace
